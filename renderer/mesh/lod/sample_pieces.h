// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderer/mesh/lod/patch.h"
#include "renderer/mesh/lod/surface_colours.h"
#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// A piece of a triangle, and the point in it that may stand for it in a sample.
struct SamplePiece {
    glm::dvec3 point{0.0};  ///< lattice steps
    std::uint64_t lot = 0;  ///< as if drawn, but the same for the same point
    std::uint32_t triangle = 0;
    glm::dvec3 weights{0.0};  ///< of the triangle's corners
};

struct SamplePieces {
    std::vector<SamplePiece> pieces;
    /// No point of the surface that the patch stands for is farther from the point of its piece;
    /// those in holes of materials have none.
    double reachSteps = 0;
};

/// Cuts the triangles of `patch`, halved at their longest sides until all of a piece is within
/// `reachSteps` of its middle, or within half of that of a side: then along it. Ends early when
/// there are more than `most` pieces, and a piece a triangle. Holes are looked for in texels about
/// `texelSteps` apart.
SamplePieces cutIntoPieces(const PackedMesh& mesh, const Patch& patch,
                           const SurfaceColours& colours, double reachSteps, double texelSteps,
                           std::size_t most);

/// Of the patch, in square steps. The same for the same triangles in whatever order.
double areaOf(const PackedMesh& mesh, const Patch& patch);

}  // namespace eyrie::mesh
