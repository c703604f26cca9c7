// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace eyrie::import {

/// A DXF file as Assimp 5.2 takes it for what is meant; nothing for one that it reads rightly. It
/// moves a block before it scales it, and takes its base away after that; passes over the rows and
/// columns in which blocks are inserted; and takes the places, names and braces of entities that it
/// does not read for those of the block around them. Blocks that are turned stay unturned. It
/// leaves out corners of polyface meshes before edges that are not shown, and has other colours:
/// layers are called by those (dxf_colours.h).
std::optional<std::string> dxfForAssimp(std::string_view dxf);

/// For TriangleMesh::notes: blocks that are not where the file has them, even so, surfaces that are
/// not read, and ones that have no colour, as they ought to have several.
std::vector<std::string> dxfCaveats(std::string_view dxf);

}  // namespace eyrie::import
