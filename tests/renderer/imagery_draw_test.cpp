// SPDX-License-Identifier: Apache-2.0
// Pictures on terrain, as they are drawn: looked at from straight above on level ground, where each
// pixel's place is known, in light that comes from everywhere.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "renderer/gl/debug_output.h"
#include "renderer/renderer.h"
#include "renderer/terrain/imagery/imagery_parts.h"
#include "tests/renderer/import/imagery_fixture.h"

namespace eyrie {
namespace {

using fabric::ChannelResult;
using fabric::Completeness;
using fabric::PixelViewport;
using fabric::Rgba;
using fabric::Vec2;
using test::kSouth;
using test::kWest;

constexpr int kWidth = 640;
constexpr int kHeight = 360;
constexpr double kGround = 100;
const Rgba kBackground{255, 0, 255, 255};

/// A camera straight above the ground, north up, whose pixels are so many metres there.
struct Overhead {
    Vec2 centre;
    double metresPerPixel;
    double height = kHeight * metresPerPixel * 50;  ///< so far that texels are all of a size

    fabric::Camera camera() const {
        fabric::Camera camera;
        camera.eye = {centre.x, centre.y, kGround + height};
        camera.target = {centre.x, centre.y, kGround};
        camera.up = {0, 1, 0};
        camera.fovYDegrees = 360 / M_PI * std::atan(kHeight * metresPerPixel / 2 / height);
        return camera;
    }
    /// Where on the ground the middle of a pixel lies; rows from the bottom.
    Vec2 ground(int column, int row) const {
        return centre +
               Vec2(column + 0.5 - kWidth / 2.0, row + 0.5 - kHeight / 2.0) * metresPerPixel;
    }
};

double psnr(double squares, double values) { return 10 * std::log10(255 * 255 * values / squares); }

/// Bilinear between the middles of texels, which are `texel` metres a side from the grid's corner.
std::array<double, 3> filtered(const test::TexelImage& image, const Vec2& ground, double texel) {
    const double u = (ground.x - kWest) / texel - 0.5;
    const double v = (ground.y - kSouth) / texel - 0.5;
    const auto x = static_cast<std::int64_t>(std::floor(u));
    const auto y = static_cast<std::int64_t>(std::floor(v));
    std::array<double, 3> sum{};
    for (int k = 0; k < 4; ++k) {
        const double weight =
            ((k & 1) != 0 ? u - static_cast<double>(x) : 1 - u + static_cast<double>(x)) *
            ((k >> 1) != 0 ? v - static_cast<double>(y) : 1 - v + static_cast<double>(y));
        const Rgba& texelAt = image.at(std::clamp<std::int64_t>(x + (k & 1), 0, image.width - 1),
                                       std::clamp<std::int64_t>(y + (k >> 1), 0, image.height - 1));
        sum[0] += weight * texelAt.r;
        sum[1] += weight * texelAt.g;
        sum[2] += weight * texelAt.b;
    }
    return sum;
}

class ImageryDraw : public testing::Test {
protected:
    void SetUp() override { gl::setOnGlError(gl::OnGlError::Abort); }

    static terrain::HeightGrid plain(std::int32_t columns, std::int32_t rows, double postMetres) {
        terrain::HeightGrid grid = test::slope(columns, rows, postMetres);
        std::fill(grid.heights.begin(), grid.heights.end(), static_cast<float>(kGround));
        return grid;
    }

    /// Waves with a little noise on them, so that every texel differs from the next.
    static Rgba pattern(double x, double y) {
        const auto wave = [](double t) { return 120 + 70 * std::sin(t); };
        const double noise =
            std::fmod(std::abs(std::sin(x * 12.9898 + y * 78.233)) * 43758.5453, 30);
        return {static_cast<std::uint8_t>(wave(x / 90) + noise),
                static_cast<std::uint8_t>(wave(y / 70) + noise),
                static_cast<std::uint8_t>(wave((x + y) / 150) + noise), 255};
    }

    void import(const terrain::HeightGrid& grid, double postMetres, double pixel,
                const std::function<Rgba(double, double)>& colour) {
        const double margin = 4 * pixel;
        const double width = (grid.columns - 1) * postMetres;
        const double height = (grid.rows - 1) * postMetres;
        const std::string path = folder_.path("picture.tif");
        test::writePicture(path,
                           {.west = kWest - margin,
                            .north = kSouth + height + margin,
                            .pixel = pixel,
                            .columns = static_cast<int>(std::ceil((width + 2 * margin) / pixel)),
                            .rows = static_cast<int>(std::ceil((height + 2 * margin) / pixel)),
                            .colour = colour});
        auto file = test::importedWith(grid, {path}, folder_);
        ASSERT_TRUE(file.ok()) << file.status();
        file_ = *file;
        postMetres_ = postMetres;
    }

    std::unique_ptr<Renderer> open(const std::string& path, const RendererOptions& options = {}) {
        auto renderer = Renderer::create(options);
        EXPECT_TRUE(renderer.ok()) << renderer.status();
        fabric::Scene scene;
        scene.ambient = 1;
        scene.background = kBackground;
        scene.objects.push_back(
            {.name = "ground", .kind = fabric::ObjectKind::Terrain, .path = path});
        const auto info = (*renderer)->openScene(scene);
        EXPECT_TRUE(info.ok()) << info.status();
        return *std::move(renderer);
    }

    static ChannelResult draw(Renderer& renderer, const fabric::Camera& camera,
                              Completeness completeness = Completeness::Complete,
                              PixelViewport part = {0, 0, kWidth, kHeight},
                              const fabric::Range& range = {}, const fabric::Look& look = {}) {
        fabric::FrameData frame;
        frame.camera = camera;
        frame.look = look;
        fabric::ChannelTask task;
        task.viewWidth = kWidth;
        task.viewHeight = kHeight;
        task.pixelViewport = part;
        task.completeness = completeness;
        task.range = range;
        auto result = renderer.render(frame, task);
        EXPECT_TRUE(result.ok()) << result.status();
        return *std::move(result);
    }

    static const Rgba& at(const ChannelResult& result, int column, int row) {
        const PixelViewport& area = result.image.area;
        return result.image
            .colour[static_cast<std::size_t>((row - area.y) * area.width + column - area.x)];
    }

    double texelMetres(int level) const {
        return postMetres_ * file_->index().imagery->pyramid.texelPosts(level);
    }

    /// The largest difference of any pixel from one image of a whole level, filtered.
    double differenceFromOneImage(const ChannelResult& result, const Overhead& view,
                                  int level) const {
        const test::TexelImage image = test::wholeLevel(*file_, level);
        double most = 0;
        for (int row = 0; row < kHeight; ++row)
            for (int column = 0; column < kWidth; ++column) {
                const auto expected = filtered(image, view.ground(column, row), texelMetres(level));
                const Rgba& found = at(result, column, row);
                most = std::max({most, std::abs(expected[0] - found.r),
                                 std::abs(expected[1] - found.g), std::abs(expected[2] - found.b)});
            }
        return most;
    }

    test::TemporaryFolder folder_;
    std::shared_ptr<const terrain::EytFile> file_;
    double postMetres_ = 1;
};

using HardCase25 = ImageryDraw;

/// Of filters: 8 bits of weight each way, and the display's square.
constexpr double kFilterTolerance = 2.5;

TEST_F(ImageryDraw, ShowsThePictureWhereItLies) {
    import(plain(193, 129, 10), 10, 2.5, pattern);
    const auto renderer = open(file_->path());
    const Overhead view{{kWest + 960, kSouth + 640}, 2.5};
    const ChannelResult result = draw(*renderer, view.camera());
    EXPECT_TRUE(result.statistics.complete);
    double squares = 0;
    for (int row = 0; row < kHeight; ++row)
        for (int column = 0; column < kWidth; ++column) {
            const Vec2 ground = view.ground(column, row);
            const Rgba expected = pattern(ground.x, ground.y);
            const Rgba& found = at(result, column, row);
            squares += std::pow(expected.r - found.r, 2) + std::pow(expected.g - found.g, 2) +
                       std::pow(expected.b - found.b, 2);
        }
    // The noise alone, with BC1 and two resamplings, makes 27 dB; a pixel's shift makes 24.
    EXPECT_GT(psnr(squares, 3.0 * kWidth * kHeight), 25);
}

TEST_F(ImageryDraw, FiltersAcrossTileBordersAsOneImage) {
    import(plain(193, 129, 10), 10, 1.25, pattern);
    ASSERT_GE(file_->index().imagery->pyramid.tilesX(0), 3);
    const auto renderer = open(file_->path());
    // Around the corner of four texture tiles, two pixels a texel.
    const Overhead view{{kWest + 512 * 1.25 + 0.3, kSouth + 512 * 1.25 + 0.2}, 0.625};
    const ChannelResult result = draw(*renderer, view.camera());
    EXPECT_LT(differenceFromOneImage(result, view, 0), kFilterTolerance);
}

TEST_F(ImageryDraw, FiltersCoarserLevelsAcrossTileBordersAsOneImage) {
    import(plain(385, 257, 10), 10, 1.25, pattern);
    const auto renderer = open(file_->path());
    // Texels of level 1 are 2.5 m.
    const Overhead view{{kWest + 512 * 2.5, kSouth + 512 * 2.5}, 2.0};
    const ChannelResult result = draw(*renderer, view.camera());
    EXPECT_LT(differenceFromOneImage(result, view, 1), kFilterTolerance);
}

TEST_F(ImageryDraw, ShowsPictures64TimesFinerThanTheElevations) {
    import(plain(70, 40, 64), 64, 1, pattern);
    ASSERT_EQ(file_->index().imagery->pyramid.texelShift(), 6);
    const auto renderer = open(file_->path());
    // A tile of the finest level is 4 x 4 texture tiles: here are the corners of some.
    const Overhead view{{kWest + 2048, kSouth + 1536}, 0.6};
    const ChannelResult result = draw(*renderer, view.camera());
    EXPECT_TRUE(result.statistics.complete);
    EXPECT_LT(differenceFromOneImage(result, view, 0), kFilterTolerance);
}

TEST_F(ImageryDraw, ShowsPictures64TimesCoarserThanTheElevations) {
    import(plain(1200, 700, 1), 1, 64, [](double x, double y) {
        return Rgba{static_cast<std::uint8_t>(128 + 100 * std::sin(x / 300)),
                    static_cast<std::uint8_t>(128 + 100 * std::sin(y / 200)), 80, 255};
});
const auto renderer = open(file_->path());
const Overhead view{{kWest + 600, kSouth + 350}, 1};
const ChannelResult result = draw(*renderer, view.camera());
EXPECT_LT(differenceFromOneImage(result, view, 0), kFilterTolerance);
}  // namespace

TEST_F(ImageryDraw, TintsTheGroundWhereThereIsNoPicture) {
    const auto half = [](double x, double y) {
        return x < kWest + 960 ? Rgba{0, 0, 0, 0} : pattern(x, y);
    };
    import(plain(193, 129, 10), 10, 2.5, half);
    const Overhead view{{kWest + 960, kSouth + 640}, 2.5};
    const ChannelResult with = draw(*open(file_->path()), view.camera());
    const auto bare = test::importedWith(plain(193, 129, 10), {}, folder_);
    ASSERT_TRUE(bare.ok()) << bare.status();
    const ChannelResult without = draw(*open((*bare)->path()), view.camera());
    int differing = 0;
    for (int row = 0; row < kHeight; ++row)
        for (int column = 0; column < kWidth / 2 - 2; ++column)
            differing += at(with, column, row) != at(without, column, row) ? 1 : 0;
    EXPECT_EQ(differing, 0);
    EXPECT_NE(at(with, kWidth / 2 + 9, 9), at(without, kWidth / 2 + 9, 9));
}

TEST_F(ImageryDraw, ChannelsOfAFrameShowTheSamePicture) {
    import(plain(70, 40, 64), 64, 1, pattern);
    const auto renderer = open(file_->path());
    fabric::Camera camera = Overhead{{kWest + 2048, kSouth + 1000}, 1.5, 1500}.camera();
    camera.target.y += 900;  // aslant, so that levels differ
    const ChannelResult whole = draw(*renderer, camera);
    const ChannelResult left =
        draw(*renderer, camera, Completeness::Complete, {0, 0, kWidth / 2 - 7, kHeight});
    const PixelViewport& area = left.image.area;
    int differing = 0;
    for (int row = area.y; row < area.y + area.height; ++row)
        for (int column = area.x; column < area.x + area.width; ++column)
            differing += at(left, column, row) != at(whole, column, row) ? 1 : 0;
    EXPECT_EQ(differing, 0);
    EXPECT_GT(area.width, kWidth / 2 - 20);
}

/// Flips a byte in the middle of texture tiles of one level, in a copy of the file.
std::string damagedCopy(const terrain::EytFile& file, int level) {
    std::string path = file.path() + ".copy";
    std::filesystem::copy_file(file.path(), path,
                               std::filesystem::copy_options::overwrite_existing);
    std::fstream bytes(path, std::ios::in | std::ios::out | std::ios::binary);
    const terrain::ImageryIndex& imagery = *file.index().imagery;
    for (std::uint32_t k = 0; k < imagery.pyramid.tileCount(); ++k) {
        if (imagery.pyramid.tileOf(k).level != level || imagery.tiles[k].bytes == 0)
            continue;
        const auto at =
            static_cast<std::streamoff>(imagery.tiles[k].offset + imagery.tiles[k].bytes / 2);
        bytes.seekg(at);
        const char byte = static_cast<char>(~bytes.get());
        bytes.seekp(at);
        bytes.put(byte);
    }
    return path;
}

TEST_F(ImageryDraw, AnAncestorStandsInForATileThatCannotBeReadAndIsReported) {
    import(plain(193, 129, 10), 10, 1.25, pattern);
    const auto renderer = open(damagedCopy(*file_, 0));
    const Overhead view{{kWest + 512 * 1.25, kSouth + 512 * 1.25}, 0.625};
    const ChannelResult result = draw(*renderer, view.camera());
    EXPECT_FALSE(result.statistics.complete);
    EXPECT_EQ(result.statistics.pagesMissing, 4U);
    EXPECT_EQ(result.statistics.pagesFailed, 4U);
    EXPECT_LT(differenceFromOneImage(result, view, 1), kFilterTolerance);
}

/// Hard case 25, beside the tests of 64 : 1, 1 : 64 and borders above. A tile's texels need none of
/// their parents'; what has no texels of its own shows the parents' parents'. Expected is the one
/// image of a whole level, filtered in double precision.
TEST_F(HardCase25, TextureWithoutItsParentIsShownAndThatOfTheNextLevelStandsInForTheParent) {
    import(plain(197, 169, 10), 10, 1.25, pattern);
    const auto renderer = open(damagedCopy(*file_, 1));
    const Overhead fine{{kWest + 512 * 1.25, kSouth + 512 * 1.25}, 0.625};
    EXPECT_LT(differenceFromOneImage(draw(*renderer, fine.camera()), fine, 0), kFilterTolerance);
    const Overhead coarse{{kWest + 512 * 2.5, kSouth + 512 * 2.5}, 2.0};
    const ChannelResult result = draw(*renderer, coarse.camera());
    EXPECT_FALSE(result.statistics.complete);
    EXPECT_GT(result.statistics.pagesFailed, 0U);
    EXPECT_LT(differenceFromOneImage(result, coarse, 2), kFilterTolerance);
}

TEST_F(ImageryDraw, ComesToTheCompletePictureFrameByFrame) {
    import(plain(193, 129, 10), 10, 1.25, pattern);
    const Overhead view{{kWest + 960, kSouth + 640}, 1};
    const ChannelResult expected = draw(*open(file_->path()), view.camera());
    const auto renderer = open(file_->path());
    const ChannelResult first = draw(*renderer, view.camera(), Completeness::Interactive);
    EXPECT_FALSE(first.statistics.complete);
    EXPECT_GT(first.statistics.pagesMissing, 0U);
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    ChannelResult last = first;
    while (!last.statistics.complete && std::chrono::steady_clock::now() < end)
        last = draw(*renderer, view.camera(), Completeness::Interactive);
    EXPECT_TRUE(last.statistics.complete);
    EXPECT_EQ(last.statistics.pagesMissing, 0U);
    EXPECT_TRUE(last.image.colour == expected.image.colour);
}

/// Looking away from level ground, beside which the camera is: all pictures may be needed soon.
TEST_F(ImageryDraw, WhatMayBeNeededSoonIsThereWhenTheCameraTurns) {
    import(plain(193, 129, 10), 10, 1.25, pattern);
    const auto textures = static_cast<std::uint64_t>(std::ranges::count_if(
        file_->index().imagery->tiles, [](auto& tile) { return tile.bytes > 0; }));
    ASSERT_GT(textures, 8U);
    fabric::Camera camera;
    camera.eye = {kWest - 100, kSouth + 640, kGround + 200};
    camera.target = camera.eye - fabric::Vec3(1, 0, 0);
    camera.fovYDegrees = 10;
    const auto renderer = open(file_->path());
    std::uint64_t loaded = 1;  // the top one
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (loaded < textures && std::chrono::steady_clock::now() < end) {
        const ChannelResult away = draw(*renderer, camera, Completeness::Interactive);
        EXPECT_EQ(away.statistics.nodes, 0U);
        EXPECT_TRUE(away.statistics.complete);
        loaded += away.statistics.pagesLoaded;
    }
    EXPECT_EQ(loaded, textures);
    camera.target = camera.eye + fabric::Vec3(1, 0, -0.2);
    ChannelResult turned = draw(*renderer, camera, Completeness::Interactive);
    while (!turned.statistics.complete && std::chrono::steady_clock::now() < end) {
        EXPECT_EQ(turned.statistics.pagesLoaded, 0U);
        turned = draw(*renderer, camera, Completeness::Interactive);
    }
    EXPECT_EQ(turned.statistics.pagesLoaded, 0U);
    EXPECT_TRUE(turned.statistics.complete);
    EXPECT_TRUE(turned.image.colour == draw(*open(file_->path()), camera).image.colour);
}

/// Beside ground so far away that the finest level would not be drawn there.
TEST_F(ImageryDraw, PicturesFarAwayAreFetchedAsCoarseAsTheyWouldBeDrawn) {
    import(plain(193, 129, 10), 10, 1.25, pattern);
    const terrain::TexturePyramid& pyramid = file_->index().imagery->pyramid;
    const auto inLevels = [&](int first) {
        std::uint64_t count = 0;
        for (std::uint32_t i = 0; i < pyramid.tileCount(); ++i)
            count += pyramid.tileOf(i).level >= first && file_->index().imagery->tiles[i].bytes > 0
                         ? 1
                         : 0;
        return count;
    };
    fabric::Camera camera;
    // Texels of level 1 are 2.5 m: 1.1 pixels there, where up to 1.4 will do.
    camera.eye = {kWest - 4000, kSouth + 640, kGround + 10};
    camera.target = camera.eye - fabric::Vec3(1, 0, 0);
    camera.fovYDegrees = 360 / M_PI * std::atan(kHeight / 2.0 * 2.5 / 1.1 / 4000);
    const auto renderer = open(file_->path());
    std::uint64_t loaded = 1;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (loaded < inLevels(1) && std::chrono::steady_clock::now() < end)
        loaded += draw(*renderer, camera, Completeness::Interactive).statistics.pagesLoaded;
    for (int i = 0; i < 100; ++i)
        loaded += draw(*renderer, camera, Completeness::Interactive).statistics.pagesLoaded;
    EXPECT_EQ(loaded, inLevels(1));
    EXPECT_LT(inLevels(1), inLevels(0));
}

TEST_F(ImageryDraw, KeepsWithinTheDevicesMemoryByCoarserTexels) {
    import(plain(193, 129, 10), 10, 1.25, pattern);
    const Overhead view{{kWest + 960, kSouth + 640}, 1};
    const auto ample = open(file_->path());
    draw(*ample, view.camera());
    RendererOptions options;
    options.memoryBytes = ample->memory().deviceBytes / 2;
    const auto renderer = open(file_->path(), options);
    const ChannelResult result = draw(*renderer, view.camera());
    EXPECT_LE(renderer->memory().deviceBytes, options.memoryBytes);
    EXPECT_EQ(result.statistics.pagesMissing, 0U);
    EXPECT_EQ(std::count(result.image.colour.begin(), result.image.colour.end(), kBackground), 0);
}

/// Ranges are shares of triangles, but pictures are as large as their ground, and several channels
/// may need the same.
TEST_F(ImageryDraw, RangesKeepWithinTheDevicesMemoryByCoarserTexels) {
    terrain::HeightGrid grid = plain(385, 257, 10);
    for (std::int32_t j = 0; j < grid.rows; ++j)
        for (std::int32_t i = 0; i < grid.columns; ++i)
            grid.row(j)[i] += static_cast<float>(20 * std::sin(0.3 * i) * std::cos(0.37 * j) +
                                                 3 * std::sin(1.0 * i * j));
    import(grid, 10, 1.25, pattern);
    fabric::Camera camera;
    camera.eye = {kWest + 200, kSouth + 100, kGround + 400};
    camera.target = {kWest + 1900, kSouth + 1300, kGround};
    const auto ample = open(file_->path());
    const std::uint64_t top = ample->memory().deviceBytes;
    draw(*ample, camera);
    const std::uint64_t all = ample->memory().deviceBytes;
    for (int share = 1; share <= 20; ++share) {
        RendererOptions options;
        options.decoding = TileDecoding::Cpu;
        options.memoryBytes = top + (all - top) * static_cast<std::uint64_t>(share) / 32;
        const auto renderer = open(file_->path(), options);
        for (const double first : {0.0, 0.25, 0.5, 0.75}) {
            const auto drawn = [&](Completeness completeness) {
                return draw(*renderer, camera, completeness, {0, 0, kWidth, kHeight},
                            {first, first + 0.25})
                    .statistics;
            };
            const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
            fabric::FrameStatistics rest = drawn(Completeness::Interactive);
            while (!rest.complete && std::chrono::steady_clock::now() < end)
                rest = drawn(Completeness::Interactive);
            EXPECT_TRUE(rest.complete) << share << "/32, from " << first;
            const fabric::FrameStatistics still = drawn(Completeness::Complete);
            EXPECT_EQ(still.pagesMissing, 0U) << share << "/32, from " << first;
            EXPECT_LE(still.tauAchievedPixels, rest.tauAchievedPixels);
            EXPECT_LE(renderer->memory().deviceBytes, options.memoryBytes);
        }
    }
}

/// A tile of which the frozen camera sees some is drawn whole.
TEST_F(ImageryDraw, AFrozenCutHasTheGroundThatItHasWithoutPictures) {
    const terrain::HeightGrid grid = plain(385, 257, 10);
    import(grid, 10, 1.25, pattern);
    const test::TemporaryFolder folder;
    const auto bare = test::importedWith(grid, {}, folder);
    ASSERT_TRUE(bare.ok()) << bare.status();
    const Overhead frozen{{kWest + 600, kSouth + 500}, 1};
    const Overhead whole{{kWest + 1920, kSouth + 1280}, 8};
    const auto ground = [&](const std::string& path) {
        const ChannelResult drawn =
            draw(*open(path), whole.camera(), Completeness::Complete, {0, 0, kWidth, kHeight}, {},
                 {.cutCamera = frozen.camera()});
        const auto& pixels = drawn.image.colour;
        return std::ssize(pixels) - std::count(pixels.begin(), pixels.end(), kBackground);
    };
    EXPECT_GT(ground(file_->path()), 480 * 320 * 9 / 10);
    EXPECT_EQ(ground(file_->path()), ground((*bare)->path()));
}

/// The eye is within the terrain's box, where no finite error is promised.
TEST_F(ImageryDraw, ShowsTheTopPictureWhereMemoryHoldsNoOther) {
    terrain::HeightGrid grid = plain(193, 129, 10);
    for (std::int32_t j = 0; j < grid.rows; ++j)
        for (std::int32_t i = 0; i < grid.columns; ++i) grid.row(j)[i] += static_cast<float>(i);
    import(grid, 10, 1.25, pattern);
    fabric::Camera camera;
    camera.eye = file_->index().bounds().centre() + fabric::Vec3(0, 0, 30);
    camera.target = camera.eye + fabric::Vec3(100, 0, -20);
    RendererOptions options;
    options.memoryBytes = open(file_->path())->memory().deviceBytes + 1000;  // of the top's
    const auto renderer = open(file_->path(), options);
    const ChannelResult result = draw(*renderer, camera);
    EXPECT_TRUE(result.statistics.complete);
    EXPECT_EQ(result.statistics.nodes, 1U);
    EXPECT_LE(renderer->memory().deviceBytes, options.memoryBytes);
}

}  // namespace eyrie
}  // namespace eyrie
