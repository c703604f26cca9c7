// SPDX-License-Identifier: Apache-2.0
// Tiles meet without cracks wherever the terrain stands: thousands of views straight onto borders
// and corners, where anything missing would let the background through.
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
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using fabric::Vec3;

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr int kViews = 1000;
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

    fabric::Image draw(std::size_t at, const View& view) {
        const Vec3 origin(kOrigins[at], kOrigins[at], 0);
        fabric::FrameData frame;
        frame.camera = {view.eye + origin, view.target + origin, {0.25, 1, 0.125}, 40};
        frame.tauPixels = view.tauPixels;
        fabric::ChannelTask task;
        task.viewWidth = kWidth;
        task.viewHeight = kHeight;
        task.pixelViewport = {0, 0, kWidth, kHeight};
        task.wantsDepth = true;
        auto result = renderers_[at]->render(frame, task);
        EXPECT_TRUE(result.ok()) << result.status();
        return result.ok() ? result->image : fabric::Image{};
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
        const fabric::Image picture = draw(0, view);
        ASSERT_EQ(picture.area.area(), std::int64_t{kWidth} * kHeight) << "view " << i;
        const auto open = std::count(picture.depth.begin(), picture.depth.end(), 0.0F);
        EXPECT_EQ(open, 0) << "view " << i;
        holes += static_cast<std::size_t>(open);
        for (std::size_t at = 1; at < kOrigins.size(); ++at) {
            const bool isSame = draw(at, view) == picture;
            EXPECT_TRUE(isSame) << "view " << i << " at origin " << kOrigins[at];
            differing += isSame ? 0 : 1;
        }
    }
    fmt::print("{} hole pixels in {} views; {} pictures differ between origins\n", holes, kViews,
               differing);
}

}  // namespace
}  // namespace eyrie
