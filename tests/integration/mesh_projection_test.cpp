// SPDX-License-Identifier: Apache-2.0
// Meshes where projection is hard: all distances in one picture, the narrowest and the widest
// lenses, everything in one pixel, far from the origin.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "fabric/camera.h"
#include "fabric/depth_merge.h"
#include "renderer/import/mesh_synth.h"
#include "tests/integration/mesh_pictures.h"

namespace eyrie {
namespace {

using fabric::Image;
using fabric::Mat4;
using fabric::Vec3;
using Mesh = import::TriangleMesh;

constexpr int kWidth = 320;
constexpr int kHeight = 180;

class MeshProjection : public test::MeshPictures {
protected:
    MeshProjection() : MeshPictures(kWidth, kHeight) {}
};
using HardCase1 = MeshProjection;
using HardCase12 = MeshProjection;
using HardCase15 = MeshProjection;
using HardCase27 = MeshProjection;

/// Of the depth of a face that is square to the view, in a PFM's 32 bits: what dividing by it in
/// single precision leaves, docs/errors.md#depth.
constexpr double kDepthError = 5e-7;

/// Faces one behind the other, a millimetre to 10,000 km away: each as seen from the left edge of
/// the picture to a strip farther right than the one before it.
constexpr int kFaces = 11;
double distanceOf(int face) { return (face == 0 ? 1.001e-3 : 1e-3) * std::pow(10, face); }
int stripEnd(int face) { return kWidth * (face + 1) / kFaces; }

Mesh faceUpTo(double right) {
    Mesh mesh;
    mesh.positions = {{-4, -4, 0}, {right, -4, 0}, {right, 4, 0}, {-4, 4, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// A face's own axes are the view's, in its distance as unit.
Mat4 inView(const fabric::Camera& camera, double distance) {
    const fabric::Mat3 worldFromView = glm::transpose(fabric::viewFromWorldRotation(camera));
    Mat4 place(worldFromView * distance);
    place[3] = fabric::Vec4(camera.eye - distance * worldFromView[2], 1);
    return place;
}

/// Expected is what was put there: each strip shows its face, the nearest there is, at its
/// distance, in whichever order the faces come.
TEST_F(HardCase12, FromAMillimetreToTenThousandKilometresEachFaceIsSeenInOnePicture) {
    fabric::Camera camera;
    camera.eye = {1234.5, -678.9, 321.25};
    camera.target = camera.eye + Vec3(0.3, 1, -0.2);
    camera.fovYDegrees = 60;
    const double halfWidth = std::tan(M_PI / 6) * kWidth / kHeight;
    for (int face = 0; face < kFaces; ++face) {
        const double right = halfWidth * (2.0 * stripEnd(face) / kWidth - 1);
        scene_.objects.push_back(import(faceUpTo(face == kFaces - 1 ? 4 : right),
                                        fmt::format("face {}", face),
                                        {face / 10.0, 1 - face / 10.0, face % 2 * 1.0}));
        scene_.objects.back().worldFromObject = inView(camera, distanceOf(face));
    }
    double worst = 0;
    for (int order = 0; order < 2; ++order) {
        ASSERT_NO_FATAL_FAILURE(open());
        const Image picture = draw(camera).image;
        const std::vector<float> metres = this->metres(picture);
        std::vector<fabric::Rgba> colours;
        for (int face = 0; face < kFaces; ++face) {
            const int begin = face == 0 ? 0 : stripEnd(face - 1);
            colours.push_back(picture.colour[static_cast<std::size_t>(begin + 1)]);
            for (int y = 0; y < kHeight; ++y)
                for (int x = begin + 1; x < stripEnd(face) - 1; ++x) {
                    const auto at = static_cast<std::size_t>(y * kWidth + x);
                    worst = std::max(worst, std::abs(metres[at] / distanceOf(face) - 1));
                    ASSERT_NEAR(metres[at] / distanceOf(face), 1, kDepthError) << face;
                    ASSERT_EQ(picture.colour[at], colours.back()) << face;
                }
        }
        for (std::size_t i = 1; i < colours.size(); ++i) EXPECT_NE(colours[i], colours[i - 1]);
        std::ranges::reverse(scene_.objects);
    }
    fmt::print("depth is off by {:.2g} of the distance at most\n", worst);
}

/// Rays at the source say how far off each pixel is.
TEST_F(HardCase15, FromOneDegreeTo170ThePromiseIsKept) {
    const Mesh ball = import::synthesizeMesh(60000, 15);
    const truth::MeshRayCaster source({ball.positions, ball.triangles});
    scene_.objects = {import(ball, "ball")};
    ASSERT_NO_FATAL_FAILURE(open());
    std::mt19937 random(15);
    for (const double fov : {1.0, 10.0, 90.0, 150.0, 170.0})
        for (const double tau : {0.5, 4.0}) {
            const double up = std::tan(fov * M_PI / 360);
            fabric::Camera camera;
            camera.fovYDegrees = fov;
            camera.eye = std::max(1.6, 1.1 / up) * test::randomDirection(random);
            camera.target = 0.5 * test::randomDirection(random);
            const auto drawn = draw(camera, tau);
            const double promised = drawn.statistics.tauAchievedPixels;
            EXPECT_LE(promised, tau) << fov;
            EXPECT_GT(check(source, camera, drawn, promised, fmt::format("{}, tau {}", fov, tau)),
                      100U)
                << fov;
        }
}

/// All of a mesh in one pixel, parts of the data that have no triangles, and parts that are beside
/// the picture. Expected is the picture of one channel.
TEST_F(HardCase27, AllTrianglesInOnePixelComeTogetherFromAnyRanges) {
    const Mesh ball = import::synthesizeMesh(20000, 27);
    for (int i = 0; i < 3; ++i) {
        scene_.objects.push_back(import(ball, fmt::format("ball {}", i), {0.2 + 0.3 * i, 0.5, 0}));
        scene_.objects.back().worldFromObject =
            glm::translate(Mat4(1.0), Vec3(0, i == 2 ? -1e9 : 0, 0));
    }
    ASSERT_NO_FATAL_FAILURE(open());
    fabric::Camera camera;
    camera.eye = {1e4, 0, 0};
    camera.target = {0, 0.1, 0.1};
    camera.fovYDegrees = 40;
    const Image whole = draw(camera).image;
    EXPECT_EQ(std::ranges::count_if(whole.depth, [](float depth) { return depth > 0; }), 1);
    for (const int ranges : {2, 3, 7, 40}) {
        Image composed = blank();
        for (const fabric::Range& range : fabric::split(fabric::Range{}, fabric::equalCuts(ranges)))
            fabric::mergeDepth(draw(camera, 1, range).image, composed);
        EXPECT_TRUE(composed == whole) << ranges;
    }
}

/// Moved by multiples of the lattice's step and more than that: expected is the picture at the
/// origin, to the bit where the sums of doubles are exact.
TEST_F(HardCase1, AMeshFarFromTheOriginLooksAsItDoesThere) {
    scene_.objects = {import(import::synthesizeMesh(20000, 1), "ball")};
    std::vector<fabric::Camera> cameras(4);
    std::mt19937 random(1);
    for (fabric::Camera& camera : cameras) {
        camera.eye = glm::round(1024.0 * 3.0 * test::randomDirection(random)) / 1024.0;
        camera.target = {0, 0, 0};
    }
    std::vector<Image> near;
    ASSERT_NO_FATAL_FAILURE(open());
    for (const fabric::Camera& camera : cameras) near.push_back(draw(camera).image);
    for (const Vec3& offset : {Vec3(5e5, 4.5e6, 300), Vec3(6.378e6, -6.378e6, 0),
                               Vec3(std::exp2(31), -std::exp2(31), std::exp2(31))}) {
        scene_.objects[0].worldFromObject = glm::translate(Mat4(1.0), offset);
        ASSERT_NO_FATAL_FAILURE(open());
        for (std::size_t i = 0; i < cameras.size(); ++i) {
            fabric::Camera camera = cameras[i];
            camera.eye += offset;
            camera.target += offset;
            EXPECT_TRUE(draw(camera).image == near[i]) << offset.x << ", " << i;
        }
    }
}

}  // namespace
}  // namespace eyrie
