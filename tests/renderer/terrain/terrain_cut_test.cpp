// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/terrain_cut.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "renderer/terrain/backs.h"
#include "tests/renderer/terrain/hard_grids.h"

namespace eyrie::terrain {
namespace {

using test::Random;

/// An index without a file: random errors, saturated.
EytIndex randomIndex(std::uint32_t columns, std::uint32_t rows, Random& random) {
    EytIndex index;
    index.quadtree = Quadtree(columns, rows);
    index.objectFromLattice[0][0] = index.objectFromLattice[1][1] = 30;
    index.tiles.resize(index.quadtree.tileCount());
    for (int level = 0; level < index.quadtree.levels(); ++level)
        for (std::int32_t y = 0; y < index.quadtree.tilesY(level); ++y)
            for (std::int32_t x = 0; x < index.quadtree.tilesX(level); ++x) {
                const TileId id{level, x, y};
                TileRecord& tile = index.tiles[index.quadtree.tileIndex(id)];
                tile.errorMetres =
                    level == 0 ? 0 : static_cast<float>(random.unit() * (4 << level));
                tile.maxHeightMetres = 1000;
                tile.outlineMetres =
                    level > 2 ? static_cast<float>(random.unit() * (8 << level)) : 0;
                tile.nodataParts = static_cast<std::uint16_t>(random.next() & random.next());
                for (std::uint16_t& row : tile.partErrors)
                    row = static_cast<std::uint16_t>(random.next() | 15);
                for (int i = 0; i < 4 && level > 0; ++i)
                    if (const TileId child = Quadtree::child(id, i); index.quadtree.contains(child))
                        tile.coverErrorsOf(i, index.tile(child));
                tile.triangles = 100;
            }
    return index;
}

lod::ObjectView randomView(const EytIndex& index, Random& random) {
    const fabric::Box box = index.bounds();
    const auto inside = [&] {
        return box.min + box.size() * fabric::Vec3(random.unit(), random.unit(), random.unit());
    };
    fabric::Camera camera;
    camera.eye = inside() + fabric::Vec3(0, 0, 3000 * random.unit());
    camera.target = inside() - fabric::Vec3(0, 0, 500);
    camera.fovYDegrees = 20 + 60 * random.unit();
    return {lod::View(camera, 1280, 720), fabric::Mat4(1.0)};
}

/// Which tile of the cut draws each tile of level 0.
std::map<std::pair<std::int32_t, std::int32_t>, TileId> coverage(const EytIndex& index,
                                                                 const TerrainCut& cut) {
    std::map<std::pair<std::int32_t, std::int32_t>, TileId> result;
    for (const TileChoice& choice : cut.tiles) {
        const std::int32_t scale = 1 << choice.id.level;
        for (std::int32_t y = choice.id.y * scale; y < (choice.id.y + 1) * scale; ++y)
            for (std::int32_t x = choice.id.x * scale; x < (choice.id.x + 1) * scale; ++x)
                if (index.quadtree.contains({0, x, y})) {
                    EXPECT_TRUE(result.emplace(std::pair{x, y}, choice.id).second)
                        << "drawn twice: " << x << ", " << y;
                }
    }
    return result;
}

class TerrainCutLaws : public testing::TestWithParam<std::uint64_t> {
protected:
    void SetUp() override {
        Random random(GetParam());
        index_ = randomIndex(static_cast<std::uint32_t>(random.integer(2, 2500)),
                             static_cast<std::uint32_t>(random.integer(2, 2500)), random);
        view_.emplace(randomView(index_, random));
        tau_ = std::exp2(random.integer(-2, 5));
        cut_ = selectCut(index_, *view_, tau_);
    }

    EytIndex index_;
    std::optional<lod::ObjectView> view_;
    double tau_ = 1;
    TerrainCut cut_;
};

TEST_P(TerrainCutLaws, CoversTheTerrainOnce) {
    EXPECT_EQ(static_cast<std::int32_t>(coverage(index_, cut_).size()),
              index_.quadtree.tilesX(0) * index_.quadtree.tilesY(0));
}

TEST_P(TerrainCutLaws, NeighboursDifferByOneLevelAtMostAndSaySo) {
    const auto tiles = coverage(index_, cut_);
    for (const TileChoice& choice : cut_.tiles) {
        std::uint8_t finer = 0;
        const std::int32_t scale = 1 << choice.id.level;
        const std::int32_t x0 = choice.id.x * scale, x1 = x0 + scale;
        const std::int32_t y0 = choice.id.y * scale, y1 = y0 + scale;
        const auto look = [&](std::int32_t x, std::int32_t y, int edge) {
            const auto found = tiles.find({x, y});
            if (found == tiles.end())
                return;
            EXPECT_LE(std::abs(found->second.level - choice.id.level), 1);
            if (found->second.level < choice.id.level)
                finer = static_cast<std::uint8_t>(finer | 1 << edge);
        };
        for (std::int32_t k = 0; k < scale; ++k) {
            look(x0 - 1, y0 + k, kEdgeMinX);
            look(x1, y0 + k, kEdgeMaxX);
            look(x0 + k, y0 - 1, kEdgeMinY);
            look(x0 + k, y1, kEdgeMaxY);
        }
        EXPECT_EQ(choice.finerEdges, finer);
    }
}

TEST_P(TerrainCutLaws, KeepsTauOnEveryVisibleTileAboveTheFinestLevel) {
    double worst = 0;
    for (const TileChoice& choice : cut_.tiles) {
        const fabric::Box bounds = index_.bounds(choice.id);
        const double error =
            view_->isVisible(bounds) ? screenSpaceErrorPixels(index_, *view_, choice.id) : 0;
        EXPECT_TRUE(error <= tau_ || choice.id.level == 0);
        worst = std::max(worst, error);
    }
    EXPECT_EQ(screenSpaceErrorPixels(index_, *view_, cut_), worst);
}

/// Parts of tiles that are not at the ends of the tree.
TEST_P(TerrainCutLaws, KeepsHeightsWhereColoursTellThem) {
    // By its height no ground is off by a pixel; errors are 4 m and more where tiles are coarse.
    for (TileRecord& tile : index_.tiles) tile.maxHeightMetres = 16;
    fabric::Mat4 flat(1.0);
    flat[2][2] = 1e-6;
    const lod::ObjectView view(view_->view(), flat);
    const double tolerance = tau_ * heightToleranceMetres(index_);
    EXPECT_EQ(heightToleranceMetres(index_), 2);
    for (const TileChoice& choice : selectCut(index_, view, tau_).tiles) {
        const TileRecord& tile = index_.tile(choice.id);
        for (int x = 0; x < kTilePartsPerSide && choice.isVisible && choice.id.level > 1; ++x)
            for (int y = 0; y < kTilePartsPerSide; ++y) {
                const TileId part{choice.id.level - 2, choice.id.x * kTilePartsPerSide + x,
                                  choice.id.y * kTilePartsPerSide + y};
                if (!index_.quadtree.contains(part) || tile.errorMetresOf(x, y, 1) <= tolerance)
                    continue;
                const fabric::Box box = index_.bounds(part);
                const double post = 30 << choice.id.level;
                const double side = std::max(box.size().x, box.size().y);
                EXPECT_TRUE(!view.isVisible(box) ||
                            view.screenSpaceErrorPixels(post, box) <= tau_ ||
                            view.screenSpaceErrorPixels(side, box) <= tau_ * 16 / tolerance);
            }
    }
}

TEST_P(TerrainCutLaws, IsTheSameEachTimeAndInDepthFirstOrder) {
    const TerrainCut again = selectCut(index_, *view_, tau_);
    EXPECT_EQ(again.tiles, cut_.tiles);
    const auto morton = [](const TileId& tile) {
        std::uint64_t code = 0;
        const auto x = static_cast<std::uint64_t>(tile.x) << tile.level;
        const auto y = static_cast<std::uint64_t>(tile.y) << tile.level;
        for (int bit = 0; bit < 24; ++bit)
            code |= (x >> bit & 1) << (2 * bit) | (y >> bit & 1) << (2 * bit + 1);
        return code;
    };
    EXPECT_TRUE(
        std::is_sorted(cut_.tiles.begin(), cut_.tiles.end(),
                       [&](const auto& a, const auto& b) { return morton(a.id) < morton(b.id); }));
}

TEST_P(TerrainCutLaws, OfWhatIsThereHasTheErrorOfItsWorstTile) {
    Random random(GetParam());
    const double share = random.unit();
    std::vector<bool> isResident(index_.quadtree.tileCount());
    for (std::size_t i = 0; i < isResident.size(); ++i) isResident[i] = random.unit() < share;
    Refinement drawn = refineForError(index_, *view_, tau_);
    drawn.coarsen([&](const TileId& tile) { return isResident[index_.quadtree.tileIndex(tile)]; });
    const TerrainCut cut = cutOf(index_, *view_, drawn);
    double worst = 0;
    for (const TileChoice& choice : cut.tiles)
        if (const fabric::Box bounds = index_.bounds(choice.id); view_->isVisible(bounds))
            worst = std::max(worst, screenSpaceErrorPixels(index_, *view_, choice.id));
    EXPECT_EQ(screenSpaceErrorPixels(index_, *view_, cut), worst);
}

INSTANTIATE_TEST_SUITE_P(RandomTerrains, TerrainCutLaws, testing::Range<std::uint64_t>(0, 60));

TEST(TerrainCut, IsTheTopTileWhenNothingIsSeen) {
    Random random(4);
    const EytIndex index = randomIndex(1000, 1000, random);
    fabric::Camera camera;
    camera.eye = index.bounds().max + fabric::Vec3(1000);
    camera.target = camera.eye + fabric::Vec3(1, 1, 1);
    const lod::ObjectView view(lod::View(camera, 640, 480), fabric::Mat4(1.0));
    const TerrainCut cut = selectCut(index, view, 1);
    ASSERT_EQ(cut.tiles.size(), 1U);
    EXPECT_EQ(cut.tiles[0].id, index.quadtree.top());
    EXPECT_EQ(screenSpaceErrorPixels(index, view, cut), 0);
}

TEST(TerrainCut, LeavesOutTilesWithoutTriangles) {
    Random random(5);
    EytIndex index = randomIndex(1000, 1000, random);
    const TileId hole{0, 3, 2};
    index.tiles[index.quadtree.tileIndex(hole)].triangles = 0;
    fabric::Camera camera;
    camera.eye = index.bounds(hole).centre() + fabric::Vec3(0, 0, 600);
    camera.target = index.bounds(hole).centre();
    camera.up = {0, 1, 0};
    const lod::ObjectView view(lod::View(camera, 640, 480), fabric::Mat4(1.0));
    const TerrainCut cut = selectCut(index, view, 0.01);
    const auto isAt = [&](const TileId& id) {
        return std::any_of(cut.tiles.begin(), cut.tiles.end(),
                           [&](const TileChoice& choice) { return choice.id == id; });
    };
    EXPECT_FALSE(isAt(hole));
    EXPECT_TRUE(isAt({0, 4, 2}));
}

TEST(TerrainCut, HidesItsBacksFromAboveATerrainWithoutHolesOnly) {
    Random random(6);
    EytIndex index = randomIndex(1000, 700, random);
    const TileId high{0, 3, 2};
    index.tiles[index.quadtree.tileIndex(high)].maxHeightMetres = 1500;
    const double side = 30 * Quadtree::side(0);
    TerrainCut cut;
    for (std::int32_t y = 0; y < index.quadtree.tilesY(0); ++y)
        for (std::int32_t x = 0; x < index.quadtree.tilesX(0); ++x)
            cut.tiles.push_back({{0, x, y}});
    const auto hides = [&](const fabric::Vec3& eye, const fabric::Mat4& worldFromObject) {
        fabric::Camera camera;
        camera.eye = fabric::Vec3(worldFromObject * fabric::Vec4(eye, 1));
        camera.target = camera.eye + fabric::Vec3(1, 1, -0.1);
        return hidesItsBacks(index, cut,
                             lod::ObjectView(lod::View(camera, 640, 480), worldFromObject));
    };
    const fabric::Mat4 here(1.0);
    EXPECT_TRUE(hides({100, 100, 1001}, here));
    EXPECT_FALSE(hides({100, 100, 999}, here)) << "perhaps below the ground";
    EXPECT_FALSE(hides({-1, 100, 1001}, here)) << "beside the terrain";
    EXPECT_FALSE(hides({100, 30 * 699 + 1, 1001}, here)) << "beside the terrain";
    EXPECT_FALSE(hides({3.5 * side, 2.5 * side, 1001}, here)) << "the ground is higher there";
    EXPECT_FALSE(hides({3 * side - 0.0001, 2.5 * side, 1001}, here)) << "the near plane cuts it";
    EXPECT_TRUE(hides({3 * side - 1, 2.5 * side, 1001}, here));
    fabric::Mat4 small(1e-3);
    small[3][3] = 1;
    EXPECT_FALSE(hides({3 * side - 1, 2.5 * side, 1001}, small)) << "the near plane cuts it";
    fabric::Mat4 turnedOver(1.0);
    turnedOver[2][2] = -1;
    EXPECT_TRUE(hides({100, 100, 1001}, turnedOver));
    EXPECT_FALSE(hides({100, 100, -1}, turnedOver));
    index.nodataPosts = 1;
    EXPECT_FALSE(hides({100, 100, 1001}, here)) << "a hole may show a back";
}

}  // namespace
}  // namespace eyrie::terrain
