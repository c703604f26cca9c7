// SPDX-License-Identifier: Apache-2.0
// Meshes where projection is hard: all distances in one picture, the narrowest and the widest
// lenses, everything in one pixel, far from the origin.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
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

using HardCase1 = test::MeshPictures;
using HardCase12 = test::MeshPictures;
using HardCase15 = test::MeshPictures;
using HardCase27 = test::MeshPictures;

/// Of the distance of a face that is square to the view: four roundings to 24 bits, of what is
/// divided by, the quotient, the metres and their number in a PFM. docs/errors.md#depth.
constexpr double kDepthError = 4 * 0x1p-24;

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

/// Red, green or blue.
int brightest(const fabric::Rgba& colour) {
    const std::array<int, 3> channels = {colour.r, colour.g, colour.b};
    return static_cast<int>(std::ranges::max_element(channels) - channels.begin());
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
        scene_.objects.push_back(import(
            faceUpTo(face == kFaces - 1 ? 4 : right), fmt::format("face {}", face),
            {face % 3 == 0 ? 1.0 : 0.0, face % 3 == 1 ? 1.0 : 0.0, face % 3 == 2 ? 1.0 : 0.0}));
        scene_.objects.back().worldFromObject = inView(camera, distanceOf(face));
    }
    double worst = 0;
    for (int order = 0; order < 2; ++order) {
        ASSERT_NO_FATAL_FAILURE(open());
        const Image picture = draw(camera).image;
        const std::vector<float> metres = this->metres(picture);
        for (int face = 0; face < kFaces; ++face) {
            const int begin = face == 0 ? 0 : stripEnd(face - 1);
            for (int y = 0; y < kHeight; ++y)
                for (int x = begin + 1; x < stripEnd(face) - 1; ++x) {
                    const auto at = static_cast<std::size_t>(y * kWidth + x);
                    worst = std::max(worst, std::abs(metres[at] / distanceOf(face) - 1));
                    ASSERT_NEAR(metres[at] / distanceOf(face), 1, kDepthError) << face;
                    ASSERT_EQ(brightest(picture.colour[at]), face % 3) << face;
                }
        }
        std::ranges::reverse(scene_.objects);
    }
    fmt::print("depth is off by {:.2g} of the distance at most\n", worst);
}

/// Rays at the source say how far off each pixel is.
TEST_F(HardCase15, FromOneDegreeTo170ThePromiseIsKept) {
    const Mesh ball = import::synthesizeMesh(60000, 15);
    double radius = 0;
    for (const Vec3& position : ball.positions) radius = std::max(radius, glm::length(position));
    const truth::MeshRayCaster source({ball.positions, ball.triangles});
    scene_.objects = {import(ball, "ball")};
    ASSERT_NO_FATAL_FAILURE(open());
    std::mt19937 random(15);
    for (const auto& [fov, tau] : {std::pair{1.0, 0.5},
                                   {10.0, 4.0},
                                   {90.0, 0.5},
                                   {150.0, 4.0},
                                   {170.0, 0.5},
                                   {170.0, 4.0}}) {
        fabric::Camera camera;
        camera.fovYDegrees = fov;
        // Outside of all boxes, and half-way from the picture's middle to its side.
        const Vec3 side = test::randomDirection(random);
        const Vec3 across = glm::normalize(glm::cross(side, test::randomDirection(random)));
        camera.eye = radius * std::max(1.8, 1 / std::tan(fov * M_PI / 360)) * side;
        camera.target = camera.eye - side + std::tan(fov * M_PI / 720) * across;
        const auto drawn = draw(camera, tau);
        const double promised = drawn.statistics.tauAchievedPixels;
        const std::string what = fmt::format("{} degrees, tau {}", fov, tau);
        EXPECT_LE(promised, tau) << what;
        EXPECT_GT(check(source, camera, drawn, promised, what, test::kWideRasterPixels), 100U)
            << what;
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
    camera.eye = {1e4, 0, 0};  // a pixel is 40 m wide there, and the ball on a pixel's centre
    camera.fovYDegrees = 40;
    const double halfPixel = 1e4 * std::tan(M_PI / 9) / kHeight;
    camera.target = {0, halfPixel, halfPixel};
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
