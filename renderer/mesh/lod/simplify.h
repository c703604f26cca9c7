// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "renderer/mesh/lod/patch.h"

namespace eyrie::mesh {

struct Simplified {
    Patch patch;
    double borderShare = 0;  ///< of the points before, those on the border or where sheets meet
};

/// Takes inner vertices of `patch` away, each time the one that makes the least bound, until about
/// `target` triangles are left or none can go. What is left keeps its promise (patch.h): each step
/// is a map as described there, and their distances add up, as do changes of colours. Where these
/// are too much, the bound is how far away the colours come from (patch_colours.h).
///
/// Stay: vertices on the border, so that the patch fits its neighbours whatever is done to them;
/// those where more than two sheets meet, or normals, colours, texture coordinates or materials are
/// broken; those of `staying`, which has a 1 for each, if anything; and those whose star is no
/// graph (star.h). A vertex that is left keeps all that it has. R. Klein, G. Liebich, W. Straßer,
/// "Mesh Reduction with Error Control", 1996.
Simplified simplify(const PackedMesh& mesh, const Patch& patch, std::size_t target,
                    std::span<const std::uint8_t> staying = {});

}  // namespace eyrie::mesh
