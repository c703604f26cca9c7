// SPDX-License-Identifier: Apache-2.0
// Whatever is left out because it is hidden, the picture is that of everything: each bit of it.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "fabric/status.h"
#include "renderer/import/mesh_import.h"
#include "renderer/renderer.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/part_bounds.h"
#include "renderer/terrain/vertex_packing.h"
#include "tests/renderer/sample_scene.h"
#include "tests/support/renderer.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using fabric::ChannelResult;
using fabric::ChannelTask;
using fabric::FrameData;
using fabric::Occlusion;
using fabric::PixelViewport;
using fabric::Vec3;

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr unsigned kSeed = 20261121;

ChannelTask wholeView() {
    ChannelTask task;
    task.frameDataVersion = 1;
    task.viewWidth = kWidth;
    task.viewHeight = kHeight;
    task.pixelViewport = {0, 0, kWidth, kHeight};
    task.wantsDepth = true;
    return task;
}

ChannelResult draw(Renderer& renderer, FrameData frame, Occlusion occlusion,
                   const ChannelTask& task) {
    frame.version = 1;
    frame.occlusion = occlusion;
    auto result = renderer.render(frame, task);
    EXPECT_TRUE(result.ok()) << result.status();
    return result.ok() ? *std::move(result) : ChannelResult{};
}

/// Draws with occlusion, after the frames before, and without; returns the nodes that were hidden.
std::uint64_t hiddenIn(Renderer& renderer, const FrameData& frame, const ChannelTask& task,
                       const std::string& what) {
    const ChannelResult with = draw(renderer, frame, Occlusion::On, task);
    const ChannelResult without = draw(renderer, frame, Occlusion::Off, task);
    EXPECT_TRUE(with.image == without.image) << what;
    EXPECT_EQ(with.statistics.nodes + with.statistics.nodesHidden, without.statistics.nodes)
        << what;
    EXPECT_LE(with.statistics.triangles, without.statistics.triangles) << what;
    EXPECT_EQ(without.statistics.nodesHidden, 0U) << what;
    return with.statistics.nodesHidden;
}

class OcclusionPictures : public testing::TestWithParam<test::SampleKind> {
protected:
    void SetUp() override {
        renderer_ = test::makeRenderer();
        ASSERT_NE(renderer_, nullptr);
        auto scene = test::sampleScene(GetParam());
        ASSERT_TRUE(scene.ok()) << scene.status();
        if (GetParam() == test::SampleKind::Mesh)
            crowd(*scene);
        auto info = renderer_->openScene(*scene);
        ASSERT_TRUE(info.ok()) << info.status();
        bounds_ = info->bounds;
        // Hills that are steep enough to hide others.
        times_ = GetParam() == test::SampleKind::Mesh ? 1 : 8;
        bounds_.min.z *= times_;
        bounds_.max.z *= times_;
    }

    /// Three rows of the mesh, one behind the other.
    static void crowd(fabric::Scene& scene) {
        const fabric::SceneObject one = scene.objects[0];
        for (int i = 1; i < 9; ++i) {
            scene.objects.push_back(one);
            scene.objects.back().worldFromObject =
                glm::translate(fabric::Mat4(1.0), Vec3(1.7 * (i % 3), 1.9 * (i / 3), 0.1 * i));
        }
    }

    /// A low flight around the middle of the scene that looks along its way.
    FrameData onTheWay(double turns) const {
        const Vec3 size = bounds_.size();
        const double angle = 2 * M_PI * turns;
        FrameData frame;
        frame.camera.eye = bounds_.centre() + Vec3(0.33 * size.x * std::cos(angle),
                                                   0.33 * size.y * std::sin(angle), 0.1 * size.z);
        frame.camera.target =
            frame.camera.eye + Vec3(-size.x * std::sin(angle), size.y * std::cos(angle), 0.05);
        frame.camera.fovYDegrees = 60;
        frame.tauPixels = 0.7;
        frame.look.exaggeration = times_;
        return frame;
    }

    std::unique_ptr<Renderer> renderer_;
    fabric::Box bounds_;  ///< as drawn
    double times_ = 1;
};

TEST_P(OcclusionPictures, AreTheSameAlongAFlightWithTurnsAndHardCuts) {
    std::mt19937 random(kSeed);
    double turns = 0;
    std::uint64_t hidden = 0;
    const int frames = GetParam() == test::SampleKind::Both ? 600 : 80;
    for (int i = 0; i < frames; ++i) {
        turns += 0.004;
        if (i % 40 == 39)
            turns = std::uniform_real_distribution<double>(0, 1)(random);
        FrameData frame = onTheWay(turns);
        if (i % 30 >= 25)  // about face, and back
            frame.camera.target = frame.camera.eye * 2.0 - frame.camera.target;
        if (i % 30 >= 15 && i % 30 < 20)  // a spin on the spot, 12 degrees a frame
            frame.camera.target =
                frame.camera.eye +
                Vec3(glm::rotate(fabric::Mat4(1.0), 0.2 * (i % 30 - 14), Vec3(0, 0, 1)) *
                     fabric::Vec4(frame.camera.target - frame.camera.eye, 0));
        hidden += hiddenIn(*renderer_, frame, wholeView(), "frame " + std::to_string(i));
    }
    EXPECT_GT(hidden, static_cast<std::uint64_t>(frames))
        << "the flight should have something to hide";
}

TEST_P(OcclusionPictures, AreTheSameInEveryPartAndRangeDrawnInTurn) {
    std::uint64_t hidden = 0;
    for (int i = 0; i < 24; ++i) {
        const FrameData frame = onTheWay(0.2 + 0.003 * i);
        ChannelTask left = wholeView();
        left.pixelViewport = {0, 0, 131 + i, kHeight};
        ChannelTask right = wholeView();
        right.pixelViewport = {131 + i, 3, kWidth - 131 - i, kHeight - 7};
        ChannelTask near = wholeView();
        near.range = {0, 0.5 + 0.01 * i};
        ChannelTask far = wholeView();
        far.range = {0.5 + 0.01 * i, 1};
        for (const ChannelTask& task : {left, right, near, far})
            hidden += hiddenIn(*renderer_, frame, task, "frame " + std::to_string(i));
    }
    EXPECT_GT(hidden, 12U);
}

TEST_P(OcclusionPictures, AreTheSameForEveryLook) {
    for (const double exaggeration : {-1.0, 0.0, 1e-3, 1.0, 5.0, 100.0})
        for (int i = 0; i < 4; ++i) {
            FrameData frame = onTheWay(0.6 + 0.004 * i);
            frame.look.exaggeration = exaggeration;
            hiddenIn(*renderer_, frame, wholeView(), "times " + std::to_string(exaggeration));
        }
    FrameData frozen = onTheWay(0.3);
    frozen.look.cutCamera = onTheWay(0.8).camera;
    FrameData below = onTheWay(0.5);
    below.camera.eye.z = bounds_.min.z - 0.2 * bounds_.size().z;
    FrameData flat = onTheWay(0.1);
    flat.shading = fabric::Shading::Flat;
    for (const FrameData& frame : {frozen, below, flat})
        for (int i = 0; i < 3; ++i) hiddenIn(*renderer_, frame, wholeView(), "looked at again");
}

TEST_P(OcclusionPictures, AreOfEverythingWhereThereAreLines) {
    for (int i = 0; i < 3; ++i) {
        FrameData wire = onTheWay(0.2);
        wire.shading = fabric::Shading::Wireframe;
        EXPECT_EQ(hiddenIn(*renderer_, wire, wholeView(), "wireframe"), 0U);
        FrameData boxes = onTheWay(0.2);
        boxes.look.tileBounds = true;
        EXPECT_EQ(hiddenIn(*renderer_, boxes, wholeView(), "tile bounds"), 0U);
    }
}

TEST_P(OcclusionPictures, AreTheSameWhateverMeasurementsSay) {
    for (int i = 0; i < 80; ++i) {
        const FrameData frame = onTheWay(0.7 + 0.002 * i);
        EXPECT_TRUE(draw(*renderer_, frame, Occlusion::Auto, wholeView()).image ==
                    draw(*renderer_, frame, Occlusion::Off, wholeView()).image)
            << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, OcclusionPictures,
                         testing::Values(test::SampleKind::Mesh, test::SampleKind::Terrain,
                                         test::SampleKind::Both),
                         [](const auto& suite) { return test::name(suite.param); });

/// Upright rectangles across the x axis, each with its corners (x, y0, z0) and (x, y1, z1).
struct Rectangle {
    double x, y0, z0, y1, z1;
};

absl::StatusOr<fabric::SceneObject> rectangles(const std::vector<Rectangle>& all,
                                               const std::string& path, const Vec3& colour) {
    import::TriangleMesh mesh;
    for (const Rectangle& r : all) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Vec3& corner : {Vec3(r.x, r.y0, r.z0), Vec3(r.x, r.y1, r.z0),
                                   Vec3(r.x, r.y1, r.z1), Vec3(r.x, r.y0, r.z1)})
            mesh.positions.push_back(corner);
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    }
    fabric::SceneObject object;
    object.name = path;
    object.path = path;
    object.colour = colour;
    const auto report = import::importMesh(std::move(mesh), path);
    return report.ok() ? absl::StatusOr<fabric::SceneObject>(object) : report.status();
}

TEST(OcclusionOrder, TheFirstWinsWhereDepthsTieThoughItComesLate) {
    const test::TemporaryFolder folder;
    // A red rectangle, and a blue object that has it too and more on the right; a wall before the
    // red one. Both start at one corner and are about as large, so they share one lattice.
    const Rectangle shared{20, 0, 0, 4, 4};
    const auto red = rectangles({shared, {20, 4.1, 0, 4.3, 1}}, folder.path("red.eym"), {1, 0, 0});
    const auto blue = rectangles({shared, {20, 5, 0, 7, 4}}, folder.path("blue.eym"), {0, 0, 1});
    const auto wall = rectangles({{10, -1, -1, 3.9, 4}}, folder.path("wall.eym"), {0, 1, 0});
    ASSERT_TRUE(red.ok() && blue.ok() && wall.ok()) << red.status() << blue.status();
    const auto renderer = test::makeRenderer();
    ASSERT_NE(renderer, nullptr);
    fabric::Scene scene;
    scene.ambient = 1;
    scene.lights.push_back({});
    scene.objects = {*red, *blue, *wall};
    ASSERT_TRUE(renderer->openScene(scene).ok());

    FrameData frame;
    frame.camera.eye = {0, 1, 1};
    frame.camera.target = {1, 1, 1};
    frame.camera.fovYDegrees = 50;
    const ChannelTask task = wholeView();
    hiddenIn(*renderer, frame, task, "first");
    EXPECT_EQ(hiddenIn(*renderer, frame, task, "again"), 1U) << "the red one is behind the wall";
    frame.camera.eye.y = 8;
    frame.camera.target.y = 7.7;
    EXPECT_EQ(hiddenIn(*renderer, frame, task, "from the side"), 0U);
    const ChannelResult seen = draw(*renderer, frame, Occlusion::Off, task);
    std::array<int, 2> counts{};
    for (const fabric::Rgba& pixel : seen.image.colour) {
        counts[0] += pixel.r > pixel.b ? 1 : 0;
        counts[1] += pixel.b > pixel.r ? 1 : 0;
    }
    EXPECT_GT(counts[0], 200) << "red is seen, for it is the first";
    EXPECT_GT(counts[1], 200);
}

/// A wall with a doorway narrower than the 8 pixels that the pyramid looks at as one, boards behind
/// it, and one board in the eye's face.
absl::StatusOr<fabric::Scene> doorway(const test::TemporaryFolder& folder) {
    fabric::Scene scene;
    scene.lights.push_back({});
    const auto add = [&](const std::vector<Rectangle>& all, const Vec3& colour) {
        const std::string name = std::to_string(scene.objects.size()) + ".eym";
        ASSIGN_OR_RETURN(const fabric::SceneObject object,
                         rectangles(all, folder.path(name), colour));
        scene.objects.push_back(object);
        return absl::OkStatus();
    };
    RETURN_IF_ERROR(add({{10, -40, -6, 0, 6}}, {0, 1, 0}));
    RETURN_IF_ERROR(add({{10, 0.13, -6, 40, 6}}, {0, 1, 0}));
    for (int i = 0; i < 12; ++i)
        RETURN_IF_ERROR(
            add({{12.0 + 2 * i, -9.0 + 1.5 * i, -1, -8.6 + 1.5 * i, 1}}, {1, 0, 0.08 * i}));
    RETURN_IF_ERROR(add({{0.001, -0.0004, -0.0004, 0.0002, 0.0004}}, {0, 0, 1}));
    return scene;
}

/// Expected is the picture drawn without culling.
class HardCase20 : public testing::Test {
protected:
    void SetUp() override {
        const auto scene = doorway(folder_);
        ASSERT_TRUE(scene.ok()) << scene.status();
        ASSERT_TRUE(renderer_->openScene(*scene).ok());
    }

    test::TemporaryFolder folder_;
    std::unique_ptr<Renderer> renderer_ = test::makeRenderer();
};

TEST_F(HardCase20, ThroughADoorwayNarrowerThanABlockOfPixelsAllIsSeen) {
    std::mt19937 random(kSeed);
    const auto in = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    FrameData frame;
    frame.camera.fovYDegrees = 40;
    std::uint64_t hidden = 0;
    for (int i = 0; i < 500; ++i) {
        if (i % 50 == 0)  // a hard cut
            frame.camera.eye = {in(-3, 0), in(-4, 4), in(-0.5, 0.5)};
        frame.camera.eye.y += 0.01;
        frame.camera.target = frame.camera.eye + Vec3(1, -0.1 * frame.camera.eye.y, 0);
        if (i % 100 >= 90)  // half a turn, and back
            frame.camera.target = frame.camera.eye + Vec3(std::cos(M_PI / 5 * (i % 100 - 90)),
                                                          std::sin(M_PI / 5 * (i % 100 - 90)), 0);
        hidden += hiddenIn(*renderer_, frame, wholeView(), "frame " + std::to_string(i));
    }
    EXPECT_GT(hidden, 2000U);
}

TEST_F(HardCase20, WhatEntersAtTheFrustumsEdgeOrTouchesTheNearPlaneIsSeen) {
    FrameData frame;
    frame.camera.fovYDegrees = 90;  // the frustum's top is at z = x, its sides at y = 16 / 9 x
    const double side = 16.0 / 9;
    for (int i = -50; i < 50; ++i) {
        // The second board of the row, at x = 14, ends at y = -7.1: from outside to inside of the
        // picture's right edge, exactly on it in the middle, and a thousandth of a pixel at a time.
        const double pixel = 2 * side * 14 / kWidth;
        frame.camera.eye = {0, -7.1 + side * 14 + (i < 0 ? 0.001 : 0.05) * i * pixel, 0};
        frame.camera.target = frame.camera.eye + Vec3(1, 0, 0);
        hiddenIn(*renderer_, frame, wholeView(), "edge " + std::to_string(i));
        // The board in the eye's face, about 1 mm away: before, on and behind the near plane.
        frame.camera.eye = {1e-7 * i, 0, 0};
        frame.camera.target = {1, 0, 0};
        hiddenIn(*renderer_, frame, wholeView(), "near " + std::to_string(i));
    }
}

/// Of a vertex, in object space.
Vec3 place(const terrain::EytIndex& index, const terrain::TileId& id,
           const terrain::TileGeometry& tile, std::uint16_t number) {
    const terrain::TileVertex vertex = terrain::unpackVertex(
        tile.words, tile.wordsPerVertex, number, tile.baseHeight, tile.heightMultiplier);
    const auto post = [&](std::int32_t first, std::int32_t halves, std::int32_t posts) {
        const int posts2 = halves << terrain::Quadtree::spacingShift(id.level);
        return std::min(first * terrain::Quadtree::side(id.level) + posts2 / 2, posts - 1);
    };
    return Vec3(index.objectFromLattice *
                fabric::Vec4(post(id.x, vertex.x, index.quadtree.columns()),
                             post(id.y, vertex.y, index.quadtree.rows()), vertex.q, 1));
}

TEST(PartBounds, HoldEveryFormOfEveryTile) {
    const auto scene = test::sampleScene(test::SampleKind::Terrain);
    ASSERT_TRUE(scene.ok()) << scene.status();
    const auto file = terrain::EytFile::open(scene->objects[0].path);
    ASSERT_TRUE(file.ok()) << file.status();
    const terrain::EytIndex& index = (*file)->index();
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> share(0, 1);
    std::uint64_t looked = 0;
    std::uint64_t outside = 0;
    for (std::uint32_t i = 0; i < index.quadtree.tileCount(); i += i < 900 ? 7 : 1) {
        const terrain::TileId id = index.quadtree.tileOf(i);
        const std::vector<fabric::Box> boxes = terrain::partBounds(index, id);
        const auto page = (*file)->readPage(index.quadtree.pageIndex(id));
        ASSERT_TRUE(page.ok()) << page.status();
        const terrain::TileGeometry& tile = (*page)->tile(terrain::Quadtree::placeInPage(id));
        for (std::size_t k = 0; k + 2 < tile.indices.size(); k += 3) {
            const double u = share(random);
            const double v = share(random) * (1 - u);
            const Vec3 point = place(index, id, tile, tile.indices[k]) * u +
                               place(index, id, tile, tile.indices[k + 1]) * v +
                               place(index, id, tile, tile.indices[k + 2]) * (1 - u - v);
            const bool isInside = std::any_of(
                boxes.begin(), boxes.end(),
                [&](const fabric::Box& box) { return box.grownBy(1e-6).contains(point); });
            ++looked;
            outside += isInside ? 0 : 1;
        }
    }
    EXPECT_GT(looked, 100'000U);
    EXPECT_EQ(outside, 0U);
}

}  // namespace
}  // namespace eyrie
