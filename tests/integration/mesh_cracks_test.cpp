// SPDX-License-Identifier: Apache-2.0
// Nodes of a mesh meet without cracks, whatever levels lie side by side, in one channel and in
// ranges put together: ten thousand views straight onto seams, where nothing but the front of a
// closed surface may be seen.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "fabric/depth_merge.h"
#include "fabric/frustum.h"
#include "renderer/import/mesh_synth.h"
#include "tests/integration/forced_cut.h"
#include "tests/integration/mesh_pictures.h"

namespace eyrie {
namespace {

using fabric::Image;
using fabric::Vec3;
using Mesh = import::TriangleMesh;

constexpr int kSide = 64;
constexpr int kModels = 2;
constexpr int kCuts = 20;  ///< of each model
constexpr int kViewsOfCut = 10000 / kModels / kCuts;
constexpr std::uint32_t kNodeTriangles = 400;
/// Of the radius of the sphere in a model: what coarse triangles may cut off.
constexpr double kInside = 0.85;

/// A closed cube of `n` x `n` squares a side: flat faces are simplified to a few large triangles,
/// which meet the many small ones of the faces' finest level.
Mesh cube(std::uint32_t n) {
    Mesh mesh;
    for (int face = 0; face < 6; ++face) {
        const double sign = face % 2 == 0 ? 1 : -1;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (std::uint32_t j = 0; j <= n; ++j)
            for (std::uint32_t i = 0; i <= n; ++i) {
                Vec3 p(0.0);
                p[face / 2] = sign;
                p[(face / 2 + 1) % 3] = sign * (2.0 * i / n - 1);
                p[(face / 2 + 2) % 3] = 2.0 * j / n - 1;
                mesh.positions.push_back(p);
            }
        for (std::uint32_t j = 0; j < n; ++j)
            for (std::uint32_t i = 0; i < n; ++i) {
                const std::uint32_t a = first + j * (n + 1) + i, b = a + 1, c = a + n + 1;
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({b, c + 1, c});
            }
    }
    return mesh;
}

/// Whether every ray of a picture passes so near to the origin that it has to hit the model's
/// front before.
bool isFilled(const truth::Pinhole& pinhole, double radius) {
    for (const double x : {0.0, 1.0 * kSide})
        for (const double y : {0.0, 1.0 * kSide}) {
            const truth::Ray ray = pinhole.rayThrough(x, y);
            const Vec3 direction = glm::normalize(ray.direction);
            if (glm::length(glm::cross(ray.origin, direction)) > radius ||
                glm::dot(ray.origin, direction) > 0)
                return false;
        }
    return true;
}

class HardCase14 : public test::MeshPictures {
protected:
    HardCase14() : MeshPictures(kSide, kSide) {}

    void SetUp() override {
        MeshPictures::SetUp();
        scene_.ambient = fabric::Scene().ambient;  // lit, so that colours tell triangles apart
    }

    /// Pixels that show no front, over views of random cuts of `mesh`, which is star-shaped around
    /// the origin.
    void look(Mesh mesh, std::uint64_t seed) {
        inner_ = outer_ = glm::length(mesh.positions[0]);
        for (const Vec3& position : mesh.positions) {
            inner_ = std::min(inner_, std::min(glm::length(position), 1.0));
            outer_ = std::max(outer_, glm::length(position));
        }
        const test::ForcedCuts cuts(std::move(mesh), kNodeTriangles);
        std::mt19937 random(seed);
        for (int i = 0; i < kCuts; ++i) {
            const std::string path = folder_.path("cut.eym");
            const std::vector<Vec3> seams = cuts.write(path, random);
            ASSERT_GT(seams.size(), 100U);
            scene_.objects = {{.name = "mesh", .path = path}};
            ASSERT_NO_FATAL_FAILURE(open());
            for (int view = 0; view < kViewsOfCut; ++view) lookOnce(seams, random);
        }
        EXPECT_EQ(open_, 0U);
        EXPECT_EQ(differing_, 0U);
        EXPECT_GT(mixed_, views_ / 2);
        fmt::print("{} see-through pixels in {} views, {} of several nodes; {} of ranges differ\n",
                   open_, views_, mixed_, differing_);
    }

private:
    fabric::Camera onSeam(const std::vector<Vec3>& seams, std::mt19937& random) const;
    void lookOnce(const std::vector<Vec3>& seams, std::mt19937& random);
    std::size_t openIn(const Image& picture, const fabric::Camera& camera) const;

    double inner_ = 0, outer_ = 0;  ///< radii between which the surface lies
    std::size_t views_ = 0, mixed_ = 0, open_ = 0, differing_ = 0;
};

/// From any side that sees the point, from a thousandth of the model's size to ten times it away,
/// through lenses down to a degree.
fabric::Camera HardCase14::onSeam(const std::vector<Vec3>& seams, std::mt19937& random) const {
    const auto in = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (;;) {
        fabric::Camera camera;
        camera.target = seams[random() % seams.size()];
        const Vec3 side =
            glm::normalize(glm::normalize(camera.target) + 0.9 * test::randomDirection(random));
        camera.eye = camera.target + outer_ * std::exp2(in(-10, 3.3)) * side;
        camera.up = test::randomDirection(random);
        camera.fovYDegrees = std::exp2(in(0, 6.3));
        if (glm::length(camera.eye) > 1.001 * outer_ && fabric::validate(camera).ok() &&
            isFilled(truth::Pinhole(camera, kSide, kSide), kInside * inner_))
            return camera;
    }
}

/// Pixels that show the background, or what lies behind the model's middle.
std::size_t HardCase14::openIn(const Image& picture, const fabric::Camera& camera) const {
    const truth::Pinhole pinhole(camera, kSide, kSide);
    std::size_t open = 0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const truth::Ray ray = pinhole.rayThrough(x + 0.5, y + 0.5);
            const double middle =
                -glm::dot(ray.origin, ray.direction) / glm::dot(ray.direction, ray.direction);
            const float depth = picture.depth[static_cast<std::size_t>(y * kSide + x)];
            open += depth == 0 || fabric::viewDepthMetres(depth, fabric::kNearMetres) > middle;
        }
    return open;
}

void HardCase14::lookOnce(const std::vector<Vec3>& seams, std::mt19937& random) {
    const fabric::Camera camera = onSeam(seams, random);
    const auto drawn = draw(camera);
    const Image& picture = drawn.image;
    ++views_;
    mixed_ += drawn.statistics.nodes > 1 ? 1 : 0;
    open_ += openIn(picture, camera);
    if (views_ % 4 != 0)
        return;
    Image composed = blank();
    std::vector<double> at = {0.001 * static_cast<double>(random() % 1000),
                              0.001 * static_cast<double>(random() % 1000)};
    std::ranges::sort(at);
    for (const fabric::Range& range : {fabric::Range{0, at[0]}, {at[0], at[1]}, {at[1], 1}})
        fabric::mergeDepth(draw(camera, 1, range).image, composed);
    differing_ += composed == picture ? 0 : 1;
}

TEST_F(HardCase14, NothingIsSeenThroughABumpyBall) { look(import::synthesizeMesh(40000, 3), 14); }

TEST_F(HardCase14, NothingIsSeenThroughACube) { look(cube(60), 15); }

}  // namespace
}  // namespace eyrie
