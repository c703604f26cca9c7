// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/terrain/deviation.h"

/// Aligned triangles of a few posts: nine in ten of those that an import measures. What
/// deviation_scan.h does for any size is done here in loops of known length.
namespace eyrie::terrain {

/// Whether legs span at most eight columns or rows.
bool isSmall(const Triangle& aligned);

struct SmallDeviation {
    double atPosts = 0;
    double atCentres = 0;  ///< as scanDiagonalEdges
};
/// Of a small aligned triangle, the right angle first, that the patch has all of; neither is below
/// `floor`. NaN posts do not count.
SmallDeviation deviationOfSmall(const HeightPatch& patch, const Triangle& aligned, double floor);

}  // namespace eyrie::terrain
