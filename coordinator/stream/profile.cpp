// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/profile.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "fabric/camera.h"

namespace eyrie::stream {

absl::Status validate(const ProfileLine& line) {
    constexpr double kMost = fabric::kMaxCoordinateMetres;
    for (const auto& [field, metres] : {std::pair("from.x", line.from.x),
                                        {"from.y", line.from.y},
                                        {"to.x", line.to.x},
                                        {"to.y", line.to.y}})
        if (!(std::abs(metres) <= kMost))
            return absl::InvalidArgumentError(fmt::format(
                "{} is {:g} metres; it must be from {:g} to {:g}", field, metres, -kMost, kMost));
    if (line.samples < 2 || line.samples > kMaxSamples)
        return absl::InvalidArgumentError(
            fmt::format("samples is {}; it must be 2 to {}", line.samples, kMaxSamples));
    return absl::OkStatus();
}

absl::StatusOr<fabric::Box> profiledBounds(const coordinator::Status& status) {
    if (!status.sceneInfo.bounds.isEmpty())
        return status.sceneInfo.bounds;
    return absl::UnavailableError(status.problem.empty() ? "no scene is open yet" : status.problem);
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
