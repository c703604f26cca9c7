// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "renderer/truth/depth_comparison.h"

namespace eyrie::truth {

/// How far, in pixels, a picture's outline is from the reference's: the farthest that a pixel with
/// something drawn is from one where the reference may be hit, or one where the reference is hit
/// from one with something drawn; centre to centre, 0 where both cover the same pixels. Outlines
/// before other surfaces are not looked at. The picture's diagonal where one of the two is empty.
///
/// `depth` as compareDepth has it. Distances: P. Felzenszwalb, D. Huttenlocher, "Distance
/// Transforms of Sampled Functions", 2012.
double silhouettePixels(const ReferenceView& view, std::span<const float> depth);

}  // namespace eyrie::truth
