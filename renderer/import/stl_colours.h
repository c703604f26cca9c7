// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace eyrie::import {

/// A binary STL with colours in Materialise's way ("COLOR=" in its header) as Assimp 5.2 takes it
/// for what is meant; nothing for other files. The highest of a facet's 16 bits says there that it
/// has the part's colour, where Assimp takes it to say that it has its own. As MeshLab means that,
/// too, the bit goes by the other 15: the part's colour where these are 0.
std::optional<std::string> stlForAssimp(std::span<const std::byte> file);

}  // namespace eyrie::import
