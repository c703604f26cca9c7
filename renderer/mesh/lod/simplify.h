// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "renderer/mesh/lod/patch.h"

namespace eyrie::mesh {

/// Takes inner vertices of `patch` away, each time the one that makes the least bound, until about
/// `target` triangles are left or none can go. What is left keeps its promise (patch.h): each step
/// is a map as described there, and their distances add up.
///
/// Stay: vertices on the border, so that the patch fits its neighbours whatever is done to them;
/// those where more than two sheets meet, or normals or colours are broken; and those whose star is
/// no graph (star.h).
/// R. Klein, G. Liebich, W. Straßer, "Mesh Reduction with Error Control", 1996.
Patch simplify(const PackedMesh& mesh, const Patch& patch, std::size_t target);

/// Of a patch's vertices about those on its border: 0 to 1.
double borderShare(const PackedMesh& mesh, const Patch& patch);

}  // namespace eyrie::mesh
