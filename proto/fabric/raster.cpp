// SPDX-License-Identifier: Apache-2.0
#include "fabric/raster.h"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "fabric/channel_task.h"
#include "fabric/status.h"

namespace eyrie::fabric {
namespace {

/// Pixels by which a point that lies on the view's edge may seem to be outside.
constexpr double kRounding = 1e-6;

/// Along one side of the picture.
struct Side {
    std::string_view size;  ///< names of the fields
    std::string_view coordinate;
    std::int32_t pixels;
    double origin;
    double step;
    std::int32_t viewPixels;
};

absl::Status check(const Side& side) {
    if (side.pixels < 1 || side.pixels > kMaxViewPixels)
        return absl::InvalidArgumentError(
            fmt::format("raster.{} is {}; it must be from 1 to {} pixels", side.size, side.pixels,
                        kMaxViewPixels));
    if (!(side.step >= kMinRasterStep && side.step <= kMaxViewPixels))
        return absl::InvalidArgumentError(
            fmt::format("raster.step.{} is {}; it must be from {} to {} pixels of the view",
                        side.coordinate, side.step, kMinRasterStep, kMaxViewPixels));
    const double first = side.origin + 0.5 * side.step;
    const double last = side.origin + (side.pixels - 0.5) * side.step;
    if (first >= -kRounding && last <= side.viewPixels + kRounding)
        return absl::OkStatus();
    return absl::InvalidArgumentError(fmt::format(
        "raster.origin.{} is {}; with {} pixels, {} apart, it shows points from {} to "
        "{}, which must lie in the view's {} pixels",
        side.coordinate, side.origin, side.pixels, side.step, first, last, side.viewPixels));
}

}  // namespace

absl::Status validate(const Raster& raster, std::int32_t viewWidth, std::int32_t viewHeight) {
    RETURN_IF_ERROR(check({"width", "x", raster.width, raster.origin.x, raster.step.x, viewWidth}));
    return check({"height", "y", raster.height, raster.origin.y, raster.step.y, viewHeight});
}

}  // namespace eyrie::fabric
