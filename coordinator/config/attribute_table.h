// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "coordinator/config/value_reader.h"

/// Settings of resources and what they may be.
namespace eyrie::config {

/// Whose settings. Their global names begin with "EQ_", such as EQ_WINDOW_IATTR_HINT_STEREO.
enum class AttributeScope {
    Config,
    Node,
    Pipe,
    View,
    Window,
    Channel,
    Compound,
    Connection,
    SwapBarrier
};

/// Why settings of connections have no effect, within attributes or not.
inline constexpr std::string_view kGrpc = "renderers are reached by gRPC";
inline constexpr std::string_view kAddresses =
    "renderers register, and say where they are, as `eyrie renderer` is told";
inline constexpr std::string_view kUnpaced = "pictures are sent as fast as connections take them";

/// Reads one setting of a resource into `attributes`, in place of one of the same name. What has no
/// effect here is said to be so, and why, unless it asks for what is so anyway; what is unknown is
/// left out with a warning.
void readAttribute(const Statement& statement, AttributeScope scope, ValueReader& reader,
                   Attributes& attributes);

/// All of a block.
void readAttributes(const Statement& block, AttributeScope scope, ValueReader& reader,
                    Attributes& attributes);

/// The statement that a setting, global or not, is read from.
Statement statementOf(const Attribute& attribute);

/// As readAttribute() for a statement of the global block, kept by its whole name.
void readGlobal(const Statement& statement, ValueReader& reader, Attributes& globals);

}  // namespace eyrie::config
