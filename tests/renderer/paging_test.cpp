// SPDX-License-Identifier: Apache-2.0
// Terrain whose pages come late, never, or do not all fit into memory.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "renderer/gl/debug_output.h"
#include "renderer/import/terrain_import.h"
#include "renderer/import/terrain_synth.h"
#include "renderer/renderer.h"
#include "renderer/terrain/eyt_format.h"
#include "tests/renderer/sample_scene.h"
#include "tests/support/captured_log.h"

namespace eyrie {
namespace {

using fabric::Camera;
using fabric::ChannelResult;
using fabric::Completeness;
using fabric::Vec3;
using terrain::Quadtree;
using terrain::TileId;

constexpr int kWidth = 640;
constexpr int kHeight = 360;
constexpr auto kPatience = std::chrono::seconds(30);

class Paging : public testing::Test {
protected:
    void SetUp() override {
        gl::setOnGlError(gl::OnGlError::Abort);
        auto scene = test::sampleScene(test::SampleKind::Terrain);
        ASSERT_TRUE(scene.ok()) << scene.status();
        scene_ = *scene;
        auto file = terrain::EytFile::open(scene_.objects[0].path);
        ASSERT_TRUE(file.ok()) << file.status();
        file_ = *file;
        copy_ = scene_.objects[0].path + ".copy";
        std::filesystem::copy_file(scene_.objects[0].path, copy_,
                                   std::filesystem::copy_options::overwrite_existing);
    }
    void TearDown() override { std::filesystem::remove(copy_); }

    const Quadtree& quadtree() const { return file_->index().quadtree; }

    /// Damages the copy's page, or repairs it when it is damaged.
    void flip(std::uint32_t page) {
        const terrain::PageRecord& record = file_->index().pages[page];
        if (record.bytes == 0)
            return;
        std::fstream file(copy_, std::ios::in | std::ios::out | std::ios::binary);
        const auto at = static_cast<std::streamoff>(record.offset + record.bytes / 2);
        file.seekg(at);
        const char byte = static_cast<char>(~file.get());
        file.seekp(at);
        file.put(byte);
    }

    /// Damages the pages of all levels below `level` that lie in the western half, or everywhere.
    void withhold(int level, bool everywhere) {
        for (std::uint32_t page = 0; page < quadtree().pageCount(); ++page) {
            const TileId first = quadtree().firstTileOfPage(page);
            const bool isWest = 2 * first.x < quadtree().tilesX(first.level);
            if (first.level < level && (isWest || everywhere))
                flip(page);
        }
    }

    /// Damages the pages of one level everywhere.
    void withholdLevel(int level) {
        for (std::uint32_t page = 0; page < quadtree().pageCount(); ++page)
            if (quadtree().firstTileOfPage(page).level == level)
                flip(page);
    }

    std::unique_ptr<Renderer> open(const std::string& path, const RendererOptions& options = {}) {
        auto renderer = Renderer::create(options);
        EXPECT_TRUE(renderer.ok()) << renderer.status();
        fabric::Scene scene = scene_;
        scene.objects[0].path = path;
        const auto info = (*renderer)->openScene(scene);
        EXPECT_TRUE(info.ok()) << info.status();
        return *std::move(renderer);
    }

    /// Above the border between the western and the eastern half; only terrain can be seen.
    Camera lookingDown(int i) const {
        const fabric::Box box = file_->index().bounds();
        Camera camera;
        camera.eye = box.centre() + Vec3(200.0 * (i % 5 - 2), 1500.0 * (i - 4), 0);
        camera.eye.z = box.max.z + 300.0 * (i + 1);
        camera.target = camera.eye + Vec3(300.0 * (i % 3 - 1), 200.0 * (i % 2), -1000);
        camera.up = {0, 1, 0};
        return camera;
    }

    /// Level, so that a column of the picture is a vertical plane of the world.
    Camera lookingAhead(int i) const {
        const fabric::Box box = file_->index().bounds();
        const double azimuth = 0.7 * i;
        Camera camera;
        camera.eye = box.centre();
        camera.eye.z = box.max.z + 10 + 100 * i;
        camera.target = camera.eye + Vec3(std::cos(azimuth), std::sin(azimuth), 0);
        return camera;
    }

    ChannelResult draw(Renderer& renderer, const Camera& camera, Completeness completeness,
                       double tau = 1, const fabric::Range& range = {}) {
        fabric::FrameData frame;
        frame.camera = camera;
        frame.tauPixels = tau;
        fabric::ChannelTask task;
        task.viewWidth = kWidth;
        task.viewHeight = kHeight;
        task.pixelViewport = {0, 0, kWidth, kHeight};
        task.wantsDepth = true;
        task.completeness = completeness;
        task.range = range;
        auto result = renderer.render(frame, task);
        EXPECT_TRUE(result.ok()) << result.status();
        if (!result.ok())
            return {};
        fabric::Image whole = fabric::makeImage(task.pixelViewport, scene_.background, true);
        if (!result->image.area.isEmpty())
            fabric::paste(result->image, whole);
        return {std::move(whole), result->statistics};
    }

    /// Interactive frames until one is complete.
    ChannelResult converge(Renderer& renderer, const Camera& camera) {
        const auto deadline = std::chrono::steady_clock::now() + kPatience;
        while (std::chrono::steady_clock::now() < deadline) {
            ChannelResult result = draw(renderer, camera, Completeness::Interactive);
            if (result.statistics.complete)
                return result;
            EXPECT_GT(result.statistics.pagesMissing, 0U);
        }
        ADD_FAILURE() << "no interactive frame was complete in time";
        return {};
    }

    static std::size_t uncovered(const fabric::Image& image) {
        return static_cast<std::size_t>(
            std::count_if(image.depth.begin(), image.depth.end(), [](float d) { return d <= 0; }));
    }

    /// Pixels through which one sees the background below terrain.
    static std::size_t holesBelowTerrain(const fabric::Image& image) {
        std::size_t holes = 0;
        for (std::size_t x = 0; x < kWidth; ++x) {
            bool isBelow = false;
            for (std::size_t y = kHeight; y-- > 0;) {  // rows go from the bottom up
                const bool isCovered = image.depth[y * kWidth + x] > 0;
                holes += isBelow && !isCovered ? 1 : 0;
                isBelow = isBelow || isCovered;
            }
        }
        return holes;
    }

    static std::size_t different(const fabric::Image& one, const fabric::Image& other) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < one.depth.size(); ++i)
            count += one.depth[i] == other.depth[i] && one.colour[i] == other.colour[i] ? 0 : 1;
        return count;
    }

    fabric::Scene scene_;
    std::shared_ptr<const terrain::EytFile> file_;
    std::string copy_;
};

class WithheldPages : public Paging, public testing::WithParamInterface<int> {};

TEST_P(WithheldPages, LeaveNoHoleWhereLevelsJump) {
    const test::CapturedLog log;
    const int jump = GetParam();
    withhold(jump, 2 * jump > quadtree().levels());
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

INSTANTIATE_TEST_SUITE_P(Jumps, WithheldPages, testing::Values(2, 3, 5));

/// Renderers of one frame raise tau each by its own, the more the larger their range.
TEST_F(Paging, RangesMeetWhereMemoryBinds) {
    RendererOptions options;
    {
        const auto plenty = open(scene_.objects[0].path);
        draw(*plenty, lookingDown(3), Completeness::Complete);
        options.memoryBytes = plenty->memory().deviceBytes * 4 / 10;
    }
    int apart = 0;
    for (const double cut : {0.2, 0.3, 0.5, 0.9}) {
        const auto one = open(scene_.objects[0].path, options);
        const auto two = open(scene_.objects[0].path, options);
        for (int i = 0; i < 9; ++i) {
            const Camera camera = lookingDown(i);
            ChannelResult first = draw(*one, camera, Completeness::Complete, 0.5, {0, cut});
            const ChannelResult second = draw(*two, camera, Completeness::Complete, 0.5, {cut, 1});
            apart +=
                first.statistics.tauAchievedPixels > 2 * second.statistics.tauAchievedPixels ||
                        second.statistics.tauAchievedPixels > 2 * first.statistics.tauAchievedPixels
                    ? 1
                    : 0;
            for (std::size_t p = 0; p < first.image.depth.size(); ++p)
                first.image.depth[p] = std::max(first.image.depth[p], second.image.depth[p]);
            EXPECT_EQ(uncovered(first.image), 0U) << cut << ", view " << i;
        }
    }
    EXPECT_GT(apart, 3) << "they should have reached errors of their own";
}

TEST_F(Paging, RenderersOfOneThreadTakeTurns) {
    const auto one = open(scene_.objects[0].path);
    const ChannelResult before = draw(*one, lookingDown(1), Completeness::Complete);
    {
        const auto two = open(scene_.objects[0].path);
        draw(*two, lookingDown(2), Completeness::Complete);
        draw(*one, lookingDown(3), Completeness::Complete);
        EXPECT_TRUE(draw(*two, lookingDown(1), Completeness::Complete).image == before.image);
    }
    EXPECT_TRUE(draw(*one, lookingDown(1), Completeness::Complete).image == before.image);
}

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

TEST_F(Paging, AnInteractiveFrameDoesNotWaitAndHasNoHoles) {
    const auto renderer = open(scene_.objects[0].path);
    const ChannelResult first = draw(*renderer, lookingDown(0), Completeness::Interactive, 0.25);
    EXPECT_FALSE(first.statistics.complete);
    EXPECT_GT(first.statistics.tauAchievedPixels, 0.25);
    EXPECT_EQ(uncovered(first.image), 0U);
    for (int i = 0; i < 60; ++i)
        EXPECT_EQ(uncovered(draw(*renderer, lookingDown(i % 9), Completeness::Interactive).image),
                  0U);
}

TEST_F(Paging, InteractiveFramesBecomeTheCompleteOne) {
    const auto waiting = open(scene_.objects[0].path);
    const auto interactive = open(scene_.objects[0].path);
    for (int i = 0; i < 4; ++i) {
        const ChannelResult expected = draw(*waiting, lookingAhead(i), Completeness::Complete);
        EXPECT_TRUE(expected.statistics.complete);
        const ChannelResult actual = converge(*interactive, lookingAhead(i));
        EXPECT_EQ(different(expected.image, actual.image), 0U) << "camera " << i;
        EXPECT_EQ(actual.statistics.tauAchievedPixels, expected.statistics.tauAchievedPixels);
        EXPECT_EQ(actual.statistics.triangles, expected.statistics.triangles);
    }
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

TEST_F(Paging, ATopPageThatCannotBeReadKeepsTheSceneFromOpening) {
    flip(quadtree().pageIndex(quadtree().top()));
    auto renderer = Renderer::create({});
    ASSERT_TRUE(renderer.ok());
    fabric::Scene scene = scene_;
    scene.objects[0].path = copy_;
    EXPECT_TRUE(absl::IsDataLoss((*renderer)->openScene(scene).status()));
}

TEST_F(Paging, TooLittleMemoryForAPageKeepsTheSceneFromOpening) {
    RendererOptions options;
    options.hostMemoryBytes = 1000;
    auto renderer = Renderer::create(options);
    ASSERT_TRUE(renderer.ok());
    EXPECT_TRUE(absl::IsResourceExhausted((*renderer)->openScene(scene_).status()));
}

TEST_F(Paging, AnIndexCountsAsHostMemory) {
    const terrain::EytIndex& index = file_->index();
    const std::uint64_t bytes = index.tiles.size() * sizeof(terrain::TileRecord) +
                                index.pages.size() * sizeof(terrain::PageRecord);
    EXPECT_EQ(open(scene_.objects[0].path)->memory().hostBytes, bytes) << "and no page yet";
}

TEST_F(Paging, TooLittleMemoryForAnIndexKeepsTheSceneFromOpeningAndSaysSo) {
    RendererOptions options;
    options.hostMemoryBytes = open(scene_.objects[0].path)->memory().hostBytes - 1;
    auto renderer = Renderer::create(options);
    ASSERT_TRUE(renderer.ok());
    const absl::Status status = (*renderer)->openScene(scene_).status();
    EXPECT_TRUE(absl::IsResourceExhausted(status));
    EXPECT_NE(status.message().find("indices"), std::string::npos) << status;
    EXPECT_NE(status.message().find("--host-memory"), std::string::npos) << status;
}

/// Looking away from the terrain, beside which the camera is, through a lens as long as makes all
/// of it what may be needed soon.
TEST_F(Paging, WhatMayBeNeededSoonIsThereWhenTheCameraTurns) {
    const auto pages = static_cast<std::uint64_t>(
        std::ranges::count_if(file_->index().pages, [](auto& page) { return page.bytes > 0; }));
    const fabric::Box box = file_->index().bounds();
    Camera camera;
    camera.eye = {box.min.x - 500, box.centre().y, box.max.z + 500};
    camera.target = camera.eye - Vec3(1, 0, 0);
    camera.fovYDegrees = 2;
    const auto renderer = open(scene_.objects[0].path);
    std::uint64_t loaded = 1;  // the top tile's
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (loaded < pages && std::chrono::steady_clock::now() < end) {
        const ChannelResult away = draw(*renderer, camera, Completeness::Interactive, 0.01);
        EXPECT_EQ(away.statistics.nodes, 0U);
        EXPECT_TRUE(away.statistics.complete);
        loaded += away.statistics.pagesLoaded;
    }
    EXPECT_EQ(loaded, pages);
    camera.target = camera.eye + Vec3(1, 0, -0.4);
    camera.fovYDegrees = Camera().fovYDegrees;
    ChannelResult turned = draw(*renderer, camera, Completeness::Interactive, 0.1);
    while (!turned.statistics.complete && std::chrono::steady_clock::now() < end) {
        EXPECT_EQ(turned.statistics.pagesLoaded, 0U);
        turned = draw(*renderer, camera, Completeness::Interactive, 0.1);
    }
    EXPECT_EQ(turned.statistics.pagesLoaded, 0U);
    EXPECT_GT(turned.statistics.nodes, 10U);
    const ChannelResult complete =
        draw(*open(scene_.objects[0].path), camera, Completeness::Complete, 0.1);
    EXPECT_EQ(different(turned.image, complete.image), 0U);
}

class LittleMemory : public Paging, public testing::WithParamInterface<bool> {
protected:
    /// Inside the coarser tiles' bounds, where no finite error is promised, or clear of them.
    Camera camera(int i) const {
        if (GetParam())
            return lookingAhead(i);
        Camera camera = lookingAhead(0);
        camera.eye += Vec3(0, 300 * i, 9000);
        camera.target = camera.eye + Vec3(1, 0, -1);
        return camera;
    }
};

TEST_P(LittleMemory, AQuarterOfWhatIsNeededIsKeptToAndLoadingComesToRest) {
    const auto unlimited = open(scene_.objects[0].path);
    draw(*unlimited, camera(0), Completeness::Complete, 0.1);
    RendererOptions options;
    options.memoryBytes = unlimited->memory().deviceBytes / 4;
    options.hostMemoryBytes = std::uint64_t{8} << 20;
    const auto renderer = open(scene_.objects[0].path, options);
    const auto withinLimits = [&] {
        const RendererMemory memory = renderer->memory();
        return memory.deviceBytes <= options.memoryBytes &&
               memory.hostBytes <= options.hostMemoryBytes;
    };
    for (int i = 0; i < 40; ++i) {
        const ChannelResult result =
            draw(*renderer, camera(i % 10), Completeness::Interactive, 0.1);
        EXPECT_TRUE(withinLimits());
        EXPECT_EQ(holesBelowTerrain(result.image), 0U);
    }
    // A camera at rest: all that fits arrives, then nothing more is loaded.
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    ChannelResult result;
    for (int quiet = 0; quiet < 30;) {
        ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "loading does not come to rest";
        result = draw(*renderer, camera(0), Completeness::Interactive, 0.1);
        EXPECT_TRUE(withinLimits());
        quiet = result.statistics.pagesLoaded == 0 && result.statistics.complete ? quiet + 1 : 0;
    }
    EXPECT_EQ(result.statistics.pagesMissing, 0U);
    EXPECT_EQ(holesBelowTerrain(result.image), 0U);
    EXPECT_GT(result.statistics.tauAchievedPixels, 0.1) << "which does not fit";
    EXPECT_TRUE(GetParam() || std::isfinite(result.statistics.tauAchievedPixels));
    const ChannelResult complete =
        draw(*open(scene_.objects[0].path, options), camera(0), Completeness::Complete, 0.1);
    EXPECT_TRUE(complete.statistics.complete);
    EXPECT_EQ(different(complete.image, result.image), 0U);
}

INSTANTIATE_TEST_SUITE_P(Cameras, LittleMemory, testing::Bool());

/// In shares of what two views need together.
struct Limits {
    double device;
    double host;
};

class ByTurns : public Paging, public testing::WithParamInterface<Limits> {
protected:
    static constexpr double kTau = 0.1;

    /// From the middle, one way and the other.
    Camera camera(int view) const {
        const fabric::Box box = file_->index().bounds();
        Camera camera = lookingAhead(0);
        camera.eye.z = box.max.z + 500;
        camera.target = camera.eye + Vec3(view == 0 ? 1 : -1, 0.3, -0.4);
        return camera;
    }

    RendererOptions options() {
        const auto unlimited = open(scene_.objects[0].path);
        for (int view = 0; view < 2; ++view)
            draw(*unlimited, camera(view), Completeness::Complete, kTau);
        const RendererMemory all = unlimited->memory();
        RendererOptions options;
        options.memoryBytes =
            static_cast<std::uint64_t>(GetParam().device * static_cast<double>(all.deviceBytes));
        options.hostMemoryBytes =
            static_cast<std::uint64_t>(GetParam().host * static_cast<double>(all.hostBytes));
        return options;
    }

    /// Draws the views by turns until nothing has been read for some rounds and all are complete.
    std::vector<ChannelResult> rest(Renderer& renderer, const std::vector<int>& views) {
        const auto deadline = std::chrono::steady_clock::now() + kPatience;
        std::vector<ChannelResult> results;
        for (int quiet = 0; quiet < 10;) {
            if (std::chrono::steady_clock::now() > deadline) {
                ADD_FAILURE() << "loading does not come to rest";
                break;
            }
            results.clear();
            bool isQuiet = true;
            for (const int view : views) {
                results.push_back(draw(renderer, camera(view), Completeness::Interactive, kTau));
                const fabric::FrameStatistics& statistics = results.back().statistics;
                isQuiet = isQuiet && statistics.complete && statistics.pagesLoaded == 0;
            }
            quiet = isQuiet ? quiet + 1 : 0;
        }
        return results;
    }
};

TEST_P(ByTurns, TwoViewsComeToRestAndOneThatIsGoneLeavesItsShare) {
    const RendererOptions limits = options();
    const auto renderer = open(scene_.objects[0].path, limits);
    const std::vector<ChannelResult> both = rest(*renderer, {0, 1});
    EXPECT_LE(renderer->memory().deviceBytes, limits.memoryBytes);
    EXPECT_LE(renderer->memory().hostBytes, limits.hostMemoryBytes);
    const std::vector<ChannelResult> again = rest(*renderer, {0, 1});
    for (const std::size_t view : {0U, 1U}) {
        EXPECT_EQ(different(both[view].image, again[view].image), 0U);
        EXPECT_TRUE(std::isfinite(both[view].statistics.tauAchievedPixels));
    }
    const ChannelResult alone = rest(*renderer, {0}).front();
    const ChannelResult complete =
        draw(*open(scene_.objects[0].path, limits), camera(0), Completeness::Complete, kTau);
    EXPECT_EQ(different(alone.image, complete.image), 0U);
    if (GetParam().device < 1)
        EXPECT_LT(alone.statistics.tauAchievedPixels, both[0].statistics.tauAchievedPixels);
    else
        EXPECT_EQ(different(both[0].image, complete.image), 0U);
}

/// On the device less than both views need, hardly more than one does, and more than both; on the
/// host less than both need, with what may be needed soon.
INSTANTIATE_TEST_SUITE_P(Memories, ByTurns,
                         testing::Values(Limits{0.6, 0.7}, Limits{0.5, 4}, Limits{6, 0.7}));

}  // namespace
}  // namespace eyrie
