// SPDX-License-Identifier: Apache-2.0
// Looks against double-precision rays at the source's posts: exaggerated terrain keeps its promise,
// and contour lines run where the elevations are.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "fabric/frustum.h"
#include "fabric/look.h"
#include "renderer/import/terrain_import.h"
#include "renderer/import/terrain_synth.h"
#include "renderer/lod/view.h"
#include "renderer/renderer.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/truth/depth_comparison.h"
#include "renderer/truth/drawn_terrain.h"
#include "renderer/truth/shown_surface.h"
#include "renderer/truth/terrain_promise.h"
#include "renderer/truth/terrain_ray_caster.h"
#include "tests/support/renderer.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

constexpr int kWidth = 480;
constexpr int kHeight = 270;
constexpr std::uint32_t kPosts = 513;

class TerrainLookTruth : public testing::Test {
protected:
    void SetUp() override {
        const terrain::HeightGrid posts = import::synthesizeTerrain(kPosts, 7);
        source_ = {posts.columns, posts.rows,      posts.heights,
                   posts.origin,  posts.perColumn, posts.perRow};
        const std::string file = folder_.path("terrain.eyt");
        const auto report = import::importTerrain(posts, {"synthetic", "", 7}, file, {});
        ASSERT_TRUE(report.ok()) << report.status();
        file_ = *terrain::EytFile::open(file);
        renderer_ = test::makeRenderer();
        fabric::Scene scene;
        scene.objects.push_back(
            {.name = "terrain", .kind = fabric::ObjectKind::Terrain, .path = file});
        auto info = renderer_->openScene(scene);
        ASSERT_TRUE(info.ok()) << info.status();
        bounds_ = info->bounds;
    }

    truth::TerrainRayCaster timesHeight(double exaggeration) const {
        truth::HeightGrid grid = source_;
        for (float& height : grid.heights)
            height = static_cast<float>(static_cast<double>(height) * exaggeration);
        return truth::TerrainRayCaster(std::move(grid));
    }

    struct Drawn {
        fabric::Image image;
        fabric::FrameStatistics statistics;
        std::vector<float> depth;  ///< metres
    };

    Drawn draw(const fabric::Camera& camera, double tauPixels, const fabric::Look& look,
               fabric::Occlusion occlusion = fabric::Occlusion::Auto,
               const fabric::PixelViewport& part = {0, 0, kWidth, kHeight}) {
        fabric::FrameData frame{1, camera, tauPixels, fabric::Shading::Smooth, look, occlusion};
        fabric::ChannelTask task;
        task.frameDataVersion = 1;
        task.viewWidth = kWidth;
        task.viewHeight = kHeight;
        task.pixelViewport = part;
        task.wantsDepth = true;
        auto result = renderer_->render(frame, task);
        EXPECT_TRUE(result.ok()) << result.status();
        Drawn drawn{fabric::makeImage(task.pixelViewport, {}, true), {}, {}};
        if (!result.ok())
            return drawn;
        fabric::paste(result->image, drawn.image);
        drawn.statistics = result->statistics;
        for (const float reversed : drawn.image.depth)
            drawn.depth.push_back(
                static_cast<float>(fabric::viewDepthMetres(reversed, fabric::kNearMetres)));
        return drawn;
    }

    /// All of what is drawn, from a height that depends on how high it is.
    fabric::Camera overview(double exaggeration) const {
        fabric::Box box = bounds_;
        box.min.z = std::min(bounds_.min.z * exaggeration, bounds_.max.z * exaggeration);
        box.max.z = std::max(bounds_.min.z * exaggeration, bounds_.max.z * exaggeration);
        return {.eye = box.centre() + glm::length(box.size()) * 0.9 * fabric::Vec3(-0.6, -0.7, 0.5),
                .target = box.centre()};
    }

    /// Just above the ground at a third of the terrain, looking down towards its middle.
    fabric::Camera close(const truth::TerrainRayCaster& ground, double exaggeration) const {
        const fabric::Vec3 third = bounds_.min + bounds_.size() / 3.0;
        const double height = ground.heightsAt(third.x, third.y)[0];
        const double above = 150 * std::max(1.0, std::abs(exaggeration));
        const fabric::Vec3 eye(third.x, third.y, height + above);
        return {.eye = eye, .target = eye + fabric::Vec3(1, 1.1, -0.9)};
    }

    /// Of a picture that promises so many pixels. Judged as TerrainPromise judges terrain that is
    /// not exaggerated: the source is seen at its posts' heights times x, and what is drawn is made
    /// of the file's triangles at theirs.
    void check(const char* name, double exaggeration, const fabric::Camera& camera,
               const truth::TerrainRayCaster& ground) {
        constexpr double kTau = 1;
        const Drawn drawn = draw(camera, kTau, {.exaggeration = exaggeration});
        ASSERT_TRUE(drawn.statistics.complete);
        const double promised = drawn.statistics.tauAchievedPixels;
        fabric::ChannelTask task;
        task.viewWidth = kWidth;
        task.viewHeight = kHeight;
        const auto triangles =
            truth::DrawnTerrain::of(*file_, lod::TaskViews(camera, task).whole, kTau,
                                    fabric::exaggerated(fabric::Mat4(1.0), exaggeration));
        ASSERT_TRUE(triangles.ok()) << triangles.status();
        const truth::Pinhole judge(camera, kWidth, kHeight);
        const truth::ShownSurface surface(triangles->triangles(), judge);
        const truth::ShownPoint shown = [&](double x, double y,
                                            double depth) -> std::optional<truth::DrawnPoint> {
            const auto found = surface.at(x, y, depth);
            if (!found)
                return std::nullopt;
            return truth::DrawnPoint{found->point, 0, found->mayHaveDepth, found->isAtEnd};
        };
        constexpr double kRaster = truth::TerrainPromise::kRasterPixels;
        const int edgePixels = static_cast<int>(std::clamp(std::ceil(promised), 1.0, 8.0));
        const truth::DepthComparison found = truth::compareDepth(
            judge, drawn.depth, ground, edgePixels, {promised + kRaster, shown});
        const double measured = triangles->farthestSeen(judge, ground, found.maxPixels);
        fmt::print(
            "{:>8} x {:<6} promised {:.4f} px, measured {:.4f} px, {} pixels, {} holes, {} "
            "false, {} misplaced, {} suspects, {} triangles\n",
            name, exaggeration, promised, measured, found.compared, found.holes, found.falseHits,
            found.misplaced, found.suspects, drawn.statistics.triangles);
        EXPECT_LE(measured, promised + kRaster);
        EXPECT_EQ(found.holes, 0U);
        EXPECT_EQ(found.falseHits, 0U);
        EXPECT_EQ(found.misplaced, 0U);
        EXPECT_GT(found.compared, 2000U) << "near tiles must not vanish";
    }

    /// A sea 100 m high, 65 posts of 30 m a side, that rises by so many metres a post from post 40.
    void openShore(float riseMetres) {
        terrain::HeightGrid sea;
        sea.columns = sea.rows = 65;
        sea.perColumn = {30, 0};
        sea.perRow = {0, 30};
        sea.heights.assign(65 * 65, 100.0F);
        for (std::int32_t j = 0; j < 65; ++j)
            for (std::int32_t i = 40; i < 65; ++i)
                sea.row(j)[i] = 100.0F + riseMetres * static_cast<float>(i - 40);
        const std::string file = folder_.path("sea.eyt");
        ASSERT_TRUE(import::importTerrain(sea, {"sea", "", 1}, file, {}).ok());
        fabric::Scene scene;
        scene.objects.push_back({.name = "sea", .kind = fabric::ObjectKind::Terrain, .path = file});
        ASSERT_TRUE(renderer_->openScene(scene).ok());
    }

    test::TemporaryFolder folder_;
    truth::HeightGrid source_;
    std::shared_ptr<const terrain::EytFile> file_;
    std::unique_ptr<Renderer> renderer_;
    fabric::Box bounds_;
};

TEST_F(TerrainLookTruth, ExaggeratedTerrainKeepsItsPromise) {
    for (const double exaggeration : {-1.0, 0.0, 1e-3, 1.0, 10.0, 100.0}) {
        const truth::TerrainRayCaster ground = timesHeight(exaggeration);
        check("overview", exaggeration, overview(exaggeration), ground);
        check("close", exaggeration, close(ground, exaggeration), ground);
    }
}

using HardCase10 = TerrainLookTruth;

/// What is culled, by the picture's sides or behind hills, is where it is drawn: parts of a picture
/// are those of the whole one, with and without occlusion culling. That the whole one is right is
/// said by ExaggeratedTerrainKeepsItsPromise.
TEST_F(HardCase10, PartsOfPicturesAreThoseOfTheWholeHoweverHeightsAreDrawn) {
    for (const double exaggeration : {-1.0, 0.0, 1e-3, 1.0, 10.0, 100.0}) {
        const fabric::Look look{.exaggeration = exaggeration};
        const fabric::Camera camera = close(timesHeight(exaggeration), exaggeration);
        const fabric::Image whole = draw(camera, 2, look, fabric::Occlusion::Off).image;
        EXPECT_GT(std::ranges::count_if(whole.depth, [](float depth) { return depth > 0; }), 2000);
        fabric::Image parts = fabric::makeImage(whole.area, {}, true);
        for (int y = 0; y < kHeight; y += 90)
            for (int x = 0; x < kWidth; x += 80) {
                const fabric::PixelViewport part{x, y, 80, 90};
                draw(camera, 2, look, fabric::Occlusion::On, part);  // what hides what is known now
                fabric::paste(draw(camera, 2, look, fabric::Occlusion::On, part).image, parts);
            }
        EXPECT_TRUE(parts == whole) << exaggeration;
    }
}

/// Elevations in contour intervals at the pixel's centre and beside it.
struct Slope {
    double at = 0;
    double perPixel = 0;  ///< length of the gradient on the screen
};

class ContourJudge {
public:
    ContourJudge(const truth::TerrainRayCaster& ground, const truth::Pinhole& pinhole,
                 double intervalMetres)
        : ground_(ground), pinhole_(pinhole), interval_(intervalMetres) {}

    /// Nothing at outlines and where the ground bends within a pixel.
    std::optional<Slope> at(double x, double y) const {
        const double here = elevation(x, y);
        const double dx0 = here - elevation(x - 1, y);
        const double dx1 = elevation(x + 1, y) - here;
        const double dy0 = here - elevation(x, y - 1);
        const double dy1 = elevation(x, y + 1) - here;
        const double perPixel = std::hypot(dx0 + dx1, dy0 + dy1) / 2;
        const double bend = std::max(std::abs(dx1 - dx0), std::abs(dy1 - dy0));
        if (!std::isfinite(perPixel) || bend > 0.25 * perPixel)
            return std::nullopt;
        return Slope{here, perPixel};
    }

private:
    double elevation(double x, double y) const {
        const truth::Ray ray = pinhole_.rayThrough(x, y);
        const auto hits = ground_.firstHits(ray);
        return ray.at(*std::min_element(hits.begin(), hits.end())).z / interval_;
    }

    const truth::TerrainRayCaster& ground_;
    const truth::Pinhole& pinhole_;
    double interval_;
};

/// How much darker, in linear light, a pixel is than without lines.
double darkening(const fabric::Rgba& with, const fabric::Rgba& without) {
    const double ratio = with.g / std::max(1.0, static_cast<double>(without.g));
    return 1 - ratio * ratio;
}

TEST_F(TerrainLookTruth, ContourLinesRunWhereTheElevationsAre) {
    constexpr double kInterval = 200;
    constexpr double kLineWidth = 3;
    constexpr double kTau = 0.01;
    const truth::TerrainRayCaster ground = timesHeight(1);
    const fabric::Camera camera{.eye = bounds_.centre() + fabric::Vec3(-4000, -5000, 9000),
                                .target = bounds_.centre()};
    const truth::Pinhole pinhole(camera, kWidth, kHeight);
    fabric::Look look{.transfer = fabric::TransferFunction{}, .slopeShading = 0};
    const Drawn without = draw(camera, kTau, look);
    look.contours = fabric::ContourLines{kInterval, kLineWidth};
    const Drawn with = draw(camera, kTau, look);
    const ContourJudge judge(ground, pinhole, kInterval);
    int lines = 0;
    int strong = 0;
    int gaps = 0;
    int wrong = 0;
    int stray = 0;
    for (int y = 2; y < kHeight - 2; ++y)
        for (int x = 2; x < kWidth - 2; ++x) {
            const auto pixel = static_cast<std::size_t>(y * kWidth + x);
            const std::optional<Slope> slope = judge.at(x + 0.5, y + 0.5);
            if (!slope || slope->perPixel * kLineWidth > 0.2 || slope->perPixel < 1e-3)
                continue;
            // The drawn ground may be off by so much, an error along the height counting as a
            // quarter at least, and a pixel's share is that of its centre.
            const double metresOff =
                4 * with.statistics.tauAchievedPixels * with.depth[pixel] / pinhole.focalPixels();
            const double slack = 0.75 + metresOff / kInterval / slope->perPixel;
            const double nearest = std::round(slope->at);
            const double pixelsOff = std::abs(slope->at - nearest) / slope->perPixel;
            const bool isStrong = static_cast<long>(nearest) % 5 == 0;
            const double width = isStrong ? 1.5 * kLineWidth : kLineWidth;
            const double dark = darkening(with.image.colour[pixel], without.image.colour[pixel]);
            if (pixelsOff + slack < 0.5 * width - 0.5) {
                ++(isStrong ? strong : lines);
                wrong += dark < (isStrong ? 0.7 : 0.4) || (!isStrong && dark > 0.6) ? 1 : 0;
            } else if (pixelsOff - slack > 0.5 * width + 0.5) {
                ++gaps;
                wrong += dark > 0.05 ? 1 : 0;
                stray += dark > 0.05 && pixelsOff - slack > 0.5 * width + 3.5 ? 1 : 0;
            }
        }
    fmt::print("{} pixels in lines, {} in strong ones, {} between, {} wrong, {} stray\n", lines,
               strong, gaps, wrong, stray);
    // Distances go by the slope of the one triangle in the pixel: on one that is steeper than those
    // around, a line is wider. Measured: 29 pixels of 14,639, by up to three pixels.
    EXPECT_LE(wrong, (lines + strong + gaps) / 200);
    EXPECT_EQ(stray, 0);
    EXPECT_GT(lines, 100);
    EXPECT_GT(strong, 100);
    EXPECT_GT(gaps, 10000);
}

TEST_F(TerrainLookTruth, LevelGroundAtALinesHeightIsNoLine) {
    openShore(20);
    const fabric::Camera camera{
        .eye = {960, 900, 2500}, .target = {960, 960, 100}, .up = {0, 1, 0}};
    fabric::Look look{.transfer = fabric::TransferFunction{}};
    const Drawn without = draw(camera, 1, look);
    look.contours = fabric::ContourLines{50, 2};
    const Drawn with = draw(camera, 1, look);
    int dark = 0;
    int darkOnTheSea = 0;
    const truth::Pinhole pinhole(camera, kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const auto pixel = static_cast<std::size_t>(y * kWidth + x);
            if (std::isinf(with.depth[pixel]) ||
                darkening(with.image.colour[pixel], without.image.colour[pixel]) < 0.1)
                continue;
            ++dark;
            const fabric::Vec3 hit = pinhole.rayThrough(x + 0.5, y + 0.5).at(with.depth[pixel]);
            darkOnTheSea += hit.x < 40 * 30 - 30 ? 1 : 0;
        }
    EXPECT_GT(dark, 200) << "the slope has lines";
    EXPECT_EQ(darkOnTheSea, 0);
}

TEST_F(TerrainLookTruth, SlopeShadingShowsRockOnCliffsAlone) {
    openShore(120);
    const fabric::Camera camera{
        .eye = {960, 900, 6000}, .target = {960, 960, 100}, .up = {0, 1, 0}};
    fabric::Look look{.transfer = fabric::TransferFunction{}};
    const Drawn rock = draw(camera, 1, look);
    look.slopeShading = 0;
    const Drawn bare = draw(camera, 1, look);
    const truth::Pinhole pinhole(camera, kWidth, kHeight);
    int changed = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const auto pixel = static_cast<std::size_t>(y * kWidth + x);
            if (rock.image.colour[pixel] == bare.image.colour[pixel])
                continue;
            ++changed;
            const fabric::Vec3 hit = pinhole.rayThrough(x + 0.5, y + 0.5).at(rock.depth[pixel]);
            EXPECT_GT(hit.x, 38 * 30) << "the sea is level";
        }
    EXPECT_GT(changed, 500);
}

}  // namespace
}  // namespace eyrie
