// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "renderer/lod/view.h"
#include "renderer/mesh/lattice.h"
#include "renderer/mesh/triangle_blocks.h"

namespace eyrie::draw {

/// Calls `visit` with the corners of each of a block's triangles, object space.
using VisitTriangle = std::function<void(std::span<const fabric::Vec3, 3>)>;
using TrianglesOf = std::function<void(const mesh::TriangleBlock&, const VisitTriangle& visit)>;

/// What triangles are drawn with.
struct DrawnWith {
    double errorMetres = 0;  ///< of geometric error
    double tauPixels = 0;    ///< that was asked for: boxes that do not keep it are looked into
    double knownPixels = 0;  ///< of what else is seen: up to that nothing needs to be told apart
};

/// Screen-space error, in pixels, of the triangles in `blocks`, with what single precision makes of
/// their corners: the largest over the blocks' boxes or, where a box does not keep tau, as none can
/// that the eye is in, over its triangles; `knownPixels` at least. So it is finite amid them, as in
/// a room. Boxes with the largest errors are looked into first, as many as `mayLookInto` says,
/// which goes down by them; of others that of the box counts. Proof: docs/errors.md#mesh-geometry.
double errorOfBlocksPixels(std::span<const mesh::TriangleBlock> blocks,
                           const mesh::Lattice& lattice, const lod::ObjectView& view,
                           const DrawnWith& with, const TrianglesOf& trianglesOf, int& mayLookInto);

}  // namespace eyrie::draw
