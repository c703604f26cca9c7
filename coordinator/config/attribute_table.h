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

/// Reads one setting of a resource into `attributes`, in place of one of the same name. What has no
/// effect without a screen is said to be so; what is unknown is left out with a warning.
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
