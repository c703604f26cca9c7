// SPDX-License-Identifier: Apache-2.0
#include "fabric/pick.h"

#include <cmath>

#include <fmt/format.h>

#include "fabric/channel_task.h"
#include "fabric/look.h"
#include "fabric/status.h"

namespace eyrie::fabric {

absl::Status validate(const PickRequest& request) {
    // First, for a camera may have come from it.
    if (!(std::abs(request.exaggeration) <= kMaxExaggeration))
        return absl::InvalidArgumentError(
            fmt::format("exaggeration is {}; it must be from {} to {}", request.exaggeration,
                        -kMaxExaggeration, kMaxExaggeration));
    RETURN_IF_ERROR(validate(request.camera));
    if (request.sight)
        RETURN_IF_ERROR(validate(*request.sight));
    const auto isSide = [](std::int32_t side) { return side >= 1 && side <= kMaxViewPixels; };
    if (!isSide(request.viewWidth) || !isSide(request.viewHeight))
        return absl::InvalidArgumentError(
            fmt::format("the view is {} x {} pixels; each side must be from 1 to {}",
                        request.viewWidth, request.viewHeight, kMaxViewPixels));
    const auto isWithin = [](double place, std::int32_t side) {
        return place >= 0 && place <= side;
    };
    if (!isWithin(request.place.x, request.viewWidth) ||
        !isWithin(request.place.y, request.viewHeight))
        return absl::InvalidArgumentError(
            fmt::format("place ({}, {}) is not in the view of {} x {} pixels", request.place.x,
                        request.place.y, request.viewWidth, request.viewHeight));
    return absl::OkStatus();
}

}  // namespace eyrie::fabric
