// SPDX-License-Identifier: Apache-2.0
#include "cli/placement.h"

#include <algorithm>
#include <limits>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "fabric/status.h"

namespace eyrie::cli {
namespace {

using fabric::Box;
using fabric::Mat4;
using fabric::Vec3;
using fabric::Vec4;

constexpr double kShareOfTerrain = 0.25;

double longestSide(const Vec3& size) { return std::max({size.x, size.y, size.z}); }

}  // namespace

bool overlapsInPlan(const Box& a, const Box& b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y;
}

absl::StatusOr<double> groundHeightMetres(const terrain::EytFile& terrain, double x, double y) {
    const terrain::EytIndex& index = terrain.index();
    const Vec4 post = glm::inverse(index.objectFromLattice) * Vec4(x, y, 0, 1);
    const auto tileOf = [](double coordinate, std::int32_t tiles) {
        return std::clamp(static_cast<std::int32_t>(coordinate / terrain::Quadtree::side(0)), 0,
                          tiles - 1);
    };
    const terrain::TileId id{0, tileOf(post.x, index.quadtree.tilesX(0)),
                             tileOf(post.y, index.quadtree.tilesY(0))};
    const std::uint32_t page = index.quadtree.pageIndex(id);
    double height = index.bounds().min.z;
    if (index.pages[page].bytes == 0)
        return height;
    ASSIGN_OR_RETURN(const auto contents, terrain.readPage(page));
    const terrain::TileGeometry& tile = contents->tile(terrain::Quadtree::placeInPage(id));
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < tile.vertexCount(); ++n) {
        const std::uint32_t* word = &tile.words[n * static_cast<std::size_t>(tile.wordsPerVertex)];
        const double i = id.x * terrain::Quadtree::side(0) + (word[0] & 1023U) / 2.0;
        const double j = id.y * terrain::Quadtree::side(0) + (word[0] >> 10 & 1023U) / 2.0;
        const double distance = std::max(std::abs(i - post.x), std::abs(j - post.y));
        if (distance >= nearest)
            continue;
        nearest = distance;
        const double steps = (word[0] >> 20) + (tile.wordsPerVertex == 2 ? word[1] : 0U);
        height = index.heightOriginMetres() +
                 index.heightStepMetres() * (tile.baseHeight + steps * tile.heightMultiplier);
    }
    return height;
}

absl::StatusOr<Mat4> placeOnTerrain(const Box& mesh, const terrain::EytFile& terrain) {
    const Box ground = terrain.index().bounds();
    const Vec3 middle = ground.centre();
    ASSIGN_OR_RETURN(const double height, groundHeightMetres(terrain, middle.x, middle.y));
    const double scale =
        kShareOfTerrain * longestSide(ground.size()) / std::max(longestSide(mesh.size()), 1e-9);
    const Vec3 foot(mesh.centre().x, mesh.centre().y, mesh.min.z);
    Mat4 world = glm::translate(Mat4(1.0), Vec3(middle.x, middle.y, height));
    world = glm::scale(world, Vec3(scale));
    return glm::translate(world, -foot);
}

}  // namespace eyrie::cli
