// SPDX-License-Identifier: Apache-2.0
#include "cli/placement.h"

#include <algorithm>
#include <optional>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "fabric/status.h"

namespace eyrie::cli {
namespace {

using fabric::Box;
using fabric::Mat4;
using fabric::Vec2;
using fabric::Vec3;
using fabric::Vec4;

constexpr double kShareOfTerrain = 0.25;

/// The finest tile over a point of the lattice, or the nearest one.
terrain::TileId tileAt(const terrain::Quadtree& tree, const Vec2& post) {
    const auto clamped = [](double coordinate, std::int32_t tiles) {
        return static_cast<std::int32_t>(
            std::clamp(coordinate / terrain::Quadtree::side(0), 0.0, tiles - 1.0));
    };
    return {0, clamped(post.x, tree.tilesX(0)), clamped(post.y, tree.tilesY(0))};
}

/// A vertex on the lattice: column, row and height.
Vec3 latticePoint(const terrain::TileGeometry& tile, const terrain::TileId& id, std::size_t n) {
    const std::uint32_t* word = &tile.words[n * static_cast<std::size_t>(tile.wordsPerVertex)];
    const double height = (word[0] >> 20) + (tile.wordsPerVertex == 2 ? word[1] : 0U);
    return {id.x * terrain::Quadtree::side(0) + (word[0] & 1023U) / 2.0,
            id.y * terrain::Quadtree::side(0) + (word[0] >> 10 & 1023U) / 2.0,
            tile.baseHeight + height * tile.heightMultiplier};
}

/// Height, in lattice steps, of the triangle whose indices begin at `first`, if it covers `post`.
std::optional<double> heightInTriangle(const terrain::TileGeometry& tile, const terrain::TileId& id,
                                       std::size_t first, const Vec2& post) {
    const Vec3 a = latticePoint(tile, id, tile.indices[first]);
    const Vec3 ab = latticePoint(tile, id, tile.indices[first + 1]) - a;
    const Vec3 ac = latticePoint(tile, id, tile.indices[first + 2]) - a;
    const Vec2 p = post - Vec2(a);
    const double area = ab.x * ac.y - ab.y * ac.x;
    const double u = (p.x * ac.y - p.y * ac.x) / area;
    const double v = (ab.x * p.y - ab.y * p.x) / area;
    if (!(u >= 0 && v >= 0 && u + v <= 1))
        return std::nullopt;
    return a.z + u * ab.z + v * ac.z;
}

double longestSide(const Vec3& size) { return std::max({size.x, size.y, size.z}); }

}  // namespace

bool overlapsInPlan(const Box& a, const Box& b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y;
}

absl::StatusOr<double> groundHeightMetres(const terrain::EytFile& terrain, double x, double y) {
    const terrain::EytIndex& index = terrain.index();
    const Vec2 post(glm::inverse(index.objectFromLattice) * Vec4(x, y, 0, 1));
    const terrain::TileId id = tileAt(index.quadtree, post);
    const std::uint32_t page = index.quadtree.pageIndex(id);
    if (index.pages[page].bytes == 0)
        return index.bounds().min.z;
    ASSIGN_OR_RETURN(const auto contents, terrain.readPage(page));
    const terrain::TileGeometry& tile = contents->tile(terrain::Quadtree::placeInPage(id));
    for (int part = terrain::kInteriorPart; part < terrain::kFinerPart; ++part) {
        const terrain::IndexRange range = tile.parts[static_cast<std::size_t>(part)];
        for (std::uint32_t i = range.first; i < range.first + range.count; i += 3)
            if (const auto steps = heightInTriangle(tile, id, i, post))
                return index.heightOriginMetres() + index.heightStepMetres() * *steps;
    }
    return index.bounds().min.z;
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
