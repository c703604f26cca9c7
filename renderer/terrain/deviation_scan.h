// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "renderer/terrain/deviation.h"

/// The loops over posts and crossings behind SourceSurface, on heights that lie in one piece of
/// memory.
namespace eyrie::terrain {

Plane planeOf(const Triangle& triangle);
/// The same of an aligned triangle, quicker.
Plane planeOfAligned(const Triangle& triangle);

/// Greatest distance from `plane` of the patch's posts in the closed triangle, and not below
/// `worst`. NaN posts do not count. Precondition of scanAligned: the patch has all of an aligned
/// triangle.
double scanAligned(const HeightPatch& patch, const Triangle& triangle, const Plane& plane,
                   double worst);
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
