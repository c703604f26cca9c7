// SPDX-License-Identifier: Apache-2.0
// What becomes of pictures in a file.
#include "tests/renderer/import/imagery_import.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "renderer/import/shard_part.h"
#include "renderer/import/terrain_import.h"
#include "renderer/import/terrain_shard.h"

namespace eyrie::import {
namespace {

using fabric::Rgba;
using terrain::TexturePyramid;
using test::kSouth;
using test::kWest;
using test::Picture;
using testing::HasSubstr;

TEST_F(ImageryImport, LeavesHolesWhereNoPictureHasAPixel) {
    const auto colour = [](double x, double y) {
        return x < kWest + 480 || y > kSouth + 320 ? Rgba{0, 0, 0, 0} : Rgba{60, 160, 90, 255};
    };
    const auto file = imported(test::slope(97, 65, 10), {write(over(960, 640, 10, colour))});
    ASSERT_NE(file, nullptr);
    expectColours(*file, 10, colour);
    EXPECT_EQ(file->index().imagery->coveredTexels, 48U * 32U);
}

TEST_F(ImageryImport, StoresNothingOfTilesWithoutAPixel) {
    Picture picture = over(0, 0, 1, [](double, double) { return Rgba{60, 160, 90, 255}; });
    picture.west = kWest;
    picture.north = kSouth + 100;
    picture.columns = picture.rows = 100;
    const auto file = imported(test::slope(120, 120, 10), {write(picture)});
    ASSERT_NE(file, nullptr);
    const terrain::ImageryIndex& imagery = *file->index().imagery;
    ASSERT_GE(imagery.pyramid.tilesX(0), 3);
    EXPECT_TRUE(imagery.has({0, 0, 0}));
    EXPECT_FALSE(imagery.has({0, 1, 0}));
    EXPECT_TRUE(imagery.has(imagery.pyramid.top()));
    const test::TexelImage coarsest = test::wholeLevel(*file, imagery.pyramid.levels() - 1);
    EXPECT_EQ(coarsest.at(0, 0).a, 255);
    EXPECT_EQ(coarsest.at(coarsest.width - 1, coarsest.height - 1).a, 0);
}

TEST_F(ImageryImport, TakesTheFinestAndThenTheLastPicture) {
    const auto filled = [](Rgba colour) { return [=](double, double) { return colour; }; };
    const Rgba red{200, 0, 0, 255};
    const Rgba green{0, 200, 0, 255};
    const Rgba blue{0, 0, 200, 255};
    Picture coarse = over(960, 640, 20, filled(red));
    Picture first = over(960, 640, 10, filled(green));
    first.columns = 68;  // to x = 640
    Picture last = over(960, 640, 10, filled(blue));
    last.columns = 36;  // to x = 320
    const auto file =
        imported(test::slope(97, 65, 10),
                 {write(first, "a.tif"), write(last, "b.tif"), write(coarse, "c.tif")});
    ASSERT_NE(file, nullptr);
    expectColours(*file, 10, [&](double x, double) {
        return x < kWest + 320 ? blue : x < kWest + 640 ? green : red;
    });
}

/// Each is within 1 % of the next, the coarsest 2 % coarser than the finest.
TEST_F(ImageryImport, TakesOneOfTheFinestOfManyNearlyEqualPictures) {
    std::vector<std::string> paths;
    std::vector<double> pixels;
    for (int k = 0; k < 5; ++k) pixels.push_back(10 * std::pow(0.995, 4 - k));
    for (std::size_t k = 0; k < pixels.size(); ++k) {
        const auto grey = static_cast<std::uint8_t>(40 + 30 * k);
        paths.push_back(write(over(300, 300, pixels[k],
                                   [=](double, double) {
                                       return Rgba{grey, grey, grey, 255};
                                   }),
                              fmt::format("{}.tif", k)));
    }
    const auto file = imported(test::slope(30, 30, 10), paths);
    ASSERT_NE(file, nullptr);
    expectColours(*file, 10, [](double, double) { return Rgba{100, 100, 100, 255}; });
}

TEST_F(ImageryImport, OfHolesAloneIsAnError) {
    for (const std::uint8_t alpha : {std::uint8_t{0}, std::uint8_t{120}}) {
        const auto holes = [=](double, double) { return Rgba{1, 2, 3, alpha}; };
        const absl::Status status =
            importError(test::slope(11, 11, 10), {write(over(100, 100, 10, holes))});
        EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
        EXPECT_THAT(status.ToString(), HasSubstr("no picture has a pixel (alpha below half"));
        EXPECT_THAT(folder_.files(), testing::Not(testing::Contains(HasSubstr("with.eyt"))));
    }
}

/// The blocks beyond a tile's sides are its neighbours' own, so filtering sees no border.
TEST_F(ImageryImport, TilesHaveTheirNeighboursBlocksAsBorder) {
    std::uint32_t state = 1;
    const auto noise = [&state](double, double) {
        state = state * 1664525 + 1013904223;
        return Rgba{static_cast<std::uint8_t>(state >> 24), static_cast<std::uint8_t>(state >> 16),
                    static_cast<std::uint8_t>(state >> 8), 255};
    };
    const auto file = imported(test::slope(151, 141, 10), {write(over(1500, 1400, 1.25, noise))});
    ASSERT_NE(file, nullptr);
    const TexturePyramid& pyramid = file->index().imagery->pyramid;
    ASSERT_GE(pyramid.levels(), 3);
    for (int level = 0; level < pyramid.levels() - 1; ++level)
        for (std::int32_t y = 0; y < pyramid.tilesY(level); ++y)
            for (std::int32_t x = 0; x + 1 < pyramid.tilesX(level); ++x) {
                const auto left = *file->readTexture({level, x, y});
                const auto right = *file->readTexture({level, x + 1, y});
                for (std::int32_t row = 0; row < left->blocksY(); ++row) {
                    const auto l =
                        left->blocks().subspan(static_cast<std::size_t>(row * left->blocksX()),
                                               static_cast<std::size_t>(left->blocksX()));
                    const auto r =
                        right->blocks().subspan(static_cast<std::size_t>(row * right->blocksX()),
                                                static_cast<std::size_t>(right->blocksX()));
                    ASSERT_EQ(l.back(), r[1]) << level << ' ' << x << ' ' << y << ' ' << row;
                    ASSERT_EQ(l[l.size() - 2], r[0]) << level << ' ' << x << ' ' << y << ' ' << row;
                }
            }
}

/// Each coarser level is the mean of the one below, in linear light, but for BC1.
TEST_F(ImageryImport, CoarserLevelsAreMeansOfFinerOnes) {
    const auto file =
        imported(test::slope(111, 101, 10), {write(over(1100, 1000, 1.25, waves(1200)))});
    ASSERT_NE(file, nullptr);
    ASSERT_EQ(file->index().imagery->pyramid.levels(), 2);
    const test::TexelImage fine = test::wholeLevel(*file, 0);
    const test::TexelImage coarse = test::wholeLevel(*file, 1);
    EXPECT_EQ(coarse.width, (fine.width + 1) / 2);
    const auto linear = [](int byte) { return std::pow(byte / 255.0, 2.2); };
    for (std::int64_t y = 0; y + 1 < coarse.height; ++y)
        for (std::int64_t x = 0; x + 1 < coarse.width; ++x) {
            double sum = 0;
            for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}})
                sum += linear(fine.at(2 * x + u, 2 * y + v).r);
            EXPECT_NEAR(255 * std::pow(sum / 4, 1 / 2.2), coarse.at(x, y).r, kTolerance)
                << x << ' ' << y;
        }
}

TEST_F(ImageryImport, GivesTheSameBytesWhateverTheMemoryAndThreads) {
    const std::string path = write(over(1500, 1400, 1.25, waves(170)));
    const terrain::HeightGrid grid = test::slope(151, 141, 10);
    ASSERT_NE(imported(grid, {path}), nullptr);
    const std::string whole = test::contents(folder_.path("with.eyt"));
    ASSERT_TRUE(test::importedWith(grid, {path}, folder_, {.memoryBytes = 1, .threads = 1}).ok());
    EXPECT_TRUE(test::contents(folder_.path("with.eyt")) == whole);
    EXPECT_THAT(folder_.files(), testing::Not(testing::Contains(HasSubstr("scratch"))));
}

TEST_F(ImageryImport, CalledOffLeavesNoFileAndGoesOnLater) {
    const std::string dem = folder_.path("dem.tif");
    const std::string out = folder_.path("out.eyt");
    ASSERT_NE(imported(test::slope(800, 700, 2), {}), nullptr);  // writes the DEM
    const TerrainImportOptions how{.memoryBytes = 1,
                                   .imagery = {write(over(1598, 1398, 1, waves(170)))}};
    std::stop_source stop;
    ImportControl control{[&](std::string_view stage, double fraction) {
                              if (stage == "imagery" && fraction > 0.3)
                                  stop.request_stop();
                          },
                          stop.get_token()};
    EXPECT_EQ(importTerrain({dem}, out, how, control).status().code(),
              absl::StatusCode::kCancelled);
    EXPECT_THAT(folder_.files(), testing::Not(testing::Contains("out.eyt")));
    std::vector<std::string> stages;
    control = {[&](std::string_view stage, double) {
                   if (stages.empty() || stages.back() != stage)
                       stages.emplace_back(stage);
               },
               {}};
    ASSERT_TRUE(importTerrain({dem}, out, how, control).ok());
    EXPECT_THAT(stages, testing::ElementsAre("checking", "imagery"));
    EXPECT_TRUE(terrain::EytFile::open(out).ok());
    EXPECT_THAT(folder_.files(), testing::Not(testing::Contains(HasSubstr("partial"))));
}

/// Of 1024 tiles.
class ImageryOfASmallPart : public ImageryImport {
protected:
    static constexpr double kExtent = 256 * 64;

    std::string writeSmall(double west, double south) {
        Picture picture = over(0, 0, 1, [](double, double) { return Rgba{60, 160, 90, 255}; });
        picture.west = kWest + west;
        picture.north = kSouth + south + 100;
        picture.columns = picture.rows = 100;
        return write(picture);
    }

    static terrain::HeightGrid grid() { return test::slope(257, 257, 64); }
};

TEST_F(ImageryOfASmallPart, TakesLittleScratch) {
    ASSERT_NE(imported(grid(), {}), nullptr);  // writes the DEM
    const std::string out = folder_.path("out.eyt");
    std::int64_t most = 0;
    const ImportControl control{[&](std::string_view, double) {
                                    struct stat status {};
                                    if (stat((out + ".scratch").c_str(), &status) == 0)
                                        most = std::max(most, std::int64_t{status.st_blocks} * 512);
                                },
                                {}};
    const TerrainImportOptions how{.memoryBytes = 1, .imagery = {writeSmall(0, 0)}};
    ASSERT_TRUE(importTerrain({folder_.path("dem.tif")}, out, how, control).ok());
    EXPECT_GT(most, 0);
    EXPECT_LT(most, 4 << 20);
}

TEST_F(ImageryOfASmallPart, TakesLittleOfAShardsPart) {
    TerrainImportOptions how{.imagery = {writeSmall(0, 0)}};
    const auto file = test::importedWith(grid(), how.imagery, folder_);
    ASSERT_TRUE(file.ok()) << file.status();
    const std::string out = folder_.path("out.eyt");
    ASSERT_TRUE(importTerrainShard({folder_.path("dem.tif")}, out, {0, 1}, how, {}).ok());
    EXPECT_LT(std::filesystem::file_size(partPath(out, {0, 1})), 4U << 20);
    how.mergesParts = true;
    ASSERT_TRUE(importTerrain({folder_.path("dem.tif")}, out, how, {}).ok());
    EXPECT_TRUE(test::contents(out) == test::contents(folder_.path("with.eyt")));
}

TEST_F(ImageryOfASmallPart, TakesNothingFromTheScratchOfAnother) {
    const auto east = test::importedWith(grid(), {writeSmall(kExtent - 200, 0)}, folder_);
    ASSERT_TRUE(east.ok()) << east.status();
    const std::string whole = test::contents(folder_.path("with.eyt"));
    const std::string out = folder_.path("out.eyt");
    TerrainImportOptions how{.memoryBytes = 1, .imagery = {writeSmall(0, kExtent - 200)}};
    std::stop_source stop;
    const ImportControl control{[&](std::string_view stage, double fraction) {
                                    if (stage == "imagery" && fraction > 0.95)
                                        stop.request_stop();
                                },
                                stop.get_token()};
    ASSERT_EQ(importTerrain({folder_.path("dem.tif")}, out, how, control).status().code(),
              absl::StatusCode::kCancelled);
    writeSmall(kExtent - 200, 0);
    ASSERT_TRUE(importTerrain({folder_.path("dem.tif")}, out, how, {}).ok());
    EXPECT_TRUE(test::contents(out) == whole);
}

TEST_F(ImageryImport, DamagedTilesAreDataLoss) {
    ASSERT_NE(imported(test::slope(90, 70, 10), {write(over(890, 690, 10, waves(1200)))}), nullptr);
    const std::string path = folder_.path("with.eyt");
    const auto file = *terrain::EytFile::open(path);
    const terrain::PageRecord record = file->index().imagery->tiles[0];
    ASSERT_GT(record.bytes, 0U);
    std::fstream bytes(path, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(record.offset + record.bytes / 2));
    bytes.put('\x5a');
    bytes.close();
    const auto damaged = *terrain::EytFile::open(path);
    const auto page = damaged->readTexture({0, 0, 0});
    EXPECT_EQ(page.status().code(), absl::StatusCode::kDataLoss);
    EXPECT_THAT(page.status().ToString(), HasSubstr("texture tile 0/0/0"));
}

}  // namespace
}  // namespace eyrie::import
