// SPDX-License-Identifier: Apache-2.0
// Tiles meet without cracks wherever the terrain stands: thousands of views straight onto borders
// and corners, where anything missing would let the background through, and hundreds that are
// slanted or graze the ground.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "renderer/gl/debug_output.h"
#include "renderer/import/terrain_import.h"
#include "renderer/import/terrain_synth.h"
#include "renderer/renderer.h"
#include "renderer/terrain/quadtree.h"
#include "renderer/truth/pinhole.h"
#include "renderer/truth/terrain_ray_caster.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using fabric::Vec3;

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr int kViews = 1000;
constexpr int kSlantedViews = 300;
constexpr std::int32_t kPosts = 1025;
constexpr std::int32_t kMargin = 384;  ///< posts that no picture may look past
/// A power of two, as are all positions below: what differs between origins is then their distance
/// alone, and not the rounding of the test's own numbers.
constexpr double kPostMetres = 32;
constexpr std::array<double, 3> kOrigins = {0, 5e5, 6.4e6};

double to64ths(double metres) { return std::round(metres * 64) / 64; }

/// A camera over the terrain, relative to its first post.
struct View {
    Vec3 eye;
    Vec3 target;
    double tauPixels;
    Vec3 up{0.25, 1, 0.125};
    int width = kWidth;
    int height = kHeight;
};

/// Above all posts around it, so above whatever is drawn there but for tau.
bool isAboveGround(const Vec3& eye, const terrain::HeightGrid& grid) {
    const auto i = static_cast<std::int32_t>(eye.x / kPostMetres);
    const auto j = static_cast<std::int32_t>(eye.y / kPostMetres);
    for (std::int32_t y = j - 1; y <= j + 2; ++y)
        for (std::int32_t x = i - 1; x <= i + 2; ++x)
            if (!(eye.z > static_cast<double>(grid.at(x, y)) + 1))
                return false;
    return true;
}

/// Looks at a border or a corner of some level's tiles, from at most 23 degrees off the vertical
/// and so near that the picture's edge stays on the terrain.
View onBorder(std::mt19937& random, const terrain::HeightGrid& grid) {
    const auto in = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto below = [&](std::int32_t count) {
        return static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(count));
    };
    const std::int32_t side = terrain::Quadtree::side(below(4));
    const std::int32_t tiles = (kPosts - 1) / side;
    const auto border = [&] { return side * (1 + below(std::max(tiles - 1, 1))); };
    const auto inside = [&] { return kMargin + below(kPosts - 2 * kMargin); };
    std::int32_t i = border();
    std::int32_t j = random() % 2 == 0 ? border() : inside();
    i = std::clamp(i, kMargin, kPosts - kMargin - 1);
    j = std::clamp(j, kMargin, kPosts - kMargin - 1);
    if (random() % 2 == 0)
        std::swap(i, j);
    const double ground = static_cast<double>(grid.at(i, j));
    const double distance = 5 * std::exp2(in(0, 9.5));
    const double azimuth = in(0, 6.283);
    const double lean = in(0, 0.4);
    View view;
    view.target = {i * kPostMetres, j * kPostMetres, to64ths(ground)};
    view.eye = view.target + Vec3(to64ths(distance * std::sin(lean) * std::cos(azimuth)),
                                  to64ths(distance * std::sin(lean) * std::sin(azimuth)),
                                  to64ths(distance * std::cos(lean)));
    view.tauPixels = std::exp2(in(-1, 3));
    return view;
}

fabric::Camera cameraOf(const View& view, const Vec3& origin) {
    return {view.eye + origin, view.target + origin, view.up, 40};
}

double between(std::mt19937& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

/// A small picture to any side from a place on a border of some level's tiles: every other from
/// high above, down by 1 to 67 degrees, and from 3 to 300 m above ground, within 6 degrees of
/// level.
View slanted(std::mt19937& random, const terrain::HeightGrid& grid, int number) {
    constexpr std::int32_t kRim = 32;  ///< posts
    const auto inside = [&] {
        return kRim + static_cast<std::int32_t>(random() % std::uint32_t{kPosts - 2 * kRim});
    };
    const std::int32_t side = terrain::Quadtree::side(static_cast<int>(random() % 4));
    std::int32_t i = std::clamp(inside() / side * side, kRim, kPosts - kRim);
    std::int32_t j = inside();
    if (random() % 2 == 0)
        std::swap(i, j);
    const bool grazes = number % 2 == 0;
    const double azimuth = between(random, 0, 6.283);
    const double down = grazes ? between(random, -0.1, 0.1) : between(random, 0.02, 1.17);
    const double above = grazes ? std::exp2(between(random, 1.5, 8.2)) : between(random, 50, 3000);
    View view;
    view.eye = {i * kPostMetres, j * kPostMetres,
                to64ths(static_cast<double>(grid.at(i, j)) + above)};
    view.target = view.eye + Vec3(to64ths(1000 * std::cos(down) * std::cos(azimuth)),
                                  to64ths(1000 * std::cos(down) * std::sin(azimuth)),
                                  to64ths(-1000 * std::sin(down)));
    view.tauPixels = std::exp2(between(random, -1, 3));
    view.up = {0.25, 0.125, 1};
    view.width = 160;
    view.height = 120;
    return view;
}

/// Whether rays through a pixel's centre and those of all pixels within `reach` meet the source,
/// however its cells are read.
bool isOverGround(const truth::Pinhole& pinhole, const truth::TerrainRayCaster& ground, int x,
                  int y, int reach) {
    const auto meets = [&](int column, int row) {
        const auto hits = ground.firstHits(pinhole.rayThrough(column + 0.5, row + 0.5));
        return std::ranges::all_of(hits, [](double hit) { return std::isfinite(hit); });
    };
    if (!meets(x, y))  // the sky, as a rule
        return false;
    for (int row = y - reach; row <= y + reach; ++row)
        for (int column = x - reach; column <= x + reach; ++column)
            if (!meets(column, row))
                return false;
    return true;
}

/// Open pixels that the ground covers: outlines may be off by what the picture promises.
int holesIn(const fabric::ChannelResult& drawn, const View& view,
            const truth::TerrainRayCaster& ground) {
    const truth::Pinhole pinhole(cameraOf(view, {}), view.width, view.height);
    fabric::Image whole = fabric::makeImage({0, 0, view.width, view.height}, {}, true);
    if (!drawn.image.area.isEmpty())
        fabric::paste(drawn.image, whole);
    const int reach = 1 + static_cast<int>(std::ceil(drawn.statistics.tauAchievedPixels));
    int holes = 0;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x)
            if (whole.depth[static_cast<std::size_t>(y * view.width + x)] <= 0)
                holes += isOverGround(pinhole, ground, x, y, reach) ? 1 : 0;
    return holes;
}

class TerrainCracks : public testing::Test {
protected:
    void SetUp() override {
        gl::setOnGlError(gl::OnGlError::Abort);
        grid_ = import::synthesizeTerrain(kPosts, 11);
        grid_.perColumn = {kPostMetres, 0};
        grid_.perRow = {0, kPostMetres};
        for (const double origin : kOrigins) renderers_.push_back(open(origin));
    }

    std::unique_ptr<Renderer> open(double origin) {
        grid_.origin = {origin, origin};
        const std::string path = (folder_.path() / fmt::format("{}.eyt", origin)).string();
        const auto report =
            import::importTerrain(grid_, {.name = "hills", .crsWkt = "", .hash = 1}, path, {});
        EXPECT_TRUE(report.ok()) << report.status();
        auto renderer = Renderer::create({});
        EXPECT_TRUE(renderer.ok()) << renderer.status();
        fabric::Scene scene;
        scene.lights.push_back({});
        scene.objects.push_back({"hills", fabric::ObjectKind::Terrain, path});
        EXPECT_TRUE((*renderer)->openScene(scene).ok());
        return *std::move(renderer);
    }

    fabric::ChannelResult draw(std::size_t at, const View& view) {
        fabric::FrameData frame;
        frame.camera = cameraOf(view, {kOrigins[at], kOrigins[at], 0});
        frame.tauPixels = view.tauPixels;
        fabric::ChannelTask task;
        task.viewWidth = view.width;
        task.viewHeight = view.height;
        task.pixelViewport = {0, 0, view.width, view.height};
        task.wantsDepth = true;
        auto result = renderers_[at]->render(frame, task);
        EXPECT_TRUE(result.ok()) << result.status();
        return result.ok() ? *std::move(result) : fabric::ChannelResult{};
    }

    test::TemporaryFolder folder_;
    terrain::HeightGrid grid_;
    std::vector<std::unique_ptr<Renderer>> renderers_;
};

TEST_F(TerrainCracks, AreNowhereAndPicturesAreTheSameBitsFarFromTheOrigin) {
    std::mt19937 random(20261121);
    std::size_t holes = 0;
    std::size_t differing = 0;
    for (int i = 0; i < kViews && holes + differing < 20; ++i) {
        View view = onBorder(random, grid_);
        while (!isAboveGround(view.eye, grid_)) view = onBorder(random, grid_);
        const fabric::Image picture = draw(0, view).image;
        ASSERT_EQ(picture.area.area(), std::int64_t{kWidth} * kHeight) << "view " << i;
        const auto open = std::count(picture.depth.begin(), picture.depth.end(), 0.0F);
        EXPECT_EQ(open, 0) << "view " << i;
        holes += static_cast<std::size_t>(open);
        for (std::size_t at = 1; at < kOrigins.size(); ++at) {
            const bool isSame = draw(at, view).image == picture;
            EXPECT_TRUE(isSame) << "view " << i << " at origin " << kOrigins[at];
            differing += isSame ? 0 : 1;
        }
    }
    fmt::print("{} hole pixels in {} views; {} pictures differ between origins\n", holes, kViews,
               differing);
}

/// Which pixels may be open, rays at the source's posts say.
TEST_F(TerrainCracks, AreNowhereInSlantedAndGrazingViewsEither) {
    const truth::TerrainRayCaster ground(
        {kPosts, kPosts, grid_.heights, {0, 0}, grid_.perColumn, grid_.perRow});
    std::mt19937 random(20261130);
    int bad = 0;
    std::size_t covered = 0;
    for (int i = 0; i < kSlantedViews && bad < 20; ++i) {
        View view = slanted(random, grid_, i);
        while (!isAboveGround(view.eye, grid_)) view = slanted(random, grid_, i);
        const fabric::ChannelResult drawn = draw(0, view);
        covered += static_cast<std::size_t>(
            std::ranges::count_if(drawn.image.depth, [](float depth) { return depth > 0; }));
        const int holes = holesIn(drawn, view, ground);
        EXPECT_EQ(holes, 0) << "view " << i;
        bad += holes;
        for (std::size_t at = 1; at < kOrigins.size(); ++at) {
            const bool isSame = draw(at, view).image == drawn.image;
            EXPECT_TRUE(isSame) << "view " << i << " at origin " << kOrigins[at];
            bad += isSame ? 0 : 1;
        }
    }
    fmt::print("{} pixels covered in {} views\n", covered, kSlantedViews);
    EXPECT_GT(covered, std::size_t{kSlantedViews} * 4000) << "the views should see the terrain";
}

}  // namespace
}  // namespace eyrie
