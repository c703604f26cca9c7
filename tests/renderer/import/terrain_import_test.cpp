// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/terrain_import.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "renderer/import/geotiff_writer.h"
#include "renderer/import/terrain_synth.h"
#include "tests/renderer/import/terrain_fixture.h"
#include "tests/renderer/terrain/hard_grids.h"

namespace eyrie::import {
namespace {

using test::contents;
using test::GridKind;
using test::readDem;
using test::TemporaryFolder;

TEST(TerrainSynth, IsTheSameForASeedWhateverTheSize) {
    const terrain::HeightGrid small = synthesizeTerrain(70, 5);
    const terrain::HeightGrid large = synthesizeTerrain(300, 5);
    for (std::int32_t j = 0; j < small.rows; ++j)
        for (std::int32_t i = 0; i < small.columns; ++i) ASSERT_EQ(small.at(i, j), large.at(i, j));
    EXPECT_NE(synthesizeTerrain(70, 6).heights, small.heights);
}

TEST(TerrainSynth, ComesBackFromItsGeoTiffUnchanged) {
    const TemporaryFolder folder;
    terrain::HeightGrid grid = synthesizeTerrain(130, 1);
    grid.row(3)[4] = terrain::kNodata;
    ASSERT_TRUE(writeGeoTiff(grid, folder.path("a.tif")).ok());
    const auto dem = readDem(folder.path("a.tif"));
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_EQ(dem->grid.origin, grid.origin);
    EXPECT_EQ(dem->grid.perColumn, grid.perColumn);
    EXPECT_EQ(dem->grid.perRow, grid.perRow);
    EXPECT_NE(dem->crsWkt.find("UTM zone 33N"), std::string::npos);
    EXPECT_TRUE(std::isnan(dem->grid.at(4, 3)));
    grid.row(3)[4] = 0;
    terrain::HeightGrid read = dem->grid;
    read.row(3)[4] = 0;
    EXPECT_EQ(read.heights, grid.heights);
    EXPECT_EQ(folder.files().size(), 1U);
}

TEST(TerrainImport, MakesTheSameBytesEachTime) {
    const TemporaryFolder folder;
    const terrain::HeightGrid grid = test::hardGrid(GridKind::Smooth, 700, 300, 1);
    ASSERT_TRUE(importTerrain(grid, {"grid", "", 1}, folder.path("a.eyt"), {}).ok());
    ASSERT_TRUE(importTerrain(grid, {"grid", "", 1}, folder.path("b.eyt"), {}).ok());
    EXPECT_EQ(contents(folder.path("a.eyt")), contents(folder.path("b.eyt")));
}

TEST(TerrainImport, ReportsWhatTheFileSays) {
    const TemporaryFolder folder;
    const std::string tif = folder.path("a.tif");
    ASSERT_TRUE(writeGeoTiff(synthesizeTerrain(200, 3), tif).ok());
    std::map<std::string, double> progress;
    ImportControl control;
    control.progress = [&](std::string_view stage, double fraction) {
        double& last = progress[std::string(stage)];
        EXPECT_GE(fraction, last);
        last = fraction;
    };
    const auto report = importTerrain({tif}, folder.path("a.eyt"), {}, control);
    ASSERT_TRUE(report.ok()) << report.status();
    for (const char* stage : {"reading", "measuring", "building"})
        EXPECT_EQ(progress[stage], 1) << stage;
    const auto file = terrain::EytFile::open(folder.path("a.eyt"));
    ASSERT_TRUE(file.ok()) << file.status();
    const terrain::EytIndex& index = (*file)->index();
    EXPECT_EQ(report->columns, 200);
    EXPECT_EQ(report->levels, index.quadtree.levels());
    EXPECT_EQ(report->triangles, index.triangles());
    EXPECT_EQ(report->sizeBytes, (*file)->sizeBytes());
    EXPECT_EQ(report->coarsestErrorMetres, index.coarsestErrorMetres());
    EXPECT_NE(index.sourceHash, 0U);
    EXPECT_NE(index.crsWkt.find("UTM zone 33N"), std::string::npos);
    EXPECT_EQ(index.bounds().min.x, 500000);
    EXPECT_EQ(index.bounds().max.y, 5200000 + 199 * 30);
}

TEST(TerrainImport, SaysWhatHeightsThatAreNoneDoToTheOthers) {
    const TemporaryFolder folder;
    terrain::HeightGrid grid = synthesizeTerrain(40, 1);
    const auto notes = [&] {
        const auto report = importTerrain(grid, {"grid", "", 0}, folder.path("t.eyt"), {});
        return report.ok() ? report->notes : std::vector{report.status().ToString()};
    };
    EXPECT_THAT(notes(), testing::IsEmpty());
    grid.heights[820] = -9999;
    EXPECT_THAT(notes(), testing::ElementsAre(testing::HasSubstr("-a_nodata -9999)")));
    grid.heights[820] = 1e12F;
    EXPECT_THAT(notes(), testing::ElementsAre(testing::HasSubstr("steps of 131072 m")));
}

TEST(TerrainImport, SaysWhatItCannotKeepOfWhatWasAsked) {
    const TemporaryFolder folder;
    const terrain::HeightGrid grid = synthesizeTerrain(40, 1);  // 30 m apart: steps of 1/64 m
    const auto notes = [&](const TerrainImportOptions& options) {
        GridHeightSource posts(grid);
        const auto report =
            importTerrain(posts, {"grid", "", 0}, folder.path("t.eyt"), options, {});
        return report.ok() ? report->notes : std::vector{report.status().ToString()};
    };
    EXPECT_THAT(notes({.errorMetres = 0.012}), testing::IsEmpty());
    EXPECT_THAT(notes({.errorMetres = 0.005}),
                testing::ElementsAre(testing::HasSubstr("off by 0.01172 m, not by 0.005 m")));
    EXPECT_THAT(notes({.memoryBytes = kLeastImportMemory}), testing::IsEmpty());
    EXPECT_THAT(notes({.memoryBytes = std::uint64_t{100} << 20}),
                testing::ElementsAre(testing::HasSubstr("about 164 MB of memory, not 100 MB")));
}

/// GDAL keeps the threads that it warps with: an import that warps must leave no more than one that
/// does not.
TEST(TerrainImport, WarpsWithNoMoreThreadsThanItMay) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");  // a process that has none of other tests
    EXPECT_EXIT(
        {
            const TemporaryFolder folder;
            std::ofstream(folder.path("a.asc"))
                << "ncols 4\nnrows 3\nxllcorner 9\nyllcorner 47\ncellsize 0.001\n"
                   "1 2 3 4\n5 6 7 8\n9 10 11 12\n";
            const auto threadsAfterImport = [&] {
                const auto report =
                    importTerrain({folder.path("a.asc")}, folder.path("t.eyt"), {.threads = 1}, {});
                std::cerr << report.status() << "\n";
                return std::distance(std::filesystem::directory_iterator("/proc/self/task"), {});
            };
            const auto asItIs = threadsAfterImport();
            std::ofstream(folder.path("a.prj"))
                << R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],)"
                   R"(PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]])";
            const auto warped = threadsAfterImport();
            std::cerr << asItIs << " threads, then " << warped;
            std::exit(warped == asItIs ? 0 : 1);
        },
        testing::ExitedWithCode(0), "OK\nOK\n");
}

TEST(TerrainImport, LeavesNothingBehindWhenCalledOff) {
    const TemporaryFolder folder;
    const terrain::HeightGrid grid = synthesizeTerrain(600, 3);
    for (const char* stage : {"measuring", "building"}) {
        std::stop_source stop;
        ImportControl control;
        control.stop = stop.get_token();
        control.progress = [&](std::string_view reached, double) {
            if (reached == stage)
                stop.request_stop();
        };
        const auto report = importTerrain(grid, {"grid", "", 0}, folder.path("a.eyt"), control);
        EXPECT_EQ(report.status().code(), absl::StatusCode::kCancelled) << stage;
        EXPECT_TRUE(folder.files().empty()) << stage;
    }
}

TEST(TerrainImport, NamesTheFolderThatIsMissing) {
    const TemporaryFolder folder;
    const auto grid = test::hardGrid(GridKind::Flat, 5, 5, 0);
    const auto report = importTerrain(grid, {"grid", "", 0}, folder.path("no/where.eyt"), {});
    EXPECT_EQ(report.status().code(), absl::StatusCode::kNotFound);
    EXPECT_NE(report.status().ToString().find("no/where.eyt"), std::string::npos);
    EXPECT_FALSE(writeGeoTiff(grid, folder.path("no/where.tif")).ok());
    EXPECT_TRUE(folder.files().empty());
}

TEST(TerrainImport, TakesThePlaceOfNoPipe) {
    const TemporaryFolder folder;
    const terrain::HeightGrid grid = test::hardGrid(GridKind::Smooth, 130, 130, 1);
    for (const char* name : {"a.eyt", "a.tif"})
        ASSERT_EQ(::mkfifo(folder.path(name).c_str(), 0600), 0);
    const auto report = importTerrain(grid, {"grid", "", 0}, folder.path("a.eyt"), {});
    EXPECT_TRUE(absl::IsInvalidArgument(report.status())) << report.status();
    EXPECT_TRUE(absl::IsInvalidArgument(writeGeoTiff(grid, folder.path("a.tif"))));
    EXPECT_TRUE(std::filesystem::is_fifo(folder.path("a.eyt")));
    EXPECT_TRUE(std::filesystem::is_fifo(folder.path("a.tif")));
    EXPECT_EQ(folder.files().size(), 2U);
}

TEST(TerrainImport, RefusesAGridWithoutAnyDataOrTriangle) {
    const TemporaryFolder folder;
    terrain::HeightGrid grid = test::hardGrid(GridKind::Noise, 40, 30, 0);
    std::fill(grid.heights.begin(), grid.heights.end(), terrain::kNodata);
    const auto none = importTerrain(grid, {"a.tif", "", 0}, folder.path("a.eyt"), {});
    EXPECT_EQ(none.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_NE(none.status().ToString().find("a.tif: all posts are nodata"), std::string::npos);
    grid.row(3)[4] = grid.row(3)[5] = 7;
    const auto two = importTerrain(grid, {"a.tif", "", 0}, folder.path("a.eyt"), {});
    EXPECT_EQ(two.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(two.status().ToString(),
                testing::HasSubstr("a.tif: 2 of 1200 posts have data, but no triangle"));
    grid.row(3)[5] = terrain::kNodata;
    grid.row(4)[4] = grid.row(4)[5] = 7;  // a half of a cell that is split the other way
    const auto three = importTerrain(grid, {"a.tif", "", 0}, folder.path("a.eyt"), {});
    EXPECT_THAT(three.status().ToString(), testing::HasSubstr("3 of 1200 posts have data, but"));
    EXPECT_TRUE(folder.files().empty());
}

/// Level 0 may leave out what the others may not.
TEST(TerrainImport, SaysWhyThereAreNoData) {
    const TemporaryFolder folder;
    terrain::HeightGrid grid = synthesizeTerrain(40, 1);
    std::ranges::fill(grid.heights, 1e30F);
    ASSERT_TRUE(writeGeoTiff(grid, folder.path("all.tif")).ok());
    const auto report = importTerrain({folder.path("all.tif")}, folder.path("t.eyt"), {}, {});
    EXPECT_EQ(report.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(
        std::string(report.status().message()),
        testing::AllOf(testing::HasSubstr("nodata"), testing::HasSubstr("1e+30 in column 0")));
}

TEST(TerrainImport, KeepsTheErrorAskedForAtTheFinestLevel) {
    for (const double asked : {0.5, 3.0, 40.0}) {
        const TemporaryFolder folder;
        const terrain::HeightGrid grid = synthesizeTerrain(300, 6);
        GridHeightSource posts(grid);
        const auto report =
            importTerrain(posts, {"grid", "", 0}, folder.path("a.eyt"), {.errorMetres = asked}, {});
        ASSERT_TRUE(report.ok()) << report.status();
        EXPECT_LE(report->finestErrorMetres, asked);
        EXPECT_GT(report->finestErrorMetres, asked / 4) << "less was left out than might be";
    }
}

TEST(HeightLattice, IsOfWholeMetresForWholeMetresAndFineEnoughOtherwise) {
    const auto latticeOf = [](float min, float max, bool integers, double post) {
        return terrain::chooseHeightLattice({min, max, 0, integers}, post);
    };
    EXPECT_EQ(latticeOf(-11034, 8849, true, 90).stepMetres, 1);
    EXPECT_TRUE(latticeOf(-11034, 8849, true, 90).isLossless);
    EXPECT_EQ(latticeOf(0, 100, false, 30).stepMetres, 1.0 / 64);
    EXPECT_EQ(latticeOf(0, 100, false, 90).stepMetres, 1.0 / 64);
    EXPECT_EQ(latticeOf(0, 100, false, 1000).stepMetres, 1.0 / 16);
    EXPECT_EQ(latticeOf(0, 100, false, 1e5).stepMetres, 1.0 / 16);
    EXPECT_EQ(latticeOf(0, 100, false, 1).stepMetres, 1.0 / 256);
    EXPECT_LT(9.0e6 / latticeOf(0, 9.0e6F, true, 90).stepMetres, 1 << 23);
    EXPECT_LT(9000 / latticeOf(0, 9000, false, 0.01).stepMetres, 1 << 23);
}

}  // namespace
}  // namespace eyrie::import
