// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/mesh/lod/sheet_ends.h"
#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// Which of `count` pieces of a mesh close a gap between others, as kerbs do and panes in their
/// frames: of the points where such a piece ends two in three lie where others end, too, within a
/// quarter of its width. Without it one would see through. One that ends nowhere, a solid, closes
/// none.
///
/// `pieceOf` has each vertex's piece.
std::vector<bool> closingPieces(const PackedMesh& mesh, const SheetEnds& ends,
                                std::span<const std::uint32_t> pieceOf, std::size_t count);

}  // namespace eyrie::mesh
