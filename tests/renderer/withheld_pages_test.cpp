// SPDX-License-Identifier: Apache-2.0
// Terrain whose pages cannot be read.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/import/terrain_import.h"
#include "renderer/import/terrain_synth.h"
#include "renderer/renderer.h"
#include "renderer/terrain/eyt_format.h"
#include "tests/renderer/paging_fixture.h"
#include "tests/support/captured_log.h"

namespace eyrie {
namespace {

using fabric::Camera;
using fabric::ChannelResult;
using fabric::Completeness;
using fabric::Vec3;
using terrain::TileId;
using test::Paging;

/// So wide that pages of the fifth level lie west and east of its middle, too.
terrain::HeightGrid wideHills() {
    terrain::HeightGrid grid{4097, 1025, {}, {}, {30, 0}, {0, 30}};
    for (int j = 0; j < grid.rows; ++j)
        for (int i = 0; i < grid.columns; ++i)
            grid.heights.push_back(
                static_cast<float>(200 * std::sin(i / 40.0) * std::sin(j / 30.0) +
                                   8 * std::sin(i / 3.0) * std::cos(j / 2.0)));
    return grid;
}

/// Of this many levels the western half's pages cannot be read, beside an eastern half of which all
/// can be.
class HardCase3 : public Paging, public testing::WithParamInterface<int> {
protected:
    void SetUp() override {
        Paging::SetUp();
        if (2 * GetParam() > quadtree().levels())
            take(wideHills());
        for (int level = 0; level < GetParam(); ++level)
            ASSERT_GT(quadtree().pagesX(level), 1) << "level " << level;
    }
};

TEST_P(HardCase3, LeavesNoHoleWhereLevelsJump) {
    const test::CapturedLog log;
    withholdWest(GetParam());
    const auto intact = open(scene_.objects[0].path);
    const auto withheld = open(copy_);
    for (int i = 0; i < 9; ++i) {
        const ChannelResult whole = draw(*intact, lookingDown(i), Completeness::Complete, 0.25);
        EXPECT_TRUE(whole.statistics.complete);
        EXPECT_EQ(uncovered(whole.image), 0U) << "the test wants terrain everywhere";
        const ChannelResult coarse = draw(*withheld, lookingDown(i), Completeness::Complete, 0.25);
        EXPECT_EQ(uncovered(coarse.image), 0U) << "looking down, camera " << i;
        EXPECT_FALSE(coarse.statistics.complete);
        EXPECT_GT(coarse.statistics.pagesMissing, 0U);
        EXPECT_GE(coarse.statistics.pagesFailed, 1U);
        EXPECT_GT(coarse.statistics.tauAchievedPixels, whole.statistics.tauAchievedPixels);
        EXPECT_EQ(
            holesBelowTerrain(draw(*withheld, lookingAhead(i), Completeness::Complete, 0.25).image),
            0U)
            << "looking ahead, camera " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Jumps, HardCase3, testing::Values(2, 3, 5));

TEST_F(Paging, TilesWhoseNormalsCannotBeReadAreNotDrawn) {
    const test::CapturedLog log;
    withholdLevel(quadtree().normalLevel());
    const auto renderer = open(copy_);
    const auto intact = open(scene_.objects[0].path);
    for (int i = 0; i < 4; ++i) {
        const ChannelResult whole = draw(*intact, lookingDown(i), Completeness::Complete, 0.1);
        for (const Completeness completeness :
             {Completeness::Complete, Completeness::Interactive}) {
            const ChannelResult result = draw(*renderer, lookingDown(i), completeness, 0.1);
            EXPECT_EQ(uncovered(result.image), 0U);
            EXPECT_FALSE(result.statistics.complete);
            EXPECT_GE(result.statistics.pagesFailed, 1U);
            EXPECT_LT(result.statistics.triangles, whole.statistics.triangles);
        }
    }
}

/// A hill 33 posts wide in the midst of nodata, where only the finest level can draw it: its
/// normals are those of a tile that has no triangles.
TEST_F(Paging, ATileIsDrawnWhereTheOneWithItsNormalsIsNot) {
    terrain::HeightGrid grid = import::synthesizeTerrain(300, 7);
    for (std::int32_t j = 0; j < grid.rows; ++j)
        for (std::int32_t i = 0; i < grid.columns; ++i)
            if (std::min(i, j) < 32 || std::max(i, j) > 64 || i + j == 128)
                grid.row(j)[i] = terrain::kNodata;
    import::GridHeightSource posts(grid);
    import::TerrainImportOptions options;
    options.errorMetres = 1e6;  // leaves the outline of the data as it is
    ASSERT_TRUE(import::importTerrain(posts, {"hill", "", 0}, copy_, options, {}).ok());
    const auto file = terrain::EytFile::open(copy_);
    ASSERT_TRUE(file.ok());
    const terrain::EytIndex& index = (*file)->index();
    ASSERT_GT(index.tile({0, 1, 1}).triangles, 0U);
    ASSERT_EQ(index.tile({2, 0, 0}).triangles, 0U);
    Camera camera;
    camera.target = index.bounds({0, 1, 1}).centre();
    camera.eye = camera.target + Vec3(0, 0, 3000);
    camera.up = {0, 1, 0};
    const ChannelResult whole = draw(*open(copy_), camera, Completeness::Complete);
    EXPECT_TRUE(whole.statistics.complete);
    EXPECT_GT(whole.statistics.triangles, 0U);
    EXPECT_LT(uncovered(whole.image), whole.image.depth.size());
    EXPECT_EQ(different(converge(*open(copy_), camera).image, whole.image), 0U);
}

TEST_F(Paging, ACorruptPageIsDrawnAsItsAncestorAndNamedOnce) {
    const TileId seen{0, quadtree().tilesX(0) / 2, quadtree().tilesY(0) / 2};
    const std::uint32_t page = quadtree().pageIndex(seen);
    Camera camera;
    camera.target = file_->index().bounds(seen).centre();
    camera.eye = camera.target + Vec3(0, 0, 2000);
    camera.up = {0, 1, 0};
    const ChannelResult whole =
        draw(*open(scene_.objects[0].path), camera, Completeness::Complete, 0.1);
    flip(page);
    const test::CapturedLog log;
    const auto renderer = open(copy_);
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(700);
    while (std::chrono::steady_clock::now() < end)  // it is tried again meanwhile
        for (const Completeness completeness :
             {Completeness::Complete, Completeness::Interactive}) {
            const ChannelResult result = draw(*renderer, camera, completeness, 0.1);
            EXPECT_FALSE(result.statistics.complete);
            EXPECT_EQ(result.statistics.pagesFailed, 1U);
            EXPECT_EQ(uncovered(result.image), 0U);
            EXPECT_GT(result.statistics.tauAchievedPixels, whole.statistics.tauAchievedPixels);
        }
    EXPECT_EQ(log.count(fmt::format("page {}:", page)), 1);
    flip(page);
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    ChannelResult result;
    while (!result.statistics.complete || result.image.depth.empty()) {
        ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "the page is readable again";
        result = draw(*renderer, camera, Completeness::Interactive, 0.1);
    }
    EXPECT_EQ(different(result.image, whole.image), 0U);
    EXPECT_EQ(log.count("can be read again"), 1);
}

/// The loader tries a damaged page again after ten seconds.
TEST_F(Paging, AStillIsAsFineAsCanBeReadWhenADamagedPageIsTriedAgain) {
    const test::CapturedLog log;
    const TileId first{0, quadtree().tilesX(0) / 2, quadtree().tilesY(0) / 2};
    const std::uint32_t page = quadtree().pageIndex(first);
    const TileId last{0, first.x + 3, first.y + 3};
    ASSERT_EQ(quadtree().pageIndex(last), page);
    flip(page);
    const auto above = [&](const TileId& tile) {
        Camera camera;
        camera.target = file_->index().bounds(tile).centre();
        camera.eye = camera.target + Vec3(0, 0, 2000);
        camera.up = {0, 1, 0};
        camera.fovYDegrees = 2;
        return camera;
    };
    const auto renderer = open(copy_);
    draw(*renderer, above(first), Completeness::Complete, 0.01);
    std::this_thread::sleep_for(std::chrono::milliseconds(10'100));
    const ChannelResult due = draw(*renderer, above(last), Completeness::Complete, 0.01);
    const ChannelResult again = draw(*renderer, above(last), Completeness::Complete, 0.01);
    EXPECT_EQ(due.statistics.pagesFailed, 1U);
    EXPECT_EQ(due.statistics.tauAchievedPixels, again.statistics.tauAchievedPixels);
    EXPECT_EQ(different(due.image, again.image), 0U);
}

TEST_F(Paging, ATopPageThatCannotBeReadKeepsTheSceneFromOpening) {
    flip(quadtree().pageIndex(quadtree().top()));
    auto renderer = Renderer::create({});
    ASSERT_TRUE(renderer.ok());
    fabric::Scene scene = scene_;
    scene.objects[0].path = copy_;
    EXPECT_TRUE(absl::IsDataLoss((*renderer)->openScene(scene).status()));
}

}  // namespace
}  // namespace eyrie
