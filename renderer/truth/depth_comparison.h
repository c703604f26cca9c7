// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "renderer/truth/reference_surface.h"

namespace eyrie::truth {

/// How a tested depth picture differs from a reference. Displacements are in pixels on the screen.
struct DepthComparison {
    double maxPixels = 0;  ///< the largest displacement of a drawn pixel's surface point
    double p99Pixels = 0;  ///< not exceeded by 99 of 100 drawn pixels
    int worstX = 0;        ///< where maxPixels is
    int worstY = 0;
    std::size_t compared = 0;   ///< pixels drawn that have a counterpart on the reference
    std::size_t holes = 0;      ///< nothing drawn where the reference is hit (edges excepted)
    std::size_t falseHits = 0;  ///< drawn where the reference is not hit (edges excepted)
    /// Drawn at a depth that no reference pixel nearby has: something in front is missing, or
    /// something that should be hidden is in front (edges excepted).
    std::size_t misplaced = 0;
};

/// Compares a picture with a reference, pixel by pixel.
///
/// A pixel's displacement: its centre is taken back to the world at the tested depth, and the
/// distance on the screen to the reference's counterpart of that point (ReferenceSurface) is
/// measured, or, if smaller, that to the reference's hit in the same pixel, seen from the side.
/// Pixels within `edgePixels` of a place where the reference begins or ends are excepted from
/// holes and falseHits, and depths are compared with the range of those within that distance:
/// a surface moved by up to that much on the screen is no mistake.
///
/// `depth`: view-space metres, infinity for nothing; rows from the bottom up, width * height of
/// `camera`. Uses all cores.
DepthComparison compareDepth(const Pinhole& camera, std::span<const float> depth,
                             const ReferenceSurface& reference, int edgePixels);

}  // namespace eyrie::truth
