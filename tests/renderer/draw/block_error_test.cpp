// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/block_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <span>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/renderer/draw/ball_of_blocks.h"

namespace eyrie::draw {
namespace {

/// A ball, seen from somewhere in it or about it, drawn with some error.
class BlockError : public testing::Test {
protected:
    double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
    fabric::Vec3 somewhere() { return {unit(), unit(), unit()}; }
    double randomError() { return std::pow(10, -4 + 2 * unit()); }
    lod::View randomView() {
        fabric::Camera camera;
        camera.eye = somewhere() * 1.5;
        camera.target = somewhere();
        camera.fovYDegrees = 60 + 55 * unit();
        return {camera, 640, 360};
    }
    fabric::Box bounds() const {
        fabric::Box all;
        for (const mesh::TriangleBlock& block : ball_.blocks()) {
            all.grow(ball_.boxOf(block).min);
            all.grow(ball_.boxOf(block).max);
        }
        return all;
    }
    /// Where boxes are looked into that do not keep `tauPixels`.
    double ofBlocks(const lod::ObjectView& view, double errorMetres, double tauPixels) const {
        return errorOfBlocksPixels(
            ball_.blocks(), ball_.lattice(), view, {errorMetres, tauPixels},
            [this](const auto& block, const VisitTriangle& visit) {
                for (auto i = block.first; i < block.first + block.count; i += 3) {
                    const std::array<fabric::Vec3, 3> corners{ball_.corner(i), ball_.corner(i + 1),
                                                              ball_.corner(i + 2)};
                    visit(corners);
                }
            });
    }

    const BallOfBlocks ball_;
    std::mt19937 random_{7};
};

TEST_F(BlockError, IsThatOfTheWorstBlock) {
    for (int i = 0; i < 200; ++i) {
        const lod::ObjectView view(randomView(), fabric::Mat4(fabric::Mat3(1 + unit() / 2)));
        const double errorMetres = randomError();
        double worst = 0;
        for (const mesh::TriangleBlock& block : ball_.blocks()) {
            const fabric::Box box = ball_.boxOf(block);
            worst = std::max(worst, view.screenSpaceErrorPixels(errorMetres, box) +
                                        view.roundingPixels(box, box));
        }
        EXPECT_EQ(ofBlocks(view, errorMetres, worst), worst) << i;
        EXPECT_LE(worst, view.screenSpaceErrorPixels(errorMetres, bounds()) +
                             view.roundingPixels(bounds(), bounds()))
            << i;
    }
}

/// In pixels; nothing where it is not before the eye.
std::optional<fabric::Vec2> onPicture(const lod::ObjectView& view, const fabric::Vec3& point) {
    const fabric::Vec3 p(view.viewFromObject() * fabric::Vec4(point, 1));
    if (!(p.z < 0))
        return std::nullopt;
    const lod::View& v = view.view();
    return fabric::Vec2((p.x / -p.z - v.frustum.left) * v.focalPixels.x,
                        (p.y / -p.z - v.frustum.bottom) * v.focalPixels.y);
}

TEST_F(BlockError, HoldsForWhateverIsSoFarFromWhatIsSeen) {
    int seen = 0;
    int finite = 0;
    for (int i = 0; i < 200; ++i) {
        const lod::ObjectView view(randomView(), fabric::Mat4(1));
        const double errorMetres = randomError();
        const double promised = ofBlocks(view, errorMetres, i % 2 == 0 ? 0 : 1);
        finite += std::isinf(promised) ? 0 : 1;
        for (std::size_t corner = 0; corner < ball_.indices(); corner += 7) {
            const fabric::Vec3 drawn = ball_.corner(corner);
            const fabric::Vec3 source = drawn + errorMetres * glm::normalize(somewhere());
            const auto at = onPicture(view, drawn);
            const bool isSeen = at && at->x >= 0 && at->x <= 640 && at->y >= 0 && at->y <= 360;
            if (!isSeen)
                continue;
            const auto is = onPicture(view, source);
            ++seen;
            ASSERT_LE(is ? glm::distance(*is, *at) : std::numeric_limits<double>::infinity(),
                      promised)
                << i << ", corner " << corner;
        }
    }
    EXPECT_GT(seen, 100000);
    EXPECT_GT(finite, 190) << "but for eyes right at the surface";
}

TEST_F(BlockError, IsFiniteForAnEyeAmidWhatItSees) {
    fabric::Camera camera;
    camera.eye = {0, 0, 0};
    camera.target = {1, 0, 0};
    const lod::ObjectView view({camera, 640, 360}, fabric::Mat4(1));
    EXPECT_TRUE(std::isinf(view.screenSpaceErrorPixels(1e-4, bounds())));
    const double promised = ofBlocks(view, 1e-4, 1);
    // 435 pixels a unit of tangent, up to 1.31 off the axis; the ball's inside is 0.2 to 1 away.
    EXPECT_GT(promised, 0.04);
    EXPECT_LT(promised, 0.29);
    EXPECT_LE(ofBlocks(view, 1e-4, 0), 1.01 * promised) << "by triangles";
}

/// As in a hall, whose walls are wider than it is far to them.
TEST_F(BlockError, IsFiniteForAnEyeInTheBoxOfLargeTriangles) {
    const mesh::Lattice lattice{{-10, -10, -10}, 20.0 / (1 << 20)};
    const auto at = [&](double x, double y, double z) {
        return glm::uvec3((fabric::Vec3(x, y, z) - lattice.originMetres) / lattice.stepMetres + .5);
    };
    mesh::TriangleBlock hall{0, 6, {}};
    hall.bounds.grow(at(-8, -8, -1.6));
    hall.bounds.grow(at(8, 8, 3));
    const std::array<std::array<fabric::Vec3, 3>, 2> walls{
        {{{{-8, -8, -1.6}, {8, -8, -1.6}, {0, 8, -1.6}}},
         {{{-8, 5, -1.6}, {8, 5, -1.6}, {0, 5, 3}}}}};
    fabric::Camera camera;
    camera.eye = {0, 0, 0};
    camera.target = {0, 1, 0};
    const lod::ObjectView view({camera, 640, 360}, fabric::Mat4(1));
    const double promised = errorOfBlocksPixels(std::span(&hall, 1), lattice, view, {1e-3, 1},
                                                [&](const auto&, const VisitTriangle& visit) {
                                                    for (const auto& wall : walls) visit(wall);
                                                });
    // The wall is 5 m ahead, and the floor is seen from 3.9 m ahead on, at the lower side.
    EXPECT_GT(promised, 435 * 1e-3 / 3.9);
    EXPECT_LT(promised, 435 * 1e-3 / 3.9 * 1.5);
}

}  // namespace
}  // namespace eyrie::draw
