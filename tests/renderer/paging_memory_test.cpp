// SPDX-License-Identifier: Apache-2.0
// Terrain whose pages do not all fit into memory.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "renderer/renderer.h"
#include "renderer/terrain/eyt_format.h"
#include "tests/renderer/paging_fixture.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using fabric::Camera;
using fabric::ChannelResult;
using fabric::Completeness;
using fabric::Vec3;
using test::Paging;

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
            EXPECT_EQ(first.statistics.pagesMissing, 0U) << cut << ", view " << i;
            EXPECT_EQ(second.statistics.pagesMissing, 0U) << cut << ", view " << i;
        }
    }
    EXPECT_GT(apart, 3) << "they should have reached errors of their own";
}

/// What is nearer of the two pictures, pixel by pixel; of ties the first.
fabric::Image composed(fabric::Image first, const fabric::Image& second) {
    for (std::size_t i = 0; i < first.depth.size(); ++i)
        if (second.depth[i] > first.depth[i]) {
            first.depth[i] = second.depth[i];
            first.colour[i] = second.colour[i];
        }
    return first;
}

/// Two renderers that draw a half each.
TEST_F(Paging, ARendererHoldsWhatItsRangeDraws) {
    constexpr double kTau = 0.1;
    const auto plenty = open(scene_.objects[0].path);
    const ChannelResult all = draw(*plenty, lookingDown(3), Completeness::Complete, kTau);
    const std::uint64_t whole = plenty->memory().deviceBytes;
    std::vector<ChannelResult> halves;
    std::uint64_t bytes = 0;
    std::uint64_t triangles = 0;
    for (const fabric::Range& range : {fabric::Range{0, 0.5}, fabric::Range{0.5, 1}}) {
        const auto renderer = open(scene_.objects[0].path);
        halves.push_back(draw(*renderer, lookingDown(3), Completeness::Complete, kTau, range));
        EXPECT_TRUE(halves.back().statistics.complete);
        EXPECT_LE(halves.back().statistics.tauAchievedPixels, kTau);
        EXPECT_LT(renderer->memory().deviceBytes, whole * 8 / 10);
        bytes += renderer->memory().deviceBytes;
        triangles += halves.back().statistics.triangles;
    }
    EXPECT_EQ(triangles, all.statistics.triangles);
    EXPECT_LT(bytes, whole * 13 / 10);  // coarse tiles and those of the border twice
    EXPECT_EQ(different(composed(halves[0].image, halves[1].image), all.image), 0U);
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
    const std::uint64_t bytes = index.tiles.capacity() * sizeof(terrain::TileRecord) +
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

TEST_F(Paging, AnIndexThatTakesTooMuchIsNotReadFirst) {
    const std::uint64_t bytes = file_->indexMemoryBytes();
    EXPECT_EQ(bytes, open(scene_.objects[0].path)->memory().hostBytes);
    const test::TemporaryFolder folder;
    const std::string damaged = folder.path("damaged.eyt");
    std::filesystem::copy_file(scene_.objects[0].path, damaged);
    std::fstream(damaged, std::ios::binary | std::ios::in | std::ios::out).seekp(-1, std::ios::end)
        << '!';
    EXPECT_TRUE(absl::IsResourceExhausted(terrain::EytFile::open(damaged, {}, bytes - 1).status()));
    EXPECT_TRUE(absl::IsDataLoss(terrain::EytFile::open(damaged, {}, bytes).status()));
    EXPECT_TRUE(terrain::EytFile::open(scene_.objects[0].path, {}, bytes).ok());
}

TEST_F(Paging, IndicesOfAllTerrainsCountTogether) {
    RendererOptions options;
    options.hostMemoryBytes = 2 * file_->indexMemoryBytes() - 1;
    auto renderer = Renderer::create(options);
    ASSERT_TRUE(renderer.ok());
    fabric::Scene two = scene_;
    two.objects.push_back(two.objects[0]);
    const absl::Status status = (*renderer)->openScene(two).status();
    EXPECT_TRUE(absl::IsResourceExhausted(status)) << status;
    EXPECT_NE(status.message().find("its index takes"), std::string::npos) << status;
}

class HardCase23 : public Paging, public testing::WithParamInterface<bool> {
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

TEST_P(HardCase23, AQuarterOfWhatIsNeededIsKeptToAndLoadingComesToRest) {
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
    EXPECT_TRUE(complete.statistics.memoryRaisedTau);
    EXPECT_EQ(different(complete.image, result.image), 0U);
}

INSTANTIATE_TEST_SUITE_P(Cameras, HardCase23, testing::Bool());

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
