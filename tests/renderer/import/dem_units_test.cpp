// SPDX-License-Identifier: Apache-2.0
// Rasters whose heights are in units and above datums of their own, as one terrain in metres.
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/terrain_import.h"
#include "renderer/terrain/eyt_format.h"
#include "tests/renderer/import/dem_mosaic_fixture.h"

namespace eyrie::import {
namespace {

using test::DemMosaic;
using testing::HasSubstr;

TEST_F(DemMosaic, TurnsEachRastersOwnUnitToMetres) {
    const std::string metres = write({.west = 500000, .north = 5200100, .height = constant(100)});
    const std::string feet =
        write({.west = 500100, .north = 5200100, .height = constant(1000), .unit = "ft"});
    const std::string scaled =
        write({.west = 500200, .north = 5200100, .height = constant(7), .scale = 3});
    const auto dem = test::readDems({metres, feet, scaled});
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_FLOAT_EQ(dem->grid.at(5, 5), 100);
    EXPECT_FLOAT_EQ(dem->grid.at(15, 5), 304.8F);
    EXPECT_FLOAT_EQ(dem->grid.at(25, 5), 21);
}

/// As of the Moon, whose heights are kept as distances from its middle.
TEST_F(DemMosaic, HasTheFloatsNearestToHeightsOf64Bits) {
    const auto height = [](double x, double) { return (x - 500000) / 30; };
    const auto dem =
        test::readDem(write({.west = 500000,
                             .north = 5200100,
                             .height = [&](double x, double y) { return 1737400 + height(x, y); },
                             .offset = -1737400,
                             .isDouble = true}));
    ASSERT_TRUE(dem.ok()) << dem.status();
    for (std::int32_t i = 0; i < 10; ++i)
        EXPECT_NEAR(dem->grid.at(i, 3), height(500005 + 10 * i, 0), 1e-6) << i;
}

TEST_F(DemMosaic, CountsWhatFloatsRoundAsErrors) {
    const auto errorOf = [&](const test::Raster& raster) {
        const std::string out = folder_.path("dem.eyt");
        EXPECT_TRUE(importTerrain({write(raster)}, out, {}, {}).ok());
        const auto file = terrain::EytFile::open(out);
        EXPECT_TRUE(file.ok()) << file.status();
        return double{(*file)->index().tile({0, 0, 0}).errorMetres};
    };
    const test::Raster metres{.west = 500000, .north = 5200100, .height = constant(4234)};
    EXPECT_EQ(errorOf(metres), 0);
    test::Raster feet = metres;
    feet.unit = "ft";
    feet.height = constant(13891);  // 4233.9768 m, of which the nearest float is 0.0001 off
    test::Raster wide = metres;
    wide.height = constant(4233.9768);
    wide.isDouble = true;
    for (const test::Raster& raster : {feet, wide}) {
        const double off = std::abs(4233.9768 - std::round(4233.9768 * 64) / 64);
        EXPECT_GE(errorOf(raster), off);
        EXPECT_LE(errorOf(raster), off + 0.0006);
    }
}

TEST_F(DemMosaic, KnowsUnitsHoweverTheyAreWritten) {
    const std::pair<const char*, float> units[] = {{"Feet ", 304.8F},
                                                   {"foot (International)", 304.8F},
                                                   {"International feet", 304.8F},
                                                   {"US survey feet", 304.8006F},
                                                   {"US_survey_foot", 304.8006F},
                                                   {"kilometers", 1.0e6F},
                                                   {"Decimetre", 100},
                                                   {"METERS", 1000}};
    for (const auto& [unit, metres] : units) {
        const auto dem = test::readDems(
            {write({.west = 500100, .north = 5200100, .height = constant(1000), .unit = unit})});
        ASSERT_TRUE(dem.ok()) << dem.status();
        EXPECT_NEAR(dem->grid.at(5, 5), metres, 1e-3) << unit;
        EXPECT_THAT(dem->notes, testing::Not(testing::Contains(HasSubstr("unknown")))) << unit;
    }
    const auto seconds = test::readDems(
        {write({.west = 500100, .north = 5200100, .height = constant(1000), .unit = "s"})});
    ASSERT_TRUE(seconds.ok()) << seconds.status();
    EXPECT_THAT(seconds->notes, testing::Contains(HasSubstr("height unit 's' is unknown")));
}

constexpr double kFeetPerMetre = 3937.0 / 1200;  // of US survey feet, EPSG:6360's

TEST_F(DemMosaic, HeightsInFeetByTheirCrsAreMetresAfterAReprojectionToo) {
    const std::string degrees = write({.crs = "EPSG:4269+6360",
                                       .west = -123,
                                       .north = 47,
                                       .pixel = 0.001,
                                       .columns = 20,
                                       .rows = 20,
                                       .height = constant(100 * kFeetPerMetre)});
    const auto dem = test::readDems({degrees});
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_NEAR(dem->grid.at(dem->grid.columns / 2, dem->grid.rows / 2), 100, 1e-3);
    EXPECT_THAT(dem->notes, testing::Contains(HasSubstr("US survey foot")));
}

TEST_F(DemMosaic, JoinsHeightsInFeetByTheirCrsToThoseInMetres) {
    const std::string metres = write(
        {.crs = "EPSG:26910+5703", .west = 500000, .north = 5200100, .height = constant(100)});
    for (const double pixel : {10, 11}) {  // on the grid of the other, and resampled
        const std::string feet = write({.crs = "EPSG:26910+6360",
                                        .west = 500100,
                                        .north = 5200100,
                                        .pixel = pixel,
                                        .height = constant(100 * kFeetPerMetre)});
        const auto dem = test::readDems({metres, feet});
        ASSERT_TRUE(dem.ok()) << dem.status();
        EXPECT_GE(dem->grid.columns, 20);
        for (std::int32_t i = 0; i < 20; ++i) EXPECT_NEAR(dem->grid.at(i, 5), 100, 1e-3) << i;
        EXPECT_THAT(dem->notes, testing::Not(testing::Contains(HasSubstr("vertical datum"))));
    }
}

/// ENVI keeps the CRS, but has no place for a band's unit.
TEST_F(DemMosaic, TakesTheUnitOfHeightsFromTheCrsWhereTheBandHasNone) {
    const std::string path = write({.crs = "EPSG:26910+6360",
                                    .driver = "ENVI",
                                    .west = 500000,
                                    .north = 5200100,
                                    .height = constant(100 * kFeetPerMetre)});
    const auto dem = test::readDems({path});
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_NEAR(dem->grid.at(5, 5), 100, 1e-3);
    EXPECT_THAT(dem->notes, testing::Contains(HasSubstr("vertical unit of its CRS")));
}

/// The finest one's CRS is in feet, and the others are on no grid of its, of its CRS or of one in
/// metres. Heights tell where a post is, in metres of the CRS in feet.
TEST_F(DemMosaic, BringsOthersToAGridInFeet) {
    const char* const kFeet = "EPSG:2263";
    const char* const kMetres = "EPSG:32118";  // the same projection
    const auto ramp = [](double x, double y) { return (x - 300000) / 10 + (y - 60000) / 20; };
    const auto rampInFeet = [&](double x, double y) {
        return ramp(x / kFeetPerMetre, y / kFeetPerMetre);
    };
    const std::string fine = write({.crs = kFeet,
                                    .west = 1'000'000,
                                    .north = 200'000,
                                    .pixel = 20,
                                    .columns = 50,
                                    .rows = 50,
                                    .height = rampInFeet});
    const std::string inFeet = write({.crs = kFeet,
                                      .west = 1'000'990,
                                      .north = 200'000,
                                      .pixel = 33,
                                      .columns = 30,
                                      .rows = 30,
                                      .height = rampInFeet});
    const std::string inMetres = write({.crs = kMetres,
                                        .west = 305'101,
                                        .north = 60'960,
                                        .pixel = 11,
                                        .columns = 30,
                                        .rows = 30,
                                        .height = ramp});
    for (const std::string& coarse : {inFeet, inMetres}) {
        const auto dem = test::readDems({fine, coarse});
        ASSERT_TRUE(dem.ok()) << dem.status();
        const auto& grid = dem->grid;
        ASSERT_GE(grid.columns, 95) << coarse;
        ASSERT_LE(grid.columns, 110) << coarse;
        for (std::int32_t i = 0; i < 90; ++i) {
            const fabric::Vec2 at = grid.origin + grid.perColumn * static_cast<double>(i) +
                                    grid.perRow * static_cast<double>(grid.rows - 20);
            EXPECT_NEAR(grid.at(i, grid.rows - 20), ramp(at.x, at.y), 0.02) << coarse << ' ' << i;
        }
        EXPECT_THAT(dem->crsWkt, HasSubstr("in metres"));
    }
}

/// As of BAGs, whose elevations are below zero all the same.
TEST_F(DemMosaic, TellsThatValuesAreHeightsWhereTheCrsIsOfDepths) {
    const std::string heights = write(
        {.crs = "EPSG:26910+5715", .west = 500000, .north = 5200100, .height = constant(-30)});
    const std::string depths = write({.crs = "EPSG:26910+5715",
                                      .west = 500000,
                                      .north = 5200100,
                                      .height = constant(30),
                                      .scale = -1});
    for (const std::string& path : {heights, depths}) {
        const auto dem = test::readDem(path);
        ASSERT_TRUE(dem.ok()) << dem.status();
        EXPECT_EQ(dem->grid.at(5, 5), -30);
        EXPECT_THAT(dem->notes, testing::Contains(HasSubstr("gdal_translate -a_scale -1")));
    }
}

TEST_F(DemMosaic, TellsOfVerticalDatumsThatDiffer) {
    const std::string navd88 =
        write({.crs = "EPSG:26910+5703", .west = 500000, .north = 5200100, .height = constant(1)});
    const std::string egm96 =
        write({.crs = "EPSG:26910+5773", .west = 500105, .north = 5200100, .height = constant(2)});
    const auto dem = test::readDems({navd88, egm96});
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_EQ(dem->grid.at(5, 5), 1);
    EXPECT_EQ(dem->grid.at(15, 5), 2);
    EXPECT_THAT(dem->notes, testing::Contains(testing::AllOf(HasSubstr("vertical datum"),
                                                             HasSubstr(navd88), HasSubstr(egm96))));
}

TEST_F(DemMosaic, TellsOfHeightsAboveTheEllipsoidBesideOthers) {
    const std::string ellipsoid =
        write({.crs = "EPSG:4979", .west = 6, .north = 46.1, .pixel = 0.01, .height = constant(1)});
    const std::string egm96 = write({.crs = "EPSG:4326+5773",
                                     .west = 6.1,
                                     .north = 46.1,
                                     .pixel = 0.01,
                                     .height = constant(2)});
    const auto dem = test::readDems({ellipsoid, egm96});
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_THAT(dem->notes, testing::Contains(
                                testing::AllOf(HasSubstr("the ellipsoid"), HasSubstr(ellipsoid))));
}

}  // namespace
}  // namespace eyrie::import
