// SPDX-License-Identifier: Apache-2.0
// The promise of every tile beside its holes, checked on what was written: what is drawn where the
// source has nothing, and what the source has where nothing is drawn, is no farther from the other
// surface than the index says. Where a tile's inside draws nothing, its neighbours may be beside
// it, of which it knows nothing: ground that it leaves out is then no farther from nodata.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/truth/triangle.h"
#include "tests/renderer/import/terrain_fixture.h"
#include "tests/renderer/terrain/hard_grids.h"

namespace eyrie {
namespace {

using fabric::Vec3;
using terrain::HeightGrid;
using terrain::TileId;
using test::GridKind;

constexpr double kPostMetres = 10;  ///< of hard grids

Vec3 place(double i, double j, double z) { return {kPostMetres * i, kPostMetres * j, z}; }
Vec3 place(const terrain::Corner& corner) { return place(corner.i, corner.j, corner.z); }

/// Whether the source has ground in the cell that a post begins, or ends at the grid's edge: three
/// posts make half a cell.
bool hasGround(const HeightGrid& grid, std::int32_t i, std::int32_t j) {
    i = std::min(i, grid.columns - 2);
    j = std::min(j, grid.rows - 2);
    int data = 0;
    for (const auto& [column, row] :
         {std::pair(i, j), std::pair(i + 1, j), std::pair(i, j + 1), std::pair(i + 1, j + 1)})
        data += std::isnan(grid.at(column, row)) ? 0 : 1;
    return data >= 3;
}

/// Whether a post is a corner of ground: between others that are not, nothing is.
bool isOfGround(const HeightGrid& grid, std::int32_t i, std::int32_t j) {
    return !std::isnan(grid.at(i, j)) &&
           (hasGround(grid, i, j) || (i > 0 && hasGround(grid, i - 1, j)) ||
            (j > 0 && hasGround(grid, i, j - 1)) ||
            (i > 0 && j > 0 && hasGround(grid, i - 1, j - 1)));
}

/// What a tile draws.
class DrawnTile {
public:
    DrawnTile(const terrain::EytFile& file, const TileId& id, std::uint8_t finerEdges) {
        for (const test::DrawnTriangle& triangle : test::drawnTile(file, id, finerEdges)) {
            triangles_.push_back(test::inMetres(file, triangle));
            cover(triangles_.back());
        }
        for (const terrain::Triangle& t : triangles_) {
            const auto [i0, i1] = std::minmax({t[0].i, t[1].i, t[2].i});
            const auto [j0, j1] = std::minmax({t[0].j, t[1].j, t[2].j});
            for (std::int32_t j = j0 / kBin; j <= j1 / kBin; ++j)
                for (std::int32_t i = i0 / kBin; i <= i1 / kBin; ++i)
                    bins_[{i, j}].push_back({place(t[0]), place(t[1]), place(t[2])});
        }
    }

    const std::vector<terrain::Triangle>& triangles() const { return triangles_; }

    /// Whether a point of a triangle is.
    bool isWithin(double metres, const Vec3& point) const {
        const auto binOf = [](double place) {
            return static_cast<std::int32_t>(std::floor(place / (kPostMetres * kBin)));
        };
        const std::int32_t reach = binOf(metres) + 1;
        for (std::int32_t ring = 0; ring <= reach; ++ring)
            for (std::int32_t j = -ring; j <= ring; ++j)
                for (std::int32_t i = -ring; i <= ring; i += std::abs(j) == ring ? 1 : 2 * ring)
                    if (isWithin(metres, point, {binOf(point.x) + i, binOf(point.y) + j}))
                        return true;
        return false;
    }

    /// At a post; infinite where nothing is.
    double heightAt(std::int32_t i, std::int32_t j) const {
        const auto found = heights_.find({i, j});
        return found == heights_.end() ? std::numeric_limits<double>::infinity() : found->second;
    }

private:
    using Place = std::pair<std::int32_t, std::int32_t>;
    static constexpr std::int32_t kBin = 4;  ///< posts a side

    bool isWithin(double metres, const Vec3& point, const Place& bin) const {
        const auto found = bins_.find(bin);
        return found != bins_.end() &&
               std::any_of(found->second.begin(), found->second.end(),
                           [&](const truth::Triangle& triangle) {
                               return glm::distance(truth::closestPoint(triangle, point), point) <=
                                      metres;
                           });
    }

    void cover(const terrain::Triangle& t) {
        const auto [i0, i1] = std::minmax({t[0].i, t[1].i, t[2].i});
        const auto [j0, j1] = std::minmax({t[0].j, t[1].j, t[2].j});
        for (std::int32_t j = j0; j <= j1; ++j)
            for (std::int32_t i = i0; i <= i1; ++i) {
                const auto side = [&, i = i, j = j](std::size_t a, std::size_t b) {
                    return static_cast<double>((t[b].i - t[a].i) * (j - t[a].j) -
                                               (t[b].j - t[a].j) * (i - t[a].i));
                };
                const double u = side(1, 2), v = side(2, 0), w = side(0, 1);
                if (u >= 0 && v >= 0 && w >= 0)
                    heights_[{i, j}] = (u * t[0].z + v * t[1].z + w * t[2].z) / (u + v + w);
            }
    }

    std::vector<terrain::Triangle> triangles_;
    std::map<Place, std::vector<truth::Triangle>> bins_;  ///< where its box reaches
    std::map<Place, double> heights_;                     ///< of posts
};

/// Whether a post without data is.
bool isNodataWithin(double metres, const HeightGrid& grid, std::int32_t i, std::int32_t j) {
    const auto reach = static_cast<std::int32_t>(metres / kPostMetres);
    for (std::int32_t row = std::max(0, j - reach); row <= std::min(grid.rows - 1, j + reach);
         ++row)
        for (std::int32_t column = std::max(0, i - reach);
             column <= std::min(grid.columns - 1, i + reach); ++column)
            if (std::isnan(grid.at(column, row)) &&
                std::hypot(column - i, row - j) * kPostMetres <= metres)
                return true;
    return false;
}

/// Posts of a tile's ground that are farther from what it draws. Where its inside draws nothing:
/// from nodata.
std::size_t groundBeyond(double metres, const HeightGrid& grid, const TileId& id,
                         const DrawnTile& tile, bool isInsideEmpty) {
    const std::int32_t side = terrain::Quadtree::side(id.level);
    const std::int32_t endI = std::min(id.x * side + side, grid.columns - 1);
    const std::int32_t endJ = std::min(id.y * side + side, grid.rows - 1);
    std::size_t beyond = 0;
    for (std::int32_t j = id.y * side; j < endJ; ++j)
        for (std::int32_t i = id.x * side; i < endI; ++i) {
            if (!hasGround(grid, i, j))
                continue;
            for (const auto& [column, row] : {std::pair(i, j), std::pair(i + 1, j),
                                              std::pair(i, j + 1), std::pair(i + 1, j + 1)}) {
                const double height = grid.at(column, row);
                if (std::isnan(height) || std::abs(tile.heightAt(column, row) - height) <= metres ||
                    (isInsideEmpty && isNodataWithin(metres, grid, column, row)) ||
                    tile.isWithin(metres, place(column, row, height)))
                    continue;
                ++beyond;
            }
        }
    return beyond;
}

/// Whether a post of ground is.
bool isGroundWithin(double metres, const HeightGrid& grid, const Vec3& point) {
    const auto at = [](double value, double last) {
        return static_cast<std::int32_t>(std::clamp(value / kPostMetres, 0.0, last));
    };
    for (std::int32_t j = at(point.y - metres, grid.rows - 1);
         j <= at(point.y + metres, grid.rows - 1); ++j)
        for (std::int32_t i = at(point.x - metres, grid.columns - 1);
             i <= at(point.x + metres, grid.columns - 1); ++i)
            if (glm::distance(point, place(i, j, grid.at(i, j))) <= metres &&
                isOfGround(grid, i, j))
                return true;
    return false;
}

/// Points of what a tile draws over no ground, and posts where it draws, that are farther from
/// posts of ground.
std::size_t drawnBeyond(double metres, const HeightGrid& grid, const DrawnTile& tile) {
    constexpr int kSteps = 8;
    std::size_t beyond = 0;
    for (const terrain::Triangle& t : tile.triangles())
        for (int a = 0; a <= kSteps; ++a)
            for (int b = 0; a + b <= kSteps; ++b) {
                const double u = 1.0 * a / kSteps, v = 1.0 * b / kSteps;
                const double x = t[0].i + u * (t[1].i - t[0].i) + v * (t[2].i - t[0].i);
                const double y = t[0].j + u * (t[1].j - t[0].j) + v * (t[2].j - t[0].j);
                const Vec3 point =
                    place(x, y, t[0].z + u * (t[1].z - t[0].z) + v * (t[2].z - t[0].z));
                const auto i = static_cast<std::int32_t>(std::floor(x));
                const auto j = static_cast<std::int32_t>(std::floor(y));
                const bool isPost = x == i && y == j;
                if (isPost ? std::abs(grid.at(i, j) - point.z) <= metres && isOfGround(grid, i, j)
                           : hasGround(grid, i, j))
                    continue;
                beyond += isGroundWithin(metres, grid, point) ? 0 : 1;
            }
    return beyond;
}

struct Holes {
    std::string name;
    std::function<bool(std::int32_t, std::int32_t, test::Random&)> areAt;
};

std::vector<Holes> allHoles() {
    return {
        {"Single", [](auto, auto, auto& random) { return random.unit() < 0.02; }},
        {"Many", [](auto, auto, auto& random) { return random.unit() < 0.3; }},
        {"Stripes", [](auto i, auto j, auto&) { return (i + j / 3) % 17 < 3; }},
        {"AllButStrips", [](auto i, auto j, auto&) { return (i / 2 + j / 64) % 9 != 0; }},
        {"AllButDiagonals", [](auto i, auto j, auto&) { return (i - j + 310) % 31 > 3; }},
        {"AllButIslands",
         [](auto i, auto j, auto&) { return std::sin(i / 6.0) * std::sin(j / 5.0) < 0.6; }},
        {"AllButAShoreAndSoundings",
         [](auto i, auto j, auto&) {
             return i > 250 + 30 * std::sin(j / 7.0) && (i % 8 != 0 || j % 8 != 0);
         }},
    };
}

std::uint8_t neighboursOf(const terrain::EytIndex& index, const TileId& id) {
    std::uint8_t edges = 0;
    for (int edge = 0; edge < terrain::kEdges; ++edge)
        if (index.quadtree.contains(terrain::Quadtree::neighbour(id, edge)))
            edges = static_cast<std::uint8_t>(edges | 1 << edge);
    return edges;
}

class TerrainOutline : public testing::TestWithParam<Holes> {};

TEST_P(TerrainOutline, IsNoFartherOffThanTheIndexSays) {
    std::size_t checked = 0;
    for (const GridKind kind : {GridKind::Smooth, GridKind::Cliff}) {
        HeightGrid grid = test::hardGrid(kind, 400, 200, 5);
        test::Random random(7);
        for (std::int32_t j = 0; j < grid.rows; ++j)
            for (std::int32_t i = 0; i < grid.columns; ++i)
                if (GetParam().areAt(i, j, random))
                    grid.row(j)[i] = terrain::kNodata;
        const test::TemporaryFolder folder;
        const auto file = test::imported(grid, folder);
        ASSERT_NE(file, nullptr);
        const terrain::EytIndex& index = file->index();
        for (std::uint32_t k = 0; k < index.quadtree.tileCount(); ++k) {
            const TileId id = index.quadtree.tileOf(k);
            const terrain::TileRecord& record = index.tile(id);
            if (record.outlineMetres == 0)
                continue;
            const double allowed = record.greatestErrorMetres() * (1 + 1e-6) + 1e-6;
            const auto page = file->readPage(index.quadtree.pageIndex(id));
            ASSERT_TRUE(page.ok()) << page.status();
            const bool isInsideEmpty =
                test::drawnPart(*file, (*page)->tile(terrain::Quadtree::placeInPage(id)), id,
                                terrain::kInteriorPart)
                    .empty();
            for (const std::uint8_t finerEdges : {std::uint8_t{0}, neighboursOf(index, id)}) {
                const DrawnTile tile(*file, id, finerEdges);
                const std::string where = fmt::format("{} tile {} {} {} edges {}", name(kind),
                                                      id.level, id.x, id.y, finerEdges);
                EXPECT_EQ(drawnBeyond(allowed, grid, tile), 0U) << where;
                EXPECT_EQ(groundBeyond(allowed, grid, id, tile, isInsideEmpty), 0U) << where;
                ++checked;
            }
        }
    }
    EXPECT_GE(checked, 8U);
}

INSTANTIATE_TEST_SUITE_P(Holes, TerrainOutline, testing::ValuesIn(allHoles()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace eyrie
