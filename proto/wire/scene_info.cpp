// SPDX-License-Identifier: Apache-2.0
#include "wire/scene_info.h"

#include <cmath>

#include <fmt/format.h>

#include "eyrie/v1/geometry.pb.h"
#include "eyrie/v1/render_service.pb.h"
#include "fabric/status.h"

namespace eyrie::wire {
namespace {

void setVector(const fabric::Vec3& value, v1::Vector3& message) {
    message.set_x(value.x);
    message.set_y(value.y);
    message.set_z(value.z);
}

}  // namespace

v1::Box toMessage(const fabric::Box& box) {
    v1::Box message;
    setVector(box.min, *message.mutable_min());
    setVector(box.max, *message.mutable_max());
    return message;
}

absl::StatusOr<fabric::Box> fromMessage(const v1::Box& message) {
    const fabric::Box box{{message.min().x(), message.min().y(), message.min().z()},
                          {message.max().x(), message.max().y(), message.max().z()}};
    for (int i = 0; i < 3; ++i)
        if (!(std::isfinite(box.min[i]) && std::isfinite(box.max[i]) && box.min[i] <= box.max[i]))
            return absl::InvalidArgumentError(fmt::format(
                "box reaches from {} to {} along axis {}; it must be finite and in order",
                box.min[i], box.max[i], "xyz"[i]));
    return box;
}

v1::OpenSceneResponse toMessage(const fabric::SceneInfo& info) {
    v1::OpenSceneResponse message;
    if (!info.bounds.isEmpty())
        *message.mutable_bounds() = toMessage(info.bounds);
    message.set_triangles(info.triangles);
    message.set_bytes(info.bytes);
    return message;
}

absl::StatusOr<fabric::SceneInfo> fromMessage(const v1::OpenSceneResponse& message) {
    fabric::SceneInfo info;
    if (message.has_bounds()) {
        ASSIGN_OR_RETURN(info.bounds, fromMessage(message.bounds()));
    }
    info.triangles = message.triangles();
    info.bytes = message.bytes();
    return info;
}

}  // namespace eyrie::wire
