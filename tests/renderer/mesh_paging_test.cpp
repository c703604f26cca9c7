// SPDX-License-Identifier: Apache-2.0
// Meshes whose pages come late, never, or do not all fit into memory.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "renderer/gl/debug_output.h"
#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_synth.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/renderer.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using fabric::ChannelResult;
using fabric::Completeness;

constexpr int kWidth = 640;
constexpr int kHeight = 360;
constexpr auto kPatience = std::chrono::seconds(30);

/// A closed ball of 150,000 triangles in three levels, coded and raw, made once.
class MeshPaging : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<test::TemporaryFolder>();
        const auto mesh = import::synthesizeMesh(150000, 4);
        ASSERT_TRUE(import::importMesh(mesh, path("coded.eym")).ok());
        ASSERT_TRUE(import::importMesh(mesh, path("raw.eym"), {.isRaw = true}).ok());
    }
    static void TearDownTestSuite() { folder_.reset(); }
    void SetUp() override { gl::setOnGlError(gl::OnGlError::Abort); }

    static std::string path(const std::string& name) { return folder_->path(name); }

    /// A copy of the coded file with damaged pages of some nodes.
    static std::string damaged(const std::set<std::uint32_t>& nodes) {
        const std::string copy = path("damaged.eym");
        std::filesystem::copy_file(path("coded.eym"), copy,
                                   std::filesystem::copy_options::overwrite_existing);
        const auto file = mesh::EymFile::open(copy);
        EXPECT_TRUE(file.ok()) << file.status();
        std::fstream bytes(copy, std::ios::in | std::ios::out | std::ios::binary);
        for (const std::uint32_t node : nodes) {
            const auto at = static_cast<std::streamoff>(file->nodes()[node].pageOffset + 40);
            bytes.seekg(at);
            const char byte = static_cast<char>(~bytes.get());
            bytes.seekp(at);
            bytes.put(byte);
        }
        return copy;
    }

    static std::unique_ptr<Renderer> open(const std::string& mesh,
                                          const RendererOptions& options = {}) {
        auto renderer = Renderer::create(options);
        EXPECT_TRUE(renderer.ok()) << renderer.status();
        fabric::Scene scene;
        scene.objects.push_back({.name = "ball", .kind = fabric::ObjectKind::Mesh, .path = mesh});
        const auto info = (*renderer)->openScene(scene);
        EXPECT_TRUE(info.ok()) << info.status();
        return *std::move(renderer);
    }

    /// Of a renderer that lives alone on this thread. From `distance` radii away along x, which
    /// fill the picture at about 2.
    static ChannelResult render(Renderer& renderer, double distance, double tauPixels,
                                Completeness completeness, const fabric::Range& range = {}) {
        const fabric::Box box = mesh::EymFile::open(path("coded.eym"))->bounds();
        fabric::Camera camera;
        camera.eye = box.centre() + fabric::Vec3(0.5 * glm::length(box.size()) * distance, 0, 0);
        camera.target = box.centre();
        return render(renderer, camera, tauPixels, completeness, range);
    }

    static ChannelResult render(Renderer& renderer, const fabric::Camera& camera, double tauPixels,
                                Completeness completeness, const fabric::Range& range = {}) {
        fabric::FrameData frame;
        frame.camera = camera;
        frame.tauPixels = tauPixels;
        fabric::ChannelTask task;
        task.viewWidth = kWidth;
        task.viewHeight = kHeight;
        task.pixelViewport = {0, 0, kWidth, kHeight};
        task.completeness = completeness;
        task.range = range;
        task.wantsDepth = true;
        const auto result = renderer.render(frame, task);
        EXPECT_TRUE(result.ok()) << result.status();
        return result.ok() ? *result : ChannelResult{};
    }

    /// Pixels that one of the pictures covers and the other does not.
    static std::uint64_t differing(const fabric::Image& a, const fabric::Image& b) {
        std::uint64_t count = 0;
        for (std::size_t i = 0; i < a.depth.size(); ++i)
            count += (a.depth[i] > 0) != (b.depth[i] > 0) ? 1 : 0;
        return count;
    }
    static std::uint64_t differing(const ChannelResult& a, const ChannelResult& b) {
        return differing(wholeOf(a), wholeOf(b));
    }

    /// Without its background.
    static fabric::Image wholeOf(const ChannelResult& result) {
        fabric::Image whole = fabric::makeImage({0, 0, kWidth, kHeight}, {}, true);
        fabric::paste(result.image, whole);
        for (std::size_t i = 0; i < whole.depth.size(); ++i)
            if (whole.depth[i] == 0)
                whole.colour[i] = {};
        return whole;
    }

    /// What is nearer of the two pictures, pixel by pixel; of ties the first.
    static fabric::Image composed(const ChannelResult& a, const ChannelResult& b) {
        fabric::Image image = wholeOf(a);
        const fabric::Image other = wholeOf(b);
        for (std::size_t i = 0; i < image.depth.size(); ++i)
            if (other.depth[i] > image.depth[i]) {
                image.depth[i] = other.depth[i];
                image.colour[i] = other.colour[i];
            }
        return image;
    }

    static std::unique_ptr<test::TemporaryFolder> folder_;
};

std::unique_ptr<test::TemporaryFolder> MeshPaging::folder_;

TEST_F(MeshPaging, PicturesAreTheSameToTheBitCodedAndRaw) {
    const auto picturesOf = [](const std::string& mesh) {
        const auto renderer = open(mesh);
        std::vector<fabric::Image> images;
        for (const double tau : {0.5, 2.0, 20.0}) {
            const ChannelResult result = render(*renderer, 2.2, tau, Completeness::Complete);
            EXPECT_TRUE(result.statistics.complete);
            EXPECT_LE(result.statistics.tauAchievedPixels, tau);
            EXPECT_GT(result.statistics.triangles, 0U);
            images.push_back(result.image);
        }
        return images;
    };
    const std::vector<fabric::Image> coded = picturesOf(path("coded.eym"));
    EXPECT_TRUE(coded == picturesOf(path("raw.eym")));
    EXPECT_FALSE(coded[0] == coded[2]);
}

TEST_F(MeshPaging, AnInteractiveFrameIsDrawnAtOnceAndBecomesTheCompleteOne) {
    const ChannelResult complete =
        render(*open(path("coded.eym")), 2.2, 0.5, Completeness::Complete);
    EXPECT_LE(complete.statistics.tauAchievedPixels, 0.5);
    const auto renderer = open(path("coded.eym"));
    ChannelResult now = render(*renderer, 2.2, 0.5, Completeness::Interactive);
    EXPECT_FALSE(now.statistics.complete);
    EXPECT_GT(now.statistics.pagesMissing, 0U);
    EXPECT_GT(now.statistics.tauAchievedPixels, 0.5);
    EXPECT_TRUE(std::isfinite(now.statistics.tauAchievedPixels));
    EXPECT_LT(differing(now, complete), kWidth);  // no hole: the outline alone may differ
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (!now.statistics.complete && std::chrono::steady_clock::now() < end) {
        const double last = now.statistics.tauAchievedPixels;
        now = render(*renderer, 2.2, 0.5, Completeness::Interactive);
        EXPECT_LE(now.statistics.tauAchievedPixels, last);  // it never gets worse
        EXPECT_LT(differing(now, complete), kWidth);
    }
    EXPECT_EQ(now.statistics.pagesMissing, 0U);
    EXPECT_EQ(now.statistics.nodes, complete.statistics.nodes);
    EXPECT_TRUE(now.image == complete.image);
}

TEST_F(MeshPaging, ADamagedNodeIsStoodInForAndReported) {
    const auto file = mesh::EymFile::open(path("coded.eym"));
    ASSERT_TRUE(file.ok());
    const auto whole = render(*open(path("coded.eym")), 2.2, 0.01, Completeness::Complete);
    std::uint32_t leaf = 0;
    while (!file->nodes()[leaf].isLeaf()) ++leaf;
    std::set<std::uint32_t> leaves;
    for (std::uint32_t node = leaf; node < file->nodes().size(); ++node)
        if (file->nodes()[node].isLeaf())
            leaves.insert(node);
    // All leaves: their parents are drawn, and what they are off by is told.
    const auto coarse = render(*open(damaged(leaves)), 2.2, 0.01, Completeness::Complete);
    EXPECT_FALSE(coarse.statistics.complete);
    EXPECT_GT(coarse.statistics.pagesFailed, 0U);
    EXPECT_TRUE(std::isfinite(coarse.statistics.tauAchievedPixels));
    EXPECT_GT(coarse.statistics.tauAchievedPixels, whole.statistics.tauAchievedPixels);
    EXPECT_LT(differing(coarse, whole), kWidth);  // no hole: the outline alone may differ
}

TEST_F(MeshPaging, ADamagedRootIsDrawnByItsChildren) {
    const auto sound = render(*open(path("coded.eym")), 8, 1000, Completeness::Complete);
    const auto finer = render(*open(damaged({0})), 8, 1000, Completeness::Complete);
    EXPECT_EQ(finer.statistics.pagesFailed, 1U);
    EXPECT_FALSE(finer.statistics.complete);
    EXPECT_TRUE(std::isfinite(finer.statistics.tauAchievedPixels));
    EXPECT_GT(finer.statistics.triangles, sound.statistics.triangles);
    EXPECT_LT(differing(finer, sound), kWidth);
}

TEST_F(MeshPaging, WithoutAnythingThatCanBeReadNothingIsPromised) {
    const auto file = mesh::EymFile::open(path("coded.eym"));
    std::set<std::uint32_t> all;
    for (std::uint32_t node = 0; node < file->nodes().size(); ++node)
        if (file->nodes()[node].indexCount > 0)
            all.insert(node);
    const auto result = render(*open(damaged(all)), 2.2, 1, Completeness::Complete);
    EXPECT_FALSE(result.statistics.complete);
    EXPECT_EQ(result.statistics.triangles, 0U);
    EXPECT_TRUE(std::isinf(result.statistics.tauAchievedPixels));
}

TEST_F(MeshPaging, AQuarterOfTheMemoryRaisesTauAndIsKept) {
    ChannelResult all;
    RendererOptions options;
    {
        const auto plenty = open(path("coded.eym"));
        all = render(*plenty, 2.2, 0.05, Completeness::Complete);
        options.memoryBytes = plenty->memory().deviceBytes / 4;
    }
    options.hostMemoryBytes = 4 << 20;
    const auto renderer = open(path("coded.eym"), options);
    for (const Completeness completeness : {Completeness::Complete, Completeness::Interactive}) {
        const auto result = render(*renderer, 2.2, 0.05, completeness);
        EXPECT_GT(result.statistics.tauAchievedPixels, all.statistics.tauAchievedPixels);
        EXPECT_TRUE(result.statistics.memoryRaisedTau);
        EXPECT_FALSE(all.statistics.memoryRaisedTau);
        EXPECT_TRUE(std::isfinite(result.statistics.tauAchievedPixels));
        EXPECT_EQ(result.statistics.pagesMissing, 0U);
        EXPECT_LE(renderer->memory().deviceBytes, options.memoryBytes);
        EXPECT_LE(renderer->memory().hostBytes, options.hostMemoryBytes);
        EXPECT_LT(differing(result, all), kWidth);
    }
    const auto again = render(*renderer, 2.2, 0.05, Completeness::Complete);
    EXPECT_EQ(again.statistics.pagesLoaded, 0U);  // it has come to rest
}

/// Two renderers that draw a half each.
TEST_F(MeshPaging, ARendererHoldsWhatItsRangeDraws) {
    constexpr double kTau = 0.05;
    const auto plenty = open(path("coded.eym"));
    const ChannelResult all = render(*plenty, 2.2, kTau, Completeness::Complete);
    std::vector<ChannelResult> halves;
    std::uint64_t triangles = 0;
    std::uint64_t bytes = 0;
    for (const fabric::Range& range : {fabric::Range{0, 0.5}, fabric::Range{0.5, 1}}) {
        const auto renderer = open(path("coded.eym"));
        halves.push_back(render(*renderer, 2.2, kTau, Completeness::Complete, range));
        EXPECT_TRUE(halves.back().statistics.complete);
        EXPECT_LE(halves.back().statistics.tauAchievedPixels, kTau);
        EXPECT_LT(renderer->memory().deviceBytes, plenty->memory().deviceBytes * 8 / 10);
        bytes += renderer->memory().deviceBytes;
        triangles += halves.back().statistics.triangles;
    }
    EXPECT_EQ(triangles, all.statistics.triangles);
    EXPECT_LT(bytes, plenty->memory().deviceBytes * 12 / 10);  // a node and the root twice
    EXPECT_TRUE(composed(halves[0], halves[1]) == wholeOf(all));
}

/// Objects have shares of the view's work one after the other, as they are drawn in one channel.
TEST_F(MeshPaging, OfTwoObjectsAtOnePlaceTheFirstIsSeenWhereverRangesMeet) {
    fabric::Scene scene;
    for (const fabric::Vec3& colour : {fabric::Vec3(1, 0, 0), fabric::Vec3(0, 1, 0)})
        scene.objects.push_back({.name = "ball",
                                 .kind = fabric::ObjectKind::Mesh,
                                 .path = path("coded.eym"),
                                 .colour = colour});
    const auto renderer = Renderer::create({}).value();
    ASSERT_TRUE(renderer->openScene(scene).ok());
    const ChannelResult all = render(*renderer, 2.2, 1, Completeness::Complete);
    const fabric::Image expected = wholeOf(all);
    EXPECT_TRUE(std::ranges::all_of(expected.colour, [](const fabric::Rgba& pixel) {
        return pixel.g <= pixel.r;
    })) << "the second shows";
    for (const double cut : {0.1, 0.3, 0.5, 0.51, 0.8}) {
        const ChannelResult first = render(*renderer, 2.2, 1, Completeness::Complete, {0, cut});
        const ChannelResult second = render(*renderer, 2.2, 1, Completeness::Complete, {cut, 1});
        EXPECT_TRUE(composed(first, second) == expected) << cut;
        EXPECT_NEAR(static_cast<double>(first.statistics.triangles),
                    cut * static_cast<double>(all.statistics.triangles),
                    0.25 * static_cast<double>(all.statistics.triangles));
    }
}

/// As equalizers move ranges, and the camera what lies in them.
TEST_F(MeshPaging, WhatOtherRangesDrawComesWhenOnesOwnIsThere) {
    constexpr double kTau = 0.05;
    const auto renderer = open(path("coded.eym"));
    const auto end = std::chrono::steady_clock::now() + kPatience;
    for (int quiet = 0; quiet < 10 && std::chrono::steady_clock::now() < end;) {
        const ChannelResult first =
            render(*renderer, 2.2, kTau, Completeness::Interactive, {0, 0.5});
        const bool isQuiet = first.statistics.complete && first.statistics.pagesLoaded == 0;
        quiet = isQuiet ? quiet + 1 : 0;
        if (isQuiet)  // a page may take longer than a frame
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    EXPECT_LT(std::chrono::steady_clock::now(), end);
    ChannelResult second;
    do {  // a frame brings as much to the device as it has time for
        second = render(*renderer, 2.2, kTau, Completeness::Interactive, {0.5, 1});
        EXPECT_EQ(second.statistics.pagesLoaded, 0U);
    } while (!second.statistics.complete && std::chrono::steady_clock::now() < end);
    EXPECT_TRUE(second.statistics.complete);
    EXPECT_GT(second.statistics.triangles, 0U);
}

TEST_F(MeshPaging, RangesLeaveNoHoleWhereOneOfTheirRenderersLacksPages) {
    const auto file = mesh::EymFile::open(path("coded.eym"));
    std::set<std::uint32_t> leaves;
    for (std::uint32_t node = 0; node < file->nodes().size(); ++node)
        if (file->nodes()[node].isLeaf())
            leaves.insert(node);
    const ChannelResult all = render(*open(path("coded.eym")), 2.2, 0.01, Completeness::Complete);
    for (const double cut : {0.1, 0.3, 0.5, 0.8}) {
        const auto sound = open(path("coded.eym"));
        const auto lacking = open(damaged(leaves));
        const ChannelResult first = render(*sound, 2.2, 0.01, Completeness::Complete, {0, cut});
        const ChannelResult second = render(*lacking, 2.2, 0.01, Completeness::Complete, {cut, 1});
        EXPECT_FALSE(second.statistics.complete);
        EXPECT_LT(differing(composed(first, second), wholeOf(all)), kWidth) << cut;
    }
}

/// What is blended falls to every range, and takes more than a range's share of what the view
/// needs.
TEST_F(MeshPaging, RangesOfGlassKeepWithinMemoryByMoreTau) {
    constexpr double kTau = 0.05;
    import::TriangleMesh glass = import::synthesizeMesh(150000, 4);
    glass.materials = {{.flags = mesh::kIsBlended}};
    glass.materialOf.assign(glass.positions.size(), 0);
    ASSERT_TRUE(import::importMesh(glass, path("glass.eym")).ok());
    const auto plenty = open(path("glass.eym"));
    render(*plenty, 2.2, kTau, Completeness::Complete);
    for (const std::uint64_t share : {2U, 3U, 4U, 6U}) {
        RendererOptions options;
        options.memoryBytes = plenty->memory().deviceBytes * share / 8;
        const auto renderer = open(path("glass.eym"), options);
        for (const double first : {0.0, 0.25, 0.5, 0.75}) {
            const auto drawn = [&](Completeness completeness) {
                return render(*renderer, 2.2, kTau, completeness, {first, first + 0.25}).statistics;
            };
            const auto end = std::chrono::steady_clock::now() + kPatience;
            fabric::FrameStatistics rest = drawn(Completeness::Interactive);
            while (!rest.complete && std::chrono::steady_clock::now() < end)
                rest = drawn(Completeness::Interactive);
            ASSERT_TRUE(rest.complete) << share << "/8, from " << first;
            const fabric::FrameStatistics still = drawn(Completeness::Complete);
            EXPECT_EQ(still.pagesMissing, 0U) << share << "/8, from " << first;
            EXPECT_LE(still.tauAchievedPixels, rest.tauAchievedPixels);
            EXPECT_LE(renderer->memory().deviceBytes, options.memoryBytes);
        }
    }
}

/// At one half of the ball and at the other: with less on the device than both need, and with
/// enough there but on the host less than what may be needed soon.
TEST_F(MeshPaging, TwoViewsByTurnsComeToRestAndOneThatIsGoneLeavesItsShare) {
    constexpr double kTau = 0.05;
    const fabric::Box box = mesh::EymFile::open(path("coded.eym"))->bounds();
    std::vector<fabric::Camera> cameras(2);
    for (const std::size_t i : {0U, 1U}) {
        const double radius = 0.5 * glm::length(box.size());
        cameras[i].eye = box.centre() + fabric::Vec3(2.2 * radius, 0, 0);
        cameras[i].target = box.centre() + fabric::Vec3(0, i == 0 ? radius : -radius, 0);
        cameras[i].fovYDegrees = 20;
    }
    std::uint64_t both = 0;
    {
        const auto plenty = open(path("coded.eym"));
        for (const fabric::Camera& camera : cameras)
            render(*plenty, camera, kTau, Completeness::Complete);
        both = plenty->memory().deviceBytes;
    }
    for (const double share : {1.0, 4.0}) {
        RendererOptions options;
        options.memoryBytes = static_cast<std::uint64_t>(share * static_cast<double>(both));
        options.hostMemoryBytes = 2 << 20;
        const auto renderer = open(path("coded.eym"), options);
        const auto rest = [&](std::size_t views) {
            std::vector<ChannelResult> results(views);
            const auto end = std::chrono::steady_clock::now() + kPatience;
            for (int quiet = 0; quiet < 10 && std::chrono::steady_clock::now() < end; ++quiet)
                for (std::size_t i = 0; i < views; ++i) {
                    results[i] = render(*renderer, cameras[i], kTau, Completeness::Interactive);
                    const fabric::FrameStatistics& statistics = results[i].statistics;
                    if (!statistics.complete || statistics.pagesLoaded > 0)
                        quiet = -1;
                }
            EXPECT_LT(std::chrono::steady_clock::now(), end) << "loading does not come to rest";
            return results;
        };
        const std::vector<ChannelResult> first = rest(2);
        const std::vector<ChannelResult> again = rest(2);
        EXPECT_TRUE(first[0].image == again[0].image);
        EXPECT_TRUE(first[1].image == again[1].image);
        const ChannelResult alone = rest(1).front();
        const ChannelResult complete =
            render(*open(path("coded.eym"), options), cameras[0], kTau, Completeness::Complete);
        EXPECT_TRUE(alone.image == complete.image);
        if (share == 1)
            EXPECT_LT(alone.statistics.tauAchievedPixels, first[0].statistics.tauAchievedPixels);
        else
            EXPECT_TRUE(first[0].image == complete.image);
        EXPECT_LE(renderer->memory().deviceBytes, options.memoryBytes);
        EXPECT_LE(renderer->memory().hostBytes, options.hostMemoryBytes);
    }
}

/// Looking away from the ball, beside which the camera is: all of it may be needed soon.
TEST_F(MeshPaging, WhatMayBeNeededSoonIsThereWhenTheCameraTurns) {
    constexpr double kTau = 0.01;
    const auto file = mesh::EymFile::open(path("coded.eym"));
    const auto nodes = static_cast<std::uint64_t>(
        std::ranges::count_if(file->nodes(), [](auto& node) { return node.indexCount > 0; }));
    const fabric::Box box = file->bounds();
    fabric::Camera camera;
    camera.eye = box.centre() + fabric::Vec3(glm::length(box.size()), 0, 0);
    camera.target = 2.0 * camera.eye - box.centre();
    const auto renderer = open(path("coded.eym"));
    std::uint64_t loaded = 1;  // the root
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (loaded < nodes && std::chrono::steady_clock::now() < end) {
        const ChannelResult away = render(*renderer, camera, kTau, Completeness::Interactive);
        EXPECT_EQ(away.statistics.nodes, 0U);
        EXPECT_TRUE(away.statistics.complete);
        loaded += away.statistics.pagesLoaded;
    }
    EXPECT_EQ(loaded, nodes);
    camera.target = box.centre();
    ChannelResult turned = render(*renderer, camera, kTau, Completeness::Interactive);
    while (!turned.statistics.complete && std::chrono::steady_clock::now() < end) {
        EXPECT_EQ(turned.statistics.pagesLoaded, 0U);
        turned = render(*renderer, camera, kTau, Completeness::Interactive);
    }
    EXPECT_EQ(turned.statistics.pagesLoaded, 0U);
    EXPECT_TRUE(turned.image ==
                render(*open(path("coded.eym")), camera, kTau, Completeness::Complete).image);
}

TEST_F(MeshPaging, PrefetchingKeepsWithinMemoryAndComesToRest) {
    RendererOptions options;
    options.hostMemoryBytes = 3 << 20;
    const auto renderer = open(path("coded.eym"), options);
    std::uint64_t loaded = 0;
    const auto end = std::chrono::steady_clock::now() + kPatience;
    for (int quiet = 0; quiet < 30 && std::chrono::steady_clock::now() < end;) {
        const ChannelResult now = render(*renderer, 3, 0.05, Completeness::Interactive);
        EXPECT_LE(renderer->memory().hostBytes, options.hostMemoryBytes);
        loaded += now.statistics.pagesLoaded;
        quiet = now.statistics.complete && now.statistics.pagesLoaded == 0 ? quiet + 1 : 0;
    }
    EXPECT_LT(std::chrono::steady_clock::now(), end);
    EXPECT_GT(loaded, 0U);
}

/// With twice what the ball takes, alone and before many tetrahedra behind it.
TEST_F(MeshPaging, ManySmallObjectsCostALargeOneOnlyWhatTheyHold) {
    constexpr int kSmall = 200;
    import::TriangleMesh small;
    small.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    small.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    ASSERT_TRUE(import::importMesh(small, path("small.eym")).ok());
    RendererOptions options;
    ChannelResult alone;
    {
        const auto renderer = open(path("coded.eym"));
        alone = render(*renderer, 2.2, 0.05, Completeness::Complete);
        options.memoryBytes = 2 * renderer->memory().deviceBytes;
        options.hostMemoryBytes = std::uint64_t{64} << 20;
    }
    const fabric::Box ball = mesh::EymFile::open(path("coded.eym"))->bounds();
    fabric::Scene scene;
    scene.objects.push_back(
        {.name = "ball", .kind = fabric::ObjectKind::Mesh, .path = path("coded.eym")});
    for (int i = 0; i < kSmall; ++i) {
        fabric::SceneObject object{
            .name = "small", .kind = fabric::ObjectKind::Mesh, .path = path("small.eym")};
        object.worldFromObject =
            glm::translate(fabric::Mat4(1), ball.min - fabric::Vec3(9.0 * (i + 1), 0, 0));
        scene.objects.push_back(object);
    }
    auto renderer = Renderer::create(options);
    ASSERT_TRUE(renderer.ok());
    const auto info = (*renderer)->openScene(scene);
    ASSERT_TRUE(info.ok()) << info.status();
    const ChannelResult among = render(**renderer, 2.2, 0.05, Completeness::Complete);
    EXPECT_TRUE(among.statistics.complete);
    EXPECT_LE(among.statistics.tauAchievedPixels, 0.05);
    EXPECT_LE(alone.statistics.tauAchievedPixels, 0.05);
    EXPECT_LE((*renderer)->memory().deviceBytes, options.memoryBytes);
}

TEST_F(MeshPaging, SaysThatMemoryHoldsNoNode) {
    RendererOptions options;
    options.memoryBytes = 1 << 16;
    auto renderer = Renderer::create(options);
    ASSERT_TRUE(renderer.ok());
    fabric::Scene scene;
    scene.objects.push_back(
        {.name = "ball", .kind = fabric::ObjectKind::Mesh, .path = path("coded.eym")});
    const absl::Status status = (*renderer)->openScene(scene).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted) << status;
    EXPECT_NE(status.message().find("raise --memory"), absl::string_view::npos) << status;
}

}  // namespace
}  // namespace eyrie
