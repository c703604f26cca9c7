// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <absl/status/status.h>

#include "fabric/vec.h"

namespace eyrie::fabric {

/// Which points of a view a picture shows, where they are not the centres of its pixels: every
/// n-th column (pixel compounds), points beside the centres (subpixel compounds), fewer or more of
/// them (zoom). Level of detail stays that of the view's own pixels.
///
/// Pixel (i, j) of the picture shows the point origin + (i + 1/2, j + 1/2) * step, in pixels of the
/// view from its lower left corner. All of these lie in the view.
struct Raster {
    std::int32_t width = 0;  ///< pixels of the picture, 1 to 16384 a side
    std::int32_t height = 0;
    Vec2 origin{0, 0};
    Vec2 step{1, 1};  ///< kMinRasterStep and up

    bool operator==(const Raster&) const = default;
};

inline constexpr double kMinRasterStep = 1e-3;

/// InvalidArgument, naming the field, where a raster does not sample a view of that size.
absl::Status validate(const Raster& raster, std::int32_t viewWidth, std::int32_t viewHeight);

}  // namespace eyrie::fabric
