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
#include <glm/gtc/matrix_transform.hpp>
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
    /// Every second is through a wall to the side, whose pixels are not square.
    lod::View randomView() {
        fabric::Camera camera;
        camera.eye = somewhere() * 1.5;
        camera.target = somewhere();
        camera.fovYDegrees = 60 + 55 * unit();
        std::optional<fabric::Sight> sight;
        if (unit() > 0) {
            const double across = 2 * unit(), up = 2 * unit();
            sight.emplace().frustum = {across - 0.7, across + 0.3, up - 0.2, up + 0.9};
        }
        return {camera, sight, 640, 360};
    }
    /// Of an object that is stretched, mirrored and, every second, sheared.
    fabric::Mat4 randomPlacing() {
        fabric::Mat4 placing =
            glm::rotate(fabric::Mat4(1), 3 * unit(), glm::normalize(somewhere()));
        placing =
            glm::scale(placing, fabric::Vec3(1 + unit() / 2, 1 + unit() / 2, -1 + unit() / 2));
        if (unit() > 0)
            placing[0][1] += unit();
        return placing;
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
    double ofBlocks(const lod::ObjectView& view, double errorMetres, double tauPixels,
                    int mayLookInto = 1000) const {
        return errorOfBlocksPixels(
            ball_.blocks(), ball_.lattice(), view, {errorMetres, tauPixels, 0},
            [this](const auto& block, const VisitTriangle& visit) {
                for (auto i = block.first; i < block.first + block.count; i += 3) {
                    const std::array<fabric::Vec3, 3> corners{ball_.corner(i), ball_.corner(i + 1),
                                                              ball_.corner(i + 2)};
                    visit(corners);
                }
            },
            mayLookInto);
    }

    const BallOfBlocks ball_;
    std::mt19937 random_{7};
};

TEST_F(BlockError, IsThatOfTheWorstBlock) {
    for (int i = 0; i < 200; ++i) {
        const lod::ObjectView view(randomView(), randomPlacing());
        const double errorMetres = randomError();
        double worst = 0;
        for (const mesh::TriangleBlock& block : ball_.blocks()) {
            const fabric::Box box = ball_.boxOf(block);
            const double pixels = view.screenSpaceErrorPixels(errorMetres, box);
            ASSERT_LE(pixels, view.looseErrorPixels(errorMetres, box)) << i;
            worst = std::max(worst, pixels + view.roundingPixels(box, box));
        }
        EXPECT_EQ(ofBlocks(view, errorMetres, worst), worst) << i;
        EXPECT_EQ(ofBlocks(view, errorMetres, 0, 0), worst) << "none may be looked into";
        const double ofAll = view.screenSpaceErrorPixels(errorMetres, bounds()) +
                             view.roundingPixels(bounds(), bounds());
        EXPECT_LE(worst, ofAll * (1 + 1e-9)) << i;
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

bool isSeen(const std::optional<fabric::Vec2>& at) {
    return at && at->x >= 0 && at->x <= 640 && at->y >= 0 && at->y <= 360;
}

/// Whichever of the two is seen.
TEST_F(BlockError, HoldsForWhateverIsSoFarFromWhatIsDrawn) {
    int seen = 0;
    int finite = 0;
    for (int i = 0; i < 200; ++i) {
        const lod::ObjectView view(randomView(), randomPlacing());
        const double errorMetres = randomError();
        const double promised = ofBlocks(view, errorMetres, i % 2 == 0 ? 0 : 1);
        finite += std::isinf(promised) ? 0 : 1;
        for (std::size_t first = 0; first < ball_.indices(); first += 9) {
            const double a = std::abs(unit()), b = std::abs(unit()) * (1 - a);
            const fabric::Vec3 drawn = (1 - a - b) * ball_.corner(first) +
                                       a * ball_.corner(first + 1) + b * ball_.corner(first + 2);
            const auto at = onPicture(view, drawn);
            const auto is = onPicture(view, drawn + errorMetres * glm::normalize(somewhere()));
            if (!isSeen(at) && !isSeen(is))
                continue;
            ++seen;
            ASSERT_LE(at && is ? glm::distance(*is, *at) : std::numeric_limits<double>::infinity(),
                      promised)
                << i << ", triangle " << first / 3;
        }
    }
    EXPECT_GT(seen, 50000);
    EXPECT_GT(finite, 150) << "but for eyes right at the surface";
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
    const auto promisedOf = [&](int mayLookInto) {
        return errorOfBlocksPixels(
            std::span(&hall, 1), lattice, view, {1e-3, 1, 0},
            [&](const auto&, const VisitTriangle& visit) {
                for (const auto& wall : walls) visit(wall);
            },
            mayLookInto);
    };
    const double promised = promisedOf(1);
    EXPECT_TRUE(std::isinf(promisedOf(0)));
    // The wall is 5 m ahead, and the floor is seen from 3.9 m ahead on, at the lower side.
    EXPECT_GT(promised, 435 * 1e-3 / 3.9);
    EXPECT_LT(promised, 435 * 1e-3 / 3.9 * 1.5);
}

}  // namespace
}  // namespace eyrie::draw
