// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "coordinator/composite/taps.h"
#include "fabric/depth_merge.h"
#include "fabric/image.h"

namespace eyrie::composite {

/// How a picture with other pixels comes over another.
enum class Placing {
    Paste,          ///< each pixel it has
    Nearer,         ///< where it is nearer
    NearerOrEqual,  ///< where it is not behind
};

/// Pixels of `source` into `target`: column by column and row by row of `part`, those that the taps
/// name, mixed by weight; depth is that of the nearest one. Pixels that have no tap, or one whose
/// nearest pixel is outside source.area, stay as they are; of one that lies half outside the inner
/// pixel counts alone.
///
/// `columns` and `rows` are for part's pixels; their taps count as source.area does.
/// Preconditions: target.area contains part; by depth, both have depth.
void place(const fabric::Image& source, std::span<const Tap> columns, std::span<const Tap> rows,
           const fabric::PixelViewport& part, Placing placing, fabric::Image& target);

/// What `zoom` makes of `source`, whose area contains zoom.of; of area (0, 0) and its size.
fabric::Image zoomed(const fabric::Image& source, const fabric::Regridding& zoom);

}  // namespace eyrie::composite
