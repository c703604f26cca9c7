// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "renderer/terrain/deviation.h"

/// The loops over posts and crossings behind SourceSurface, on heights that lie in one piece of
/// memory.
namespace eyrie::terrain {

/// Part of a height raster in memory: posts (i0, j0) to (i1, j1), all included.
struct HeightPatch {
    const float* posts = nullptr;  ///< of (i0, j0)
    std::ptrdiff_t stride = 0;
    std::int32_t i0 = 0;
    std::int32_t j0 = 0;
    std::int32_t i1 = 0;
    std::int32_t j1 = 0;

    const float* row(std::int32_t j) const { return posts + stride * (j - j0); }
    float at(std::int32_t i, std::int32_t j) const { return row(j)[i - i0]; }
    bool contains(const Triangle& triangle) const;
    /// The posts that both have.
    HeightPatch clipped(std::int32_t fromI, std::int32_t fromJ, std::int32_t toI,
                        std::int32_t toJ) const;
};

Plane planeOf(const Triangle& triangle);

/// Greatest distance from `plane` of the patch's posts in the closed triangle, and not below
/// `worst`. NaN posts do not count. `wholly`: the patch contains the triangle.
double scanAligned(const HeightPatch& patch, const Triangle& triangle, const Plane& plane,
                   bool wholly, double worst);
double scanGeneral(const HeightPatch& patch, const Triangle& triangle, const Plane& plane,
                   double worst);

/// The same where diagonal edges of an aligned triangle cut the patch's cells in half, at the
/// cells' centres: the other diagonal's height there.
double scanDiagonalEdges(const HeightPatch& patch, const Triangle& triangle, double worst);

struct Crossed {
    double worst = 0;
    bool meetsNodata = false;
};
/// The same where the edges of any triangle meet lines of the lattice in the patch's cells.
Crossed scanCrossings(const HeightPatch& patch, const Triangle& triangle, double worst);

struct PostCounts {
    std::int64_t data = 0;
    std::int64_t nodata = 0;
};
/// Of the patch's posts in the closed triangle.
PostCounts countPosts(const HeightPatch& patch, const Triangle& triangle);

}  // namespace eyrie::terrain
