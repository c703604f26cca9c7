// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "fabric/frustum.h"
#include "renderer/import/mesh_import.h"
#include "renderer/renderer.h"
#include "renderer/truth/depth_comparison.h"
#include "renderer/truth/mesh_ray_caster.h"
#include "renderer/truth/pinhole.h"
#include "tests/support/renderer.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::test {

/// What rasterisation may add to what is promised: corners are rounded to 1/256 pixel. Where a wide
/// view sees a surface edge-on, depth in single precision shows, too.
inline constexpr double kRasterPixels = 1.0 / 256;
inline constexpr double kWideRasterPixels = 1.0 / 128;

inline fabric::Vec3 randomDirection(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(fabric::Vec3(normal(random), normal(random), normal(random)));
}

/// Whole pictures, of one size and on white, of meshes that are imported as they are needed.
class MeshPictures : public testing::Test {
protected:
    explicit MeshPictures(int width = 320, int height = 180) : width_(width), height_(height) {}

    void SetUp() override {
        renderer_ = makeRenderer();
        scene_.background = {255, 255, 255, 255};
        scene_.ambient = 1;
    }

    fabric::SceneObject import(import::TriangleMesh mesh, const std::string& name,
                               const fabric::Vec3& colour = {0.8, 0.8, 0.8}) {
        const std::string path = folder_.path(name + ".eym");
        const auto report = import::importMesh(std::move(mesh), path);
        EXPECT_TRUE(report.ok()) << report.status();
        return {.name = name, .path = path, .colour = colour};
    }

    void open() {
        const auto info = renderer_->openScene(scene_);
        ASSERT_TRUE(info.ok()) << info.status();
    }

    fabric::Image blank() const {
        return fabric::makeImage({0, 0, width_, height_}, scene_.background, true);
    }

    /// Of the picture, with depth.
    fabric::ChannelTask wholeTask() const {
        fabric::ChannelTask task;
        task.viewWidth = width_;
        task.viewHeight = height_;
        task.pixelViewport = {0, 0, width_, height_};
        task.wantsDepth = true;
        return task;
    }

    fabric::ChannelResult render(const fabric::Camera& camera, const fabric::ChannelTask& task,
                                 double tauPixels = 1) {
        fabric::FrameData frame;
        frame.camera = camera;
        frame.tauPixels = tauPixels;
        auto result = renderer_->render(frame, task);
        EXPECT_TRUE(result.ok()) << result.status();
        if (!result.ok())
            return {blank(), {}};
        return *std::move(result);
    }

    fabric::ChannelResult draw(const fabric::Camera& camera, double tauPixels = 1,
                               const fabric::Range& range = {}) {
        fabric::ChannelTask task = wholeTask();
        task.range = range;
        fabric::ChannelResult result = render(camera, task, tauPixels);
        fabric::Image whole = blank();
        fabric::paste(result.image, whole);
        result.image = std::move(whole);
        return result;
    }

    /// View-space metres of the pixels of a picture.
    static std::vector<float> metres(const fabric::Image& picture) {
        std::vector<float> all;
        for (const float depth : picture.depth)
            all.push_back(static_cast<float>(fabric::viewDepthMetres(depth, fabric::kNearMetres)));
        return all;
    }

    /// What rays at the source say of a picture that promises so many pixels. Returns how many
    /// were looked at.
    std::size_t check(const truth::MeshRayCaster& source, const fabric::Camera& camera,
                      const fabric::ChannelResult& drawn, double promised, const std::string& what,
                      double rasterPixels = kRasterPixels) const {
        const auto found =
            truth::compareDepth(truth::Pinhole(camera, width_, height_), metres(drawn.image),
                                source, static_cast<int>(std::ceil(promised)) + 1);
        EXPECT_LE(found.maxPixels, promised + rasterPixels) << what;
        EXPECT_EQ(found.holes + found.falseHits + found.misplaced, 0U) << what;
        return found.compared;
    }

    const int width_;
    const int height_;
    TemporaryFolder folder_;
    std::unique_ptr<Renderer> renderer_;
    fabric::Scene scene_;
};

}  // namespace eyrie::test
