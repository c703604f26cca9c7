// SPDX-License-Identifier: Apache-2.0
#include "renderer/occlusion/hidden_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "fabric/frustum.h"
#include "renderer/lod/vertical_error.h"
#include "renderer/truth/pinhole.h"
#include "renderer/truth/terrain_ray_caster.h"
#include "tests/renderer/lod/wall.h"

namespace eyrie::occlusion {
namespace {

using fabric::Box;
using fabric::Mat4;
using fabric::PixelViewport;
using fabric::Vec2;
using fabric::Vec3;
using test::Dice;
using truth::HeightGrid;
using truth::TerrainRayCaster;

constexpr int kPosts = 49;
constexpr double kSpacing = 10;
constexpr int kWidth = 96;
constexpr int kHeight = 64;

/// A few waves, of which one is cut to cliffs.
HeightGrid hills(Dice& dice) {
    HeightGrid grid{.columns = kPosts,
                    .rows = kPosts,
                    .heights = std::vector<float>(kPosts * kPosts),
                    .origin = {0, 0},
                    .perColumn = {kSpacing, 0},
                    .perRow = {0, kSpacing}};
    for (int wave = 0; wave < 4; ++wave) {
        const double length = dice.in(4, 25);
        const double turn = dice.in(0, 6.3);
        const double phase = dice.in(0, 6.3);
        const double size = dice.in(0, 2) * length;
        const double steepness = wave == 0 ? dice.in(1, 20) : 1;
        for (int j = 0; j < kPosts; ++j)
            for (int i = 0; i < kPosts; ++i) {
                const double along = (i * std::cos(turn) + j * std::sin(turn)) / length;
                grid.heights[static_cast<std::size_t>(j * kPosts + i)] += static_cast<float>(
                    size * std::tanh(steepness * std::sin(6.28 * along + phase)));
            }
    }
    return grid;
}

/// A source, what is drawn of it, and a camera above both. Object space; triangles split each cell
/// along its main diagonal. What is drawn is off by as much as one sees, near and far: up in some
/// rings around the eye and down in others, or up and down from post to post.
struct Scene {
    HeightGrid source;
    HeightGrid drawn;
    std::vector<double> errors;  ///< of posts, at most
    fabric::Camera camera;

    explicit Scene(Dice& dice) : source(hills(dice)), drawn(source) {
        const Vec2 at{dice.in(0.1, 0.9) * kSpacing * (kPosts - 1),
                      dice.in(0.1, 0.9) * kSpacing * (kPosts - 1)};
        const double share = dice.in(0, 0.06);
        const double ring = dice.in(10, 150);
        const bool isNoise = dice.in(0, 1) < 0.3;
        for (int j = 0; j < kPosts; ++j)
            for (int i = 0; i < kPosts; ++i) {
                const double distance = glm::distance(at, kSpacing * Vec2(i, j));
                errors.push_back(share * distance);
                drawn.heights[errors.size() - 1] +=
                    static_cast<float>(0.999 * errors.back() *
                                       (isNoise                         ? dice.in(-1, 1)
                                        : std::sin(distance / ring) < 0 ? -1
                                                                        : 1));
            }
        camera.eye = Vec3(at, std::max(heightAt(source, at), heightAt(drawn, at)) + 15 * share +
                                  dice.in(0.5, 40));
        const double azimuth = dice.in(0, 6.3);
        camera.target = camera.eye + Vec3(std::cos(azimuth), std::sin(azimuth), dice.in(-0.8, 0.5));
        camera.up = Vec3(dice.in(-0.3, 0.3), dice.in(-0.3, 0.3), 1);
        camera.fovYDegrees = dice.in(20, 90);
    }

    double errorAt(const Vec3& post) const {
        return errors[static_cast<std::size_t>(std::lround(post.y / kSpacing) * kPosts +
                                               std::lround(post.x / kSpacing))];
    }

    static double heightAt(const HeightGrid& grid, const Vec2& at) {
        return TerrainRayCaster(grid).heightsAt(at.x, at.y)[0];
    }
};

/// View depth of the first hit.
double hit(const TerrainRayCaster& ground, const truth::Ray& ray) {
    return ground.firstHits(ray)[static_cast<std::size_t>(truth::CellSurface::MainDiagonal)];
}

std::vector<Vec3> trianglesOf(const HeightGrid& grid) {
    std::vector<Vec3> corners;
    const auto post = [&](int i, int j) {
        return Vec3(i * kSpacing, j * kSpacing,
                    grid.heights[static_cast<std::size_t>(j * kPosts + i)]);
    };
    for (int j = 0; j + 1 < kPosts; ++j)
        for (int i = 0; i + 1 < kPosts; ++i)
            for (const Vec3& corner : {post(i, j), post(i + 1, j), post(i + 1, j + 1), post(i, j),
                                       post(i + 1, j + 1), post(i, j + 1)})
                corners.push_back(corner);
    return corners;
}

/// What a picture is seen through: straight ahead, or a wall of which a raster is drawn.
struct Optics {
    Optics(const fabric::Camera& camera, Dice& dice) : pinhole(camera, kWidth, kHeight) {
        task.viewWidth = kWidth;
        task.viewHeight = kHeight;
        if (dice.in(0, 1) < 0.5)
            return;
        const test::Wall wall = test::randomWall(dice);
        const test::Wall inWorld = test::inWorld(camera, wall);
        const Vec2 step{dice.in(0.5, 2), dice.in(0.5, 2)};
        const Vec2 origin{dice.in(-0.25, 0), dice.in(-0.25, 0)};
        task.viewWidth = static_cast<int>(std::ceil(kWidth * step.x));
        task.viewHeight = static_cast<int>(std::ceil(kHeight * step.y));
        task.sight = test::sightThrough(wall, Vec3(0));
        task.raster = fabric::Raster{kWidth, kHeight, origin, step};
        pinhole =
            truth::Pinhole(camera.eye, {inWorld.lowerLeft, inWorld.lowerRight, inWorld.upperLeft},
                           task.viewWidth, task.viewHeight)
                .sampled(origin, step, kWidth, kHeight);
    }

    fabric::ChannelTask task;
    truth::Pinhole pinhole;
};

/// A picture of a scene, and what is asked of it, where the object is turned and scaled at random.
class Picture {
public:
    Picture(const Scene& scene, Dice& dice) : Picture(scene, Optics(scene.camera, dice), dice) {}

    Picture(const Scene& scene, const Optics& optics, Dice& dice)
        : source_(scene.source),
          drawn_(scene.drawn),
          pinhole_(optics.pinhole),
          metresPerUnit_(std::exp(dice.in(-2, 2))),
          worldFromObject_(glm::rotate(
              glm::scale(glm::translate(Mat4(1.0), dice.vector(1e5)), Vec3(metresPerUnit_)),
              dice.in(0, 6), dice.direction())),
          views_(moved(scene.camera), optics.task),
          view_(views_.drawn, worldFromObject_),
          promised_(promiseOf(scene)) {
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                depth_.push_back(hit(drawn_, pinhole_.rayThrough(x + 0.5, y + 0.5)));
    }

    double promised() const { return promised_; }
    bool isRaster() const { return views_.drawn.step != Vec2(1); }

    /// The part [x, x + width) x [y, y + height) of a picture that shows `drawn` only.
    HiddenGround ground(const PixelViewport& drawn = {0, 0, kWidth, kHeight},
                        Reading reading = Reading::ByParts) const {
        return {
            view_, drawn,
            [this, drawn, reading, depth = std::vector<float>()](
                const PixelViewport& part) mutable -> std::span<const float> {
                EXPECT_TRUE(drawn.contains(part));
                EXPECT_TRUE(reading == Reading::ByParts || (part == drawn && depth.empty()));
                depth.clear();
                for (int y = part.y; y < part.y + part.height; ++y)
                    for (int x = part.x; x < part.x + part.width; ++x)
                        depth.push_back(static_cast<float>(
                            fabric::kNearMetres /
                            (metresPerUnit_ * depth_[static_cast<std::size_t>(y * kWidth + x)])));
                return depth;
            },
            reading};
    }

    bool showsAnyOf(const Box& patch) const {
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const double depth = depth_[static_cast<std::size_t>(y * kWidth + x)];
                if (!std::isfinite(depth))
                    continue;
                const Vec3 p = pinhole_.rayThrough(x + 0.5, y + 0.5).at(depth);
                if (p.x > patch.min.x && p.x < patch.max.x && p.y > patch.min.y &&
                    p.y < patch.max.y)
                    return true;
            }
        return false;
    }

    /// Whether the source's point of a column is seen in a picture of the source, a pixel or more
    /// from the edge, and not just through a gap in the drawn ground narrower than a pixel.
    bool sourceShows(const Vec2& column, double nearest) const {
        const Vec3 point(column, source_.heightsAt(column.x, column.y)[0]);
        const auto p = pinhole_.project(point);
        if (!p || p->x < 1 || p->y < 1 || p->x > kWidth - 1 || p->y > kHeight - 1 ||
            hit(source_, pinhole_.rayThrough(p->x, p->y)) < pinhole_.depth(point) * (1 - 1e-9))
            return false;
        const auto above = pinhole_.project(point + Vec3(0, 0, 1e-4));
        const Vec2 up = glm::normalize((*above - *p) * views_.drawn.step);
        const Vec2 raised = *p + promised_ * up / views_.drawn.step;
        double gap = 0;
        for (const double step : {-0.05, 0.05})
            for (double x = 0; std::abs(x) <= 1.2 && isOpen(raised + Vec2(x, 0), nearest);
                 x += step)
                gap += 0.05;
        return gap > 1.1;
    }

private:
    fabric::Camera moved(fabric::Camera camera) const {
        camera.eye = Vec3(worldFromObject_ * fabric::Vec4(camera.eye, 1));
        camera.target = Vec3(worldFromObject_ * fabric::Vec4(camera.target, 1));
        camera.up = Vec3(worldFromObject_ * fabric::Vec4(camera.up, 0));
        return camera;
    }

    double promiseOf(const Scene& scene) const {
        const lod::ObjectView whole(views_.whole, worldFromObject_);
        double worst = 0;
        const std::vector<Vec3> corners = trianglesOf(scene.drawn);
        for (std::size_t k = 0; k < corners.size(); k += 3) {
            const std::span<const Vec3, 3> triangle(corners.data() + k, 3);
            double error = 0;
            for (const Vec3& corner : triangle) error = std::max(error, scene.errorAt(corner));
            worst = std::max(worst, lod::VerticalError(whole, error).pixels(triangle));
        }
        return worst;
    }

    bool isOpen(const Vec2& at, double nearest) const {
        const truth::Ray ray = pinhole_.rayThrough(at.x, at.y);
        return hit(drawn_, ray) * glm::length(Vec2(ray.direction)) >= nearest;
    }

    TerrainRayCaster source_;
    TerrainRayCaster drawn_;
    truth::Pinhole pinhole_;
    double metresPerUnit_;
    Mat4 worldFromObject_;
    lod::TaskViews views_;
    lod::ObjectView view_;
    double promised_;
    std::vector<double> depth_;
};

/// All that is drawn and of the source over some cells.
Box patchOf(const Scene& scene, int i0, int j0, int cells) {
    Box box;
    for (int j = j0; j <= j0 + cells; ++j)
        for (int i = i0; i <= i0 + cells; ++i)
            for (const HeightGrid* grid : {&scene.source, &scene.drawn})
                box.grow(Vec3(i * kSpacing, j * kSpacing,
                              grid->heights[static_cast<std::size_t>(j * kPosts + i)]));
    return box;
}

double distanceTo(const Box& box, const Vec3& eye) {
    return glm::distance(Vec2(eye), glm::clamp(Vec2(eye), Vec2(box.min), Vec2(box.max)));
}

RC_GTEST_PROP(HiddenGround, IsSeenNeitherInThePictureNorInOneOfTheSource, (unsigned seed)) {
    Dice dice(seed);
    const Scene scene(dice);
    const Picture picture(scene, dice);
    HiddenGround ground = picture.ground();
    int hidden = 0;
    for (int n = 0; n < 60; ++n) {
        const int cells = 1 + n % 4;
        const Box patch = patchOf(scene, static_cast<int>(dice.in(0, kPosts - 1 - cells)),
                                  static_cast<int>(dice.in(0, kPosts - 1 - cells)), cells);
        if (!ground.coverOf(patch, picture.promised()))
            continue;
        ++hidden;
        RC_ASSERT(!picture.showsAnyOf(patch));
        for (int k = 0; k < 12; ++k)
            RC_ASSERT(!picture.sourceShows(
                {dice.in(patch.min.x, patch.max.x), dice.in(patch.min.y, patch.max.y)},
                distanceTo(patch, scene.camera.eye)));
    }
    RC_CLASSIFY(hidden > 20, "many are not seen");
    RC_CLASSIFY(picture.promised() > 1, "off by more than a pixel");
    RC_CLASSIFY(picture.isRaster(), "through a wall");
}

RC_GTEST_PROP(HiddenGround, OfATriangleIsSeenNowhere, (unsigned seed)) {
    Dice dice(seed);
    const Scene scene(dice);
    const Picture picture(scene, dice);
    HiddenGround ground = picture.ground();
    const std::vector<Vec3> corners = trianglesOf(scene.drawn);
    for (int n = 0; n < 60; ++n) {
        const auto first =
            3 * static_cast<std::size_t>(dice.in(0, static_cast<double>(corners.size()) / 3 - 1));
        const std::span<const Vec3, 3> triangle(corners.data() + first, 3);
        if (!ground.coverOf(triangle, picture.promised()))
            continue;
        Box bounds;
        for (const Vec3& corner : triangle) bounds.grow(corner);
        for (int k = 0; k < 6; ++k) {
            const double u = dice.in(0, 1);
            const double v = dice.in(0, 1 - u);
            const Vec3 point =
                triangle[0] + u * (triangle[1] - triangle[0]) + v * (triangle[2] - triangle[0]);
            RC_ASSERT(!picture.sourceShows(Vec2(point), distanceTo(bounds, scene.camera.eye)));
        }
    }
}

RC_GTEST_PROP(HiddenGround, IsNoMoreInAPartOfThePictureThanInTheWhole, (unsigned seed)) {
    Dice dice(seed);
    const Scene scene(dice);
    const Picture picture(scene, dice);
    const int x = static_cast<int>(dice.in(0, 60));
    const int y = static_cast<int>(dice.in(0, 40));
    HiddenGround whole = picture.ground();
    HiddenGround part = picture.ground({x, y, static_cast<int>(dice.in(1, kWidth - x)),
                                        static_cast<int>(dice.in(1, kHeight - y))});
    for (int n = 0; n < 40; ++n) {
        const Box patch = patchOf(scene, static_cast<int>(dice.in(0, kPosts - 3)),
                                  static_cast<int>(dice.in(0, kPosts - 3)), 2);
        RC_ASSERT(!part.coverOf(patch, picture.promised()) ||
                  whole.coverOf(patch, picture.promised()));
    }
}

RC_GTEST_PROP(HiddenGround, IsTheSameHoweverDepthsAreRead, (unsigned seed)) {
    Dice dice(seed);
    const Scene scene(dice);
    const Picture picture(scene, dice);
    const PixelViewport drawn{static_cast<int>(dice.in(0, 20)), static_cast<int>(dice.in(0, 20)),
                              kWidth - 20, kHeight - 20};
    HiddenGround byParts = picture.ground(drawn);
    HiddenGround atOnce = picture.ground(drawn, Reading::AllAtOnce);
    for (int n = 0; n < 40; ++n) {
        const Box patch = patchOf(scene, static_cast<int>(dice.in(0, kPosts - 3)),
                                  static_cast<int>(dice.in(0, kPosts - 3)), 2);
        const auto cover = atOnce.coverOf(patch, picture.promised());
        RC_ASSERT(byParts.coverOf(patch, picture.promised()) == cover);
        if (cover)
            RC_ASSERT(byParts.reachOf(*cover) == atOnce.reachOf(*cover));
    }
}

/// A wall of pixels 100 m ahead up to a height of the picture, sky above; looking along +x.
class Wall {
public:
    explicit Wall(int rows)
        : view_(lod::View(camera(), kWidth, kHeight), Mat4(1.0)),
          ground(view_, {0, 0, kWidth, kHeight},
                 [rows, depth = std::vector<float>()](
                     const PixelViewport& part) mutable -> std::span<const float> {
                     depth.clear();
                     for (int y = part.y; y < part.y + part.height; ++y)
                         for (int x = 0; x < part.width; ++x)
                             depth.push_back(
                                 y < rows ? static_cast<float>(fabric::kNearMetres / 100) : 0.0F);
                     return depth;
                 }) {}

    /// A box that reaches up to a row of the picture, seen from (0, 0, 0).
    static Box upTo(double row, double distance) {
        const double z = (row - kHeight / 2.0) / focal() * distance;
        return {{distance, -1, z - distance / focal()}, {distance + 1, 1, z}};
    }

private:
    static fabric::Camera camera() {
        fabric::Camera camera;
        camera.eye = {0, 0, 0};
        camera.target = {1, 0, 0};
        camera.fovYDegrees = 60;
        return camera;
    }
    static double focal() { return kHeight / (2 * std::tan(M_PI / 6)); }

    lod::ObjectView view_;

public:
    HiddenGround ground;
};

TEST(HiddenGround, IsAsFarBelowTheSkylineAsThePicturePromises) {
    Wall wall(40);
    EXPECT_TRUE(wall.ground.coverOf(Wall::upTo(34, 200), 1));
    EXPECT_TRUE(wall.ground.coverOf(Wall::upTo(34, 200), 4));
    EXPECT_FALSE(wall.ground.coverOf(Wall::upTo(34, 200), 6.5));
    EXPECT_FALSE(wall.ground.coverOf(Wall::upTo(39.5, 200), 1));
    EXPECT_FALSE(wall.ground.coverOf(Wall::upTo(34, 200), std::numeric_limits<double>::infinity()));
}

TEST(HiddenGround, IsBehindWhatIsDrawn) {
    Wall wall(40);
    EXPECT_TRUE(wall.ground.coverOf(Wall::upTo(20, 101), 1));
    EXPECT_FALSE(wall.ground.coverOf(Wall::upTo(20, 100), 1));
    EXPECT_FALSE(wall.ground.coverOf(Wall::upTo(20, 99), 1));
    EXPECT_FALSE(wall.ground.coverOf({Vec3(-1), Vec3(1)}, 1)) << "around the eye";
    EXPECT_FALSE(wall.ground.coverOf({{-9, -1, -1}, {-8, 1, 1}}, 1)) << "behind it";
}

TEST(HiddenGround, IsCoveredByWhatIsNoFartherThanReachSays) {
    Wall wall(40);
    const auto cover = wall.ground.coverOf(Wall::upTo(20, 200), 1);
    ASSERT_TRUE(cover);
    EXPECT_GT(cover->area(), 0);
    // Seen aside the wall is a little farther.
    EXPECT_GT(wall.ground.reachOf(*cover), 100);
    EXPECT_LT(wall.ground.reachOf(*cover), 101);
    EXPECT_EQ(wall.ground.reachOf({0, 39, 4, 2}), std::numeric_limits<double>::infinity()) << "sky";
    const auto beside = wall.ground.coverOf({{200, 900, -1}, {201, 901, 1}}, 1);
    ASSERT_TRUE(beside);
    EXPECT_EQ(wall.ground.reachOf(*beside), 0);
}

TEST(HiddenGround, ReachesTheEdgeOfThePictureWherePromisesAreOfAPixel) {
    Wall wall(kHeight);
    EXPECT_TRUE(wall.ground.coverOf(Wall::upTo(kHeight + 20, 200), 1));
    EXPECT_TRUE(wall.ground.coverOf(Wall::upTo(kHeight - 0.5, 200), 1));
    EXPECT_FALSE(wall.ground.coverOf(Wall::upTo(kHeight - 0.5, 200), 1.5))
        << "what is above the picture may be lower in the source";
}

}  // namespace
}  // namespace eyrie::occlusion
