// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/uniform_decimation.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

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
