// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "fabric/raster.h"
#include "fabric/viewport.h"

namespace eyrie::fabric {

/// How a picture with other pixels is made from a rectangle of pixels: from every n-th column and
/// row of it (pixel compounds), or with so many pixels in the place of those (zoom).
///
/// What it makes counts its pixels from 0, from its lower left corner. Several after each other,
/// each of a rectangle of what the one before makes, say how any picture lies on a view.
struct Regridding {
    enum class Kind { EveryNth, Zoom };
    Kind kind = Kind::Zoom;
    PixelViewport of;        ///< in the pixels before it
    std::int32_t width = 0;  ///< pixels of what it makes
    std::int32_t height = 0;
    /// EveryNth: columns first, first + every, … of `of`; rows alike.
    std::int32_t firstColumn = 0;
    std::int32_t firstRow = 0;
    std::int32_t everyColumn = 1;
    std::int32_t everyRow = 1;

    bool operator==(const Regridding&) const = default;
};

/// Of every n-th column and row of `of`. Preconditions: 0 <= first < every.
Regridding everyNth(const PixelViewport& of, int firstColumn, int everyColumn, int firstRow,
                    int everyRow);

/// The points of a view, in its pixels, that are the pixels' centres after `regriddings`, each
/// moved by `jitter` of such a pixel. `view` where there is no regridding.
Raster rasterAfter(const PixelViewport& view, std::span<const Regridding> regriddings,
                   const Vec2& jitter);

}  // namespace eyrie::fabric
