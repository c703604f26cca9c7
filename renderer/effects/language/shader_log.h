// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace eyrie::effects {

/// The log of a GLSL compiler with places in `files` for line numbers as kLinesPerFile makes them:
/// one "FILE:LINE: message" for each line that has a place; other lines as they are.
///
/// Knows what glslang ("ERROR: 0:12: …"), Mesa ("0:12(5): …") and NVIDIA ("0(12) : …") write.
std::string namedLog(std::string_view log, std::span<const std::string> files);

}  // namespace eyrie::effects
