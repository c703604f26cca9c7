// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace eyrie::import {

/// Whether texture coordinates of a glTF file are whole numbers that stand for 0 to 1, whose bytes
/// Assimp takes for those of a float.
bool hasWholeTexturePlaces(std::string_view json);

}  // namespace eyrie::import
