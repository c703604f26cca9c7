// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/profile.h"

#include <cmath>

#include <fmt/format.h>

namespace eyrie::stream {

absl::Status validate(const ProfileLine& line) {
    for (const double one : {line.from.x, line.from.y, line.to.x, line.to.y})
        if (!std::isfinite(one))
            return absl::InvalidArgumentError("an end of the profile is not finite");
    if (line.samples < 2 || line.samples > kMaxSamples)
        return absl::InvalidArgumentError(fmt::format(
            "the profile has {} samples; it must have 2 to {}", line.samples, kMaxSamples));
    return absl::OkStatus();
}

fabric::PickRequest pickFromAbove(const ProfileLine& line, int index, const fabric::Box& scene) {
    const double share = static_cast<double>(index) / (line.samples - 1);
    const fabric::Vec2 at = line.from * (1 - share) + line.to * share;
    const double margin = 1 + 0.01 * (scene.max.z - scene.min.z);
    fabric::PickRequest request;
    request.camera.eye = {at, scene.max.z + margin};
    request.camera.target = {at, scene.min.z - margin};
    request.camera.up = {0, 1, 0};
    request.viewWidth = request.viewHeight = 1;
    request.place = {0.5, 0.5};
    request.hidden = line.hidden;
    return request;
}

}  // namespace eyrie::stream
