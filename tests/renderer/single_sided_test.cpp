// SPDX-License-Identifier: Apache-2.0
// A closed surface looks the same without the triangles that face away.
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "renderer/renderer.h"
#include "tests/renderer/sample_scene.h"
#include "tests/support/renderer.h"

namespace eyrie {
namespace {

/// On the silhouette the edge-on triangles of both sides meet, and their planes differ in depth by
/// rounding: which of them is nearer may change in a handful of pixels, by next to nothing.
void expectSameSurface(const fabric::Image& a, const fabric::Image& b) {
    ASSERT_EQ(a.area, b.area);
    int differing = 0;
    for (std::size_t i = 0; i < a.depth.size(); ++i) {
        EXPECT_NEAR(a.depth[i], b.depth[i], 1e-4F * b.depth[i]) << "pixel " << i;
        differing += a.depth[i] != b.depth[i] || a.colour[i] != b.colour[i] ? 1 : 0;
    }
    EXPECT_LE(differing, 10);
}

class SingleSided : public testing::Test {
protected:
    void SetUp() override {
        renderer_ = test::makeRenderer();
        auto scene = test::sampleScene(test::SampleKind::Mesh);
        ASSERT_TRUE(scene.ok()) << scene.status();
        scene_ = *scene;
    }

    /// The closed bumpy ball of the sample scene, about one metre in radius around the origin.
    fabric::Image draw(bool singleSided, const fabric::Mat4& transform, const fabric::Vec3& eye) {
        scene_.objects[0].singleSided = singleSided;
        scene_.objects[0].worldFromObject = transform;
        EXPECT_TRUE(renderer_->openScene(scene_).ok());
        fabric::FrameData frame;
        frame.camera.eye = eye;
        frame.camera.target = glm::length(eye) > 0.5 ? fabric::Vec3(0) : eye + fabric::Vec3(1);
        fabric::ChannelTask task;
        task.viewWidth = 320;
        task.viewHeight = 240;
        task.pixelViewport = {0, 0, 320, 240};
        task.wantsDepth = true;
        auto result = renderer_->render(frame, task);
        EXPECT_TRUE(result.ok()) << result.status();
        EXPECT_FALSE(result->image.area.isEmpty());
        return result->image;
    }

    std::unique_ptr<Renderer> renderer_;
    fabric::Scene scene_;
};

TEST_F(SingleSided, LeavesTheClosedSurfaceAsItLooksFromOutside) {
    for (int i = 0; i < 12; ++i) {
        const double turn = i * 0.6;
        const fabric::Vec3 eye(3 * std::cos(turn), 3 * std::sin(turn), std::cos(2 * turn));
        SCOPED_TRACE(i);
        expectSameSurface(draw(true, fabric::Mat4(1.0), eye), draw(false, fabric::Mat4(1.0), eye));
    }
}

TEST_F(SingleSided, KnowsThatAMirrorTurnsTrianglesOver) {
    const fabric::Mat4 mirror = glm::scale(fabric::Mat4(1.0), fabric::Vec3(1, -1, 1));
    const fabric::Vec3 eye(2, 2, 1);
    expectSameSurface(draw(true, mirror, eye), draw(false, mirror, eye));
}

TEST_F(SingleSided, ShowsTheSurfaceFromInsideToo) {
    const fabric::Vec3 eye(0.1, 0, 0);
    EXPECT_EQ(draw(true, fabric::Mat4(1.0), eye), draw(false, fabric::Mat4(1.0), eye));
}

}  // namespace
}  // namespace eyrie
