// SPDX-License-Identifier: Apache-2.0
// A fence seen along its plane: the planes of its triangles pass through the eye, and may have any
// depth at the pixels that rasterisation gives them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "fabric/frustum.h"
#include "renderer/import/mesh_import.h"
#include "renderer/renderer.h"
#include "tests/support/renderer.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using fabric::Vec3;
using import::TriangleMesh;

constexpr int kPanels = 40;

/// Panels of 1 x 3 m, one after the other along y, none of them off x = 0.
TriangleMesh fence() {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < kPanels; ++i) {
        for (const double y : {i + 0.0, i + 1.0})
            for (const double z : {0.0, 3.0}) mesh.positions.emplace_back(0, y, z);
        const std::uint32_t first = 4 * i;
        mesh.triangles.push_back({first, first + 2, first + 3});
        mesh.triangles.push_back({first, first + 3, first + 1});
    }
    return mesh;
}

/// The nearest of the fence, in metres along the view's axis.
double nearestMetres(const fabric::Camera& camera) {
    const Vec3 ahead = glm::normalize(camera.target - camera.eye);
    double nearest = std::numeric_limits<double>::infinity();
    for (const double y : {0.0, 1.0 * kPanels})
        for (const double z : {0.0, 3.0})
            nearest = std::min(nearest, glm::dot(Vec3(0, y, z) - camera.eye, ahead));
    return nearest;
}

TEST(EdgeOn, NothingIsDrawnNearerThanItLies) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(import::importMesh(fence(), folder.path("fence.eym")).ok());
    const auto renderer = test::makeRenderer();
    fabric::Scene scene;
    scene.objects.emplace_back().path = folder.path("fence.eym");
    scene.objects.back().name = "fence";
    ASSERT_TRUE(renderer->openScene(scene).ok());

    fabric::ChannelTask task;
    task.viewWidth = 640;
    task.viewHeight = 480;
    task.pixelViewport = {0, 0, 640, 480};
    task.wantsDepth = true;
    std::mt19937 random(2);
    const auto uniform = [&random](double from, double to) {
        return std::uniform_real_distribution(from, to)(random);
    };
    std::size_t covered = 0;
    for (int picture = 0; picture < 150; ++picture) {
        fabric::FrameData frame;
        frame.camera.eye = {0, uniform(-40, -10), uniform(4, 12)};
        frame.camera.target = {uniform(-2, 2), uniform(0, 20), 1.5};
        frame.camera.up = {uniform(-1, 1), uniform(-1, 1), 1};
        frame.camera.fovYDegrees = 50;
        const auto result = renderer->render(frame, task);
        ASSERT_TRUE(result.ok()) << result.status();
        const double nearest = nearestMetres(frame.camera) / (1 + 1.0 / 256);
        for (const float depth : result->image.depth) {
            covered += depth > 0 ? 1 : 0;
            ASSERT_LE(depth, fabric::kNearMetres / nearest) << "picture " << picture;
        }
    }
    EXPECT_GT(covered, 0U);
}

}  // namespace
}  // namespace eyrie
