// SPDX-License-Identifier: Apache-2.0
#include "fabric/seen_area.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "fabric/status.h"

namespace eyrie::fabric {

absl::Status validate(const SeenArea& area) {
    constexpr double kRounding = 1e-9;
    for (int i = 0; i < 2; ++i)
        if (!(area.corner[i] >= 0 && area.size[i] > 0 &&
              area.corner[i] + area.size[i] <= 1 + kRounding))
            return absl::InvalidArgumentError(
                fmt::format("area has its corner at ({}, {}) and a size of {} x {}; it must be a "
                            "part of the picture, whose sides are 1",
                            area.corner.x, area.corner.y, area.size.x, area.size.y));
    return validate(area.sight);
}

Frustum part(const Frustum& whole, const Vec2& corner, const Vec2& size) {
    const double width = whole.right - whole.left;
    const double height = whole.top - whole.bottom;
    return {whole.left + corner.x * width, whole.left + (corner.x + size.x) * width,
            whole.bottom + corner.y * height, whole.bottom + (corner.y + size.y) * height};
}

absl::StatusOr<std::optional<PickRequest>> pickIn(const SeenAreas& areas,
                                                  const PickRequest& inPicture) {
    RETURN_IF_ERROR(validate(inPicture));
    if (!areas)
        return std::optional(inPicture);
    const Vec2 whole(inPicture.viewWidth, inPicture.viewHeight);
    const Vec2 share = inPicture.place / whole;
    const auto found = std::find_if(areas->rbegin(), areas->rend(),
                                    [&](const SeenArea& area) { return area.contains(share); });
    if (found == areas->rend())
        return std::optional<PickRequest>();
    PickRequest request = inPicture;
    const Vec2 size = found->size * whole;
    request.viewWidth = std::max(1, static_cast<std::int32_t>(std::lround(size.x)));
    request.viewHeight = std::max(1, static_cast<std::int32_t>(std::lround(size.y)));
    const Vec2 view(request.viewWidth, request.viewHeight);
    request.place = glm::clamp((share - found->corner) / found->size * view, Vec2(0, 0), view);
    request.sight = found->sight;
    return std::optional(request);
}

}  // namespace eyrie::fabric
