// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/uniform_decimation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <meshoptimizer.h>

#include "fabric/box.h"

namespace eyrie::truth {
namespace {

/// Single precision around the mesh's own middle: coordinates may be large, the mesh small.
std::vector<glm::vec3> localPositions(const TriangleMesh& mesh) {
    fabric::Box bounds;
    for (const fabric::Vec3& position : mesh.positions) bounds.grow(position);
    std::vector<glm::vec3> local;
    local.reserve(mesh.positions.size());
    for (const fabric::Vec3& position : mesh.positions)
        local.emplace_back(position - bounds.centre());
    return local;
}

/// The sides of what a camera sees, as planes through its eye.
class ViewSides {
public:
    ViewSides(const fabric::Mat4& worldFromObject, const Pinhole& camera)
        : worldFromObject_(worldFromObject), camera_(camera) {
        const double right = camera.width();
        const double top = camera.height();
        const std::array<fabric::Vec2, 5> corners{
            {{0, 0}, {right, 0}, {right, top}, {0, top}, {0, 0}}};
        const Ray middle = camera.rayThrough(right / 2, top / 2);
        eye_ = middle.origin;
        for (std::size_t k = 0; k < inwards_.size(); ++k) {
            const fabric::Vec3 normal =
                glm::cross(camera.rayThrough(corners[k].x, corners[k].y).direction,
                           camera.rayThrough(corners[k + 1].x, corners[k + 1].y).direction);
            inwards_[k] = glm::dot(normal, middle.direction) < 0 ? -normal : normal;
        }
    }

    /// A bit for each that a point is beyond.
    std::uint8_t beyond(const fabric::Vec3& point) const {
        const fabric::Vec3 world(worldFromObject_ * fabric::Vec4(point, 1));
        unsigned sides = camera_.depth(world) > 0 ? 0 : 1U << inwards_.size();
        for (std::size_t k = 0; k < inwards_.size(); ++k)
            sides |= glm::dot(inwards_[k], world - eye_) < 0 ? 1U << k : 0;
        return static_cast<std::uint8_t>(sides);
    }

private:
    const fabric::Mat4& worldFromObject_;
    const Pinhole& camera_;
    fabric::Vec3 eye_;
    std::array<fabric::Vec3, 4> inwards_;
};

}  // namespace

HeightGrid everyPost(const HeightGrid& grid, int stride) {
    HeightGrid coarse{.columns = (grid.columns - 1) / stride + 1,
                      .rows = (grid.rows - 1) / stride + 1,
                      .heights = {},
                      .origin = grid.origin,
                      .perColumn = grid.perColumn * static_cast<double>(stride),
                      .perRow = grid.perRow * static_cast<double>(stride)};
    coarse.heights.reserve(static_cast<std::size_t>(coarse.columns) *
                           static_cast<std::size_t>(coarse.rows));
    for (int j = 0; j < coarse.rows; ++j)
        for (int i = 0; i < coarse.columns; ++i)
            coarse.heights.push_back(
                grid.heights[static_cast<std::size_t>(j) * static_cast<std::size_t>(stride) *
                                 static_cast<std::size_t>(grid.columns) +
                             static_cast<std::size_t>(i * stride)]);
    return coarse;
}

std::size_t trianglesOf(const HeightGrid& grid) {
    const auto columns = static_cast<std::size_t>(grid.columns);
    std::size_t cells = 0;
    for (std::size_t j = 0; j + 1 < static_cast<std::size_t>(grid.rows); ++j)
        for (std::size_t i = j * columns; i + 1 < (j + 1) * columns; ++i)
            cells += std::isnan(grid.heights[i] + grid.heights[i + 1] + grid.heights[i + columns] +
                                grid.heights[i + columns + 1])
                         ? 0
                         : 1;
    return 2 * cells;
}

std::size_t trianglesInView(const HeightGrid& grid, const fabric::Mat4& worldFromGrid,
                            const Pinhole& camera) {
    const ViewSides sides(worldFromGrid, camera);
    const auto columns = static_cast<std::size_t>(grid.columns);
    constexpr std::uint8_t kNone = 0xff;  // nodata: no triangle has it
    std::vector<std::uint8_t> beyond(grid.heights.size());
    for (int j = 0; j < grid.rows; ++j)
        for (int i = 0; i < grid.columns; ++i) {
            const std::size_t at =
                static_cast<std::size_t>(j) * columns + static_cast<std::size_t>(i);
            const auto place = grid.origin + static_cast<double>(i) * grid.perColumn +
                               static_cast<double>(j) * grid.perRow;
            const double height = static_cast<double>(grid.heights[at]);
            beyond[at] = std::isnan(height) ? kNone : sides.beyond({place.x, place.y, height});
        }
    std::size_t seen = 0;
    for (std::size_t at = 0; at + columns + 1 < beyond.size(); ++at) {
        const std::array<std::uint8_t, 4> posts{beyond[at], beyond[at + 1], beyond[at + columns],
                                                beyond[at + columns + 1]};
        if (at % columns + 1 == columns || std::ranges::find(posts, kNone) != posts.end())
            continue;
        seen += (posts[0] & posts[1] & posts[3]) == 0 ? 1 : 0;
        seen += (posts[0] & posts[2] & posts[3]) == 0 ? 1 : 0;
    }
    return seen;
}

std::size_t trianglesInView(const TriangleMesh& mesh, const fabric::Mat4& worldFromMesh,
                            const Pinhole& camera) {
    const ViewSides sides(worldFromMesh, camera);
    std::vector<std::uint8_t> beyond;
    beyond.reserve(mesh.positions.size());
    for (const fabric::Vec3& position : mesh.positions) beyond.push_back(sides.beyond(position));
    return static_cast<std::size_t>(std::ranges::count_if(mesh.triangles, [&](const auto& corners) {
        return (beyond[corners[0]] & beyond[corners[1]] & beyond[corners[2]]) == 0;
    }));
}

TriangleMesh clustered(const TriangleMesh& mesh, std::size_t triangles) {
    const std::vector<glm::vec3> positions = localPositions(mesh);
    const auto* const indices = mesh.triangles.front().data();
    std::vector<std::uint32_t> kept(mesh.triangles.size() * 3);
    constexpr float kAnyError = 1;
    kept.resize(meshopt_simplifySloppy(kept.data(), indices, kept.size(), &positions.front().x,
                                       positions.size(), sizeof(glm::vec3), triangles * 3,
                                       kAnyError, nullptr));
    constexpr auto kNew = ~std::uint32_t{0};
    std::vector<std::uint32_t> places(mesh.positions.size(), kNew);
    TriangleMesh coarse;
    for (std::size_t i = 0; i < kept.size(); i += 3) {
        std::array<std::uint32_t, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& place = places[kept[i + k]];
            if (place == kNew) {
                place = static_cast<std::uint32_t>(coarse.positions.size());
                coarse.positions.push_back(mesh.positions[kept[i + k]]);
            }
            corners[k] = place;
        }
        coarse.triangles.push_back(corners);
    }
    return coarse;
}

}  // namespace eyrie::truth
