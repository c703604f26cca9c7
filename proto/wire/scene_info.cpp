// SPDX-License-Identifier: Apache-2.0
#include "wire/scene_info.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include "eyrie/v1/geometry.pb.h"
#include "eyrie/v1/render_service.pb.h"
#include "fabric/status.h"
#include "wire/numbers.h"

namespace eyrie::wire {
namespace {

void setVector(const fabric::Vec3& value, v1::Vector3& message) {
    message.set_x(value.x);
    message.set_y(value.y);
    message.set_z(value.z);
}

v1::GroundGrid toMessage(const fabric::GroundGrid& grid) {
    v1::GroundGrid message;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            message.add_world_from_grid(grid.worldFromGrid[column][row]);
    message.set_columns(grid.columns);
    message.set_rows(grid.rows);
    message.mutable_highest()->Add(grid.highest.begin(), grid.highest.end());
    message.mutable_lowest()->Add(grid.lowest.begin(), grid.lowest.end());
    message.set_object(grid.object);
    return message;
}

absl::Status checkHeights(const google::protobuf::RepeatedField<float>& heights,
                          const v1::GroundGrid& message, std::string_view field) {
    const std::int64_t cells = std::int64_t{message.columns()} * message.rows();
    if (message.columns() < 1 || message.rows() < 1 || cells > fabric::kMaxGroundCells ||
        cells != heights.size())
        return absl::InvalidArgumentError(fmt::format(
            "{} has {} numbers for {} x {} cells; it must have one a cell, and at most {}", field,
            heights.size(), message.columns(), message.rows(), fabric::kMaxGroundCells));
    if (!std::all_of(heights.begin(), heights.end(), [](float h) { return std::isfinite(h); }))
        return absl::InvalidArgumentError(fmt::format("{} has a height that is not finite", field));
    return absl::OkStatus();
}

absl::StatusOr<fabric::GroundGrid> fromMessage(const v1::GroundGrid& message) {
    RETURN_IF_ERROR(checkNumbers(message.world_from_grid(), 16, "ground.world_from_grid"));
    RETURN_IF_ERROR(checkHeights(message.highest(), message, "ground.highest"));
    RETURN_IF_ERROR(checkHeights(message.lowest(), message, "ground.lowest"));
    fabric::GroundGrid grid;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            grid.worldFromGrid[column][row] = message.world_from_grid(4 * row + column);
    const double determinant = glm::determinant(fabric::Mat3(grid.worldFromGrid));
    if (!std::isfinite(determinant) || determinant == 0)
        return absl::InvalidArgumentError(
            "ground.world_from_grid is singular; it must have an inverse");
    if (message.object() < 0)
        return absl::InvalidArgumentError(
            fmt::format("ground.object is {}; it must be 0 or more", message.object()));
    grid.columns = message.columns();
    grid.rows = message.rows();
    grid.highest.assign(message.highest().begin(), message.highest().end());
    grid.lowest.assign(message.lowest().begin(), message.lowest().end());
    grid.object = message.object();
    return grid;
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
    if (info.ground)
        for (const fabric::GroundGrid& grid : *info.ground) *message.add_ground() = toMessage(grid);
    for (const fabric::DataFile& file : info.files) {
        v1::DataFile& sent = *message.add_files();
        sent.set_bytes(file.bytes);
        sent.set_checksum(file.checksum);
    }
    for (const fabric::ObjectInfo& object : info.objects) {
        v1::ObjectInfo& sent = *message.add_objects();
        *sent.mutable_bounds() = toMessage(object.bounds);
        sent.set_triangles(object.triangles);
    }
    return message;
}

absl::StatusOr<fabric::SceneInfo> fromMessage(const v1::OpenSceneResponse& message) {
    fabric::SceneInfo info;
    if (message.has_bounds()) {
        ASSIGN_OR_RETURN(info.bounds, fromMessage(message.bounds()));
    }
    info.triangles = message.triangles();
    info.bytes = message.bytes();
    for (const v1::DataFile& file : message.files())
        info.files.push_back({file.bytes(), file.checksum()});
    for (const v1::ObjectInfo& object : message.objects()) {
        ASSIGN_OR_RETURN(const fabric::Box bounds, fromMessage(object.bounds()));
        info.objects.push_back({bounds, object.triangles()});
    }
    std::vector<fabric::GroundGrid> ground;
    for (const v1::GroundGrid& one : message.ground()) {
        ASSIGN_OR_RETURN(fabric::GroundGrid grid, fromMessage(one));
        ground.push_back(std::move(grid));
    }
    if (!ground.empty())
        info.ground = std::make_shared<const std::vector<fabric::GroundGrid>>(std::move(ground));
    return info;
}

}  // namespace eyrie::wire
