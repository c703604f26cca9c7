// SPDX-License-Identifier: Apache-2.0
// Several rasters as one terrain: expected heights come from formulas over the ground, evaluated
// where the mosaic says that its posts stand.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <sys/resource.h>

#include "renderer/import/dem_source.h"
#include "tests/renderer/import/dem_mosaic_fixture.h"

namespace eyrie::import {
namespace {

using test::DemMosaic;
using test::kDegrees;
using test::kUtm32;
using testing::HasSubstr;

TEST_F(DemMosaic, LeavesOpenWhatNoRasterCovers) {
    const std::string a = write({.west = 500000, .north = 5200100, .height = constant(1)});
    const std::string b = write({.west = 500150, .north = 5200050, .height = constant(2)});
    const auto dem = test::readDems({a, b});
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_EQ(dem->grid.columns, 25);
    EXPECT_EQ(dem->grid.rows, 15);
    EXPECT_EQ(dem->grid.origin, fabric::Vec2(500005, 5199955));
    for (std::int32_t j = 0; j < 15; ++j)
        for (std::int32_t i = 0; i < 25; ++i) {
            const float h = dem->grid.at(i, j);
            if (i < 10 && j >= 5)
                EXPECT_EQ(h, 1);
            else if (i >= 15 && j < 10)
                EXPECT_EQ(h, 2);
            else
                EXPECT_TRUE(std::isnan(h)) << i << " " << j;
        }
}

TEST_F(DemMosaic, SaysThatRastersFarApartLeaveMostOfItEmpty) {
    const std::string a = write({.west = 500000, .north = 5200100, .height = constant(1)});
    const auto notesWith = [&](double west) {
        const std::string b = write({.west = west, .north = 5200100, .height = constant(2)});
        const auto dem = openDems({a, b}, {});
        EXPECT_TRUE(dem.ok()) << dem.status();
        return dem->notes;
    };
    const auto isEmpty = testing::Contains(HasSubstr("at most 2 % of these posts"));
    EXPECT_THAT(notesWith(509900), isEmpty);  // 20 of 1000 columns
    EXPECT_THAT(notesWith(500900), testing::Not(testing::Contains(HasSubstr("of these posts"))));
}

/// It is what takes long, and is noted raster by raster at the end.
TEST_F(DemMosaic, SaysWhileItReadsWhatIsResampled) {
    const auto stageOf = [](const std::vector<std::string>& rasters) {
        const auto dem = openDems(rasters, {});
        return dem.ok() ? dem->posts->readingStage() : std::string(dem.status().message());
    };
    const std::string a = write({.west = 500000, .north = 5200100, .height = constant(1)});
    const std::string b = write({.west = 500050, .north = 5200100, .height = constant(2)});
    const std::string coarse =
        write({.west = 500000, .north = 5200200, .pixel = 30, .height = constant(3)});
    const std::string degrees =
        write({.epsg = kDegrees, .west = 9.0, .north = 47, .pixel = 0.001, .height = constant(5)});
    EXPECT_EQ(stageOf({a}), "reading");
    EXPECT_EQ(stageOf({a, b}), "reading");
    EXPECT_EQ(stageOf({degrees}), "reading and resampling");
    EXPECT_EQ(stageOf({a, coarse, b}), "reading and resampling 1 of 3 rasters");
}

TEST_F(DemMosaic, TakesTheLastNamedOfEquallyFineOnes) {
    const std::string a = write({.west = 500000, .north = 5200100, .height = constant(1)});
    const std::string b = write({.west = 500050, .north = 5200100, .height = constant(2)});
    const auto ab = test::readDems({a, b});
    const auto ba = test::readDems({b, a});
    ASSERT_TRUE(ab.ok() && ba.ok()) << ab.status() << ba.status();
    EXPECT_EQ(ab->grid.at(4, 3), 1);
    EXPECT_EQ(ab->grid.at(5, 3), 2);
    EXPECT_EQ(ba->grid.at(9, 3), 1);
    EXPECT_EQ(ba->grid.at(10, 3), 2);
    EXPECT_NE(ab->sourceHash, ba->sourceHash);
}

TEST_F(DemMosaic, TakesTheFinestAndSeesThroughItsHoles) {
    const auto ground = [](double x, double y) {
        return (x - 500000) * 0.5 + (y - 5199000) * 0.25;
    };
    const std::string coarse = write({.west = 500000,
                                      .north = 5200000,
                                      .pixel = 40,
                                      .columns = 20,
                                      .rows = 20,
                                      .height = ground});
    const auto holed = [](double x, double y) {
        return std::abs(x - 500400) < 30 && std::abs(y - 5199600) < 30 ? -9999.0 : 5000.0;
    };
    const std::string fine = write({.west = 500300,
                                    .north = 5199700,
                                    .pixel = 10,
                                    .columns = 20,
                                    .rows = 20,
                                    .height = holed});
    for (const auto& order : {std::vector{fine, coarse}, std::vector{coarse, fine}}) {
        const auto dem = test::readDems(order);
        ASSERT_TRUE(dem.ok()) << dem.status();
        const terrain::HeightGrid& grid = dem->grid;
        EXPECT_EQ(grid.perColumn, fabric::Vec2(10, 0));
        EXPECT_EQ(grid.columns, 80);
        EXPECT_EQ(grid.rows, 80);
        for (std::int32_t j = 2; j < 78; ++j)
            for (std::int32_t i = 2; i < 78; ++i) {
                const double x = grid.origin.x + 10 * i, y = grid.origin.y + 10 * j;
                const bool isFine = x > 500300 && x < 500500 && y > 5199500 && y < 5199700;
                const bool isHole = std::abs(x - 500400) < 30 && std::abs(y - 5199600) < 30;
                // Bilinear gives a plane back to within float's rounding.
                EXPECT_NEAR(grid.at(i, j), isFine && !isHole ? 5000 : ground(x, y), 1e-2)
                    << i << " " << j;
            }
    }
}

/// One hill, seen by a raster in UTM metres on the west and one in degrees on the east.
TEST_F(DemMosaic, JoinsTwoCrsWithoutAStepAtTheSeam) {
    OGRSpatialReference utm, degrees;
    utm.importFromEPSG(kUtm32);
    degrees.importFromEPSG(kDegrees);
    degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> toUtm(
        OGRCreateCoordinateTransformation(&degrees, &utm));
    const auto hill = [](double x, double y) {
        return 300 * std::sin((x - 500000) / 900) * std::cos((y - 5200000) / 700) + 400;
    };
    const std::string west = write({.west = 500000,
                                    .north = 5203000,
                                    .pixel = 10,
                                    .columns = 150,
                                    .rows = 300,
                                    .height = hill});
    const std::string east = write({.epsg = kDegrees,
                                    .west = 9.018,
                                    .north = 46.98,
                                    .pixel = 0.0001,
                                    .columns = 300,
                                    .rows = 350,
                                    .height = [&](double x, double y) {
                                        toUtm->Transform(1, &x, &y);
                                        return hill(x, y);
                                    }});
    const auto dem = test::readDems({west, east});
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_THAT(dem->crsWkt, HasSubstr("UTM zone 32N"));
    const terrain::HeightGrid& grid = dem->grid;
    int beyond = 0;
    for (std::int32_t j = 0; j < grid.rows; ++j)
        for (std::int32_t i = 0; i < grid.columns; ++i) {
            const double x = grid.origin.x + grid.perColumn.x * i;
            const double y = grid.origin.y + grid.perRow.y * j;
            if (std::isnan(grid.at(i, j)))
                continue;
            beyond += x > 501600 ? 1 : 0;
            // 11 m posts of a hill with a curvature of 4e-4 per metre; half a post at the rim,
            // where there is nothing to interpolate towards, of a slope of 0.43 at most.
            ASSERT_NEAR(grid.at(i, j), hill(x, y), 3.5) << x << " " << y;
        }
    EXPECT_GT(beyond, 10000);
    for (std::int32_t j = 100; j < 200; ++j)  // the seam, near x = 501500
        for (std::int32_t i = 140; i < 160; ++i)
            ASSERT_NEAR(
                grid.at(i, j),
                hill(grid.origin.x + grid.perColumn.x * i, grid.origin.y + grid.perRow.y * j), 0.3);
}

/// One above the other: what is nodata of one is a height of the next, but for what never is.
TEST_F(DemMosaic, HonoursEachRastersOwnNodata) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    constexpr double kGreatest = std::numeric_limits<float>::max();
    struct Raster {
        double west, east;  ///< heights of its halves
        double nodata;
    };
    const std::vector<Raster> rasters{{0, 650, 0},           {650, 0, 650},
                                      {-32768, 650, -32768}, {kGreatest, 0, kGreatest},
                                      {kInfinity, 8, -1},    {std::nan(""), 8, 7}};
    std::vector<std::string> paths;
    for (const Raster& raster : rasters)
        paths.push_back(write(
            {.west = 500000,
             .north = 5200100 + 100.0 * static_cast<double>(paths.size()),
             .height = [&](double x, double) { return x < 500050 ? raster.west : raster.east; },
             .nodata = raster.nodata}));
    const auto dem = test::readDems(paths);
    ASSERT_TRUE(dem.ok()) << dem.status();
    ASSERT_EQ(dem->grid.rows, 60);
    for (std::int32_t j = 0; j < 60; ++j)
        for (std::int32_t i = 0; i < 10; ++i) {
            const Raster& raster = rasters[static_cast<std::size_t>(j / 10)];
            if (i < 5)
                EXPECT_TRUE(std::isnan(dem->grid.at(i, j))) << i << " " << j;
            else
                EXPECT_EQ(dem->grid.at(i, j), static_cast<float>(raster.east)) << i << " " << j;
        }
}

TEST_F(DemMosaic, AllInDegreesGoesToTheZoneOfTheirMiddle) {
    const std::string a =
        write({.epsg = kDegrees, .west = 9.0, .north = 47, .pixel = 0.001, .height = constant(5)});
    const std::string b =
        write({.epsg = kDegrees, .west = 9.01, .north = 47, .pixel = 0.001, .height = constant(5)});
    const auto dem = test::readDems({a, b});
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_THAT(dem->crsWkt, HasSubstr("UTM zone 32N"));
    const auto middle = dem->grid.at(dem->grid.columns / 2, dem->grid.rows / 2);
    EXPECT_EQ(middle, 5) << "no gap where the two meet";
}

/// Jakarta lies 106.8 degrees from Greenwich, and 0 to 0.4 from its own meridian.
TEST_F(DemMosaic, NamesNoZoneOfLongitudesFromAnotherMeridian) {
    const auto dem = test::readDem(write({.epsg = 4813,
                                          .west = 0,
                                          .north = -6.1,
                                          .pixel = 0.01,
                                          .columns = 40,
                                          .rows = 40,
                                          .height = constant(5)}));
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_THAT(dem->crsWkt, HasSubstr("Transverse Mercator around 0.2, -6.3"));
    EXPECT_THAT(dem->crsWkt, testing::Not(HasSubstr("UTM")));
    EXPECT_EQ(dem->grid.at(dem->grid.columns / 2, dem->grid.rows / 2), 5);
}

/// 9 east, 47 north, and all of the earth, as a virtual raster: GeoTIFFs keep degrees only.
TEST_F(DemMosaic, TakesGradsAndRadiansForWhatTheyAre) {
    struct Unit {
        const char* name;
        double degrees;
    };
    for (const Unit& unit : {Unit{"grad", 0.9}, Unit{"radian", 180 / M_PI}}) {
        const auto read = [&](double west, double north, double pixel, int columns) {
            const std::string path = folder_.path("angle.vrt");
            std::ofstream(path) << fmt::format(
                R"(<VRTDataset rasterXSize="{}" rasterYSize="{}"><SRS>GEOGCS["of {}",)"
                R"(DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],)"
                R"(PRIMEM["Greenwich",0],UNIT["{}",{:.17g}]]</SRS>)"
                R"(<GeoTransform>{:.17g},{:.17g},0,{:.17g},0,{:.17g}</GeoTransform>)"
                R"(<VRTRasterBand dataType="Float32" band="1"/></VRTDataset>)",
                columns, columns / 2, unit.name, unit.name, unit.degrees * M_PI / 180,
                west / unit.degrees, pixel / unit.degrees, north / unit.degrees,
                -pixel / unit.degrees);
            return test::readDem(path);
        };
        const auto land = read(9, 47, 0.001, 40);
        ASSERT_TRUE(land.ok()) << land.status();
        EXPECT_THAT(land->crsWkt, HasSubstr("UTM zone 32N"));
        EXPECT_NEAR(land->grid.perColumn.x, 84.2, 0.5);  // as many on its diagonal
        EXPECT_EQ(land->grid.at(land->grid.columns / 2, land->grid.rows / 2), 0);
        const auto earth = read(-180, 90, 1, 360);
        ASSERT_TRUE(earth.ok()) << earth.status();
        EXPECT_EQ(earth->grid.columns, 360);
        EXPECT_EQ(earth->grid.rows, 180);
        for (const int column : {1, 180, 358}) EXPECT_EQ(earth->grid.at(column, 90), 0) << column;
    }
}

TEST_F(DemMosaic, NamesTheGridOnWhichItHasTooFewPosts) {
    const std::string narrow = write({.crs = "EPSG:4326",
                                      .west = 9,
                                      .north = 50,
                                      .pixel = 0.0003,
                                      .columns = 2,
                                      .rows = 9,
                                      .height = constant(100)});
    EXPECT_THAT(std::string(test::readDems({narrow}).status().message()),
                HasSubstr("has 1 x 9 posts in UTM zone 32N; a terrain needs at least 2 x 2"));
}

constexpr double kSrtm = 1.0 / 1200;
constexpr double kFall = 20;

/// A tile of SRTM in the Alps, 64 x 93 m of pixels that fall by 20 m to each side.
test::Raster alps(double west) {
    return {.epsg = kDegrees,
            .west = west,
            .north = 46.7,
            .pixel = kSrtm,
            .columns = 240,
            .rows = 240,
            .height = [](double longitude, double latitude) {
                return ((longitude - 8.5) + (latitude - 46.5)) / kSrtm * kFall;
            }};
}

/// Of posts nearer to a place than `reach`, in degrees: how many there are, and how far the worst
/// is off the plane.
std::pair<int, double> offThePlane(const test::Dem& dem, const fabric::Vec2& middle,
                                   const fabric::Vec2& reach) {
    OGRSpatialReference local, degrees;
    local.importFromWkt(dem.crsWkt.c_str());
    local.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    degrees.importFromEPSG(kDegrees);
    degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> toDegrees(
        OGRCreateCoordinateTransformation(&local, &degrees));
    std::pair found(0, 0.0);
    for (std::int32_t j = 0; j < dem.grid.rows; ++j)
        for (std::int32_t i = 0; i < dem.grid.columns; ++i) {
            double x = dem.grid.origin.x + dem.grid.perColumn.x * i;
            double y = dem.grid.origin.y + dem.grid.perRow.y * j;
            EXPECT_TRUE(toDegrees->Transform(1, &x, &y));
            if (std::abs(x - middle.x) > reach.x || std::abs(y - middle.y) > reach.y)
                continue;
            ++found.first;
            const double off = std::abs(dem.grid.at(i, j) - alps(0).height(x, y));
            found.second = std::max(found.second, std::isnan(off) ? 1e9 : off);
        }
    return found;
}

/// A thousandth of a pixel is how far the warper may be off in each direction; the rest is
/// rounding.
constexpr double kWarped = 0.001 * 2 * kFall + 0.01;

TEST_F(DemMosaic, APlaneInDegreesStaysAPlane) {
    const auto dem = test::readDem(write(alps(8.5)));
    ASSERT_TRUE(dem.ok()) << dem.status();
    const auto [posts, off] = offThePlane(*dem, {8.6, 46.6}, fabric::Vec2(0.1 - kSrtm));
    EXPECT_GT(posts, 40000);
    EXPECT_LE(off, kWarped);
}

/// Each by itself would be flat for half a pixel at its rim.
TEST_F(DemMosaic, HasNoRimBetweenTilesOfAGridThoughAnotherGridsComesBetween) {
    const std::string west = write(alps(8.5));
    const std::string east = write(alps(8.7));
    test::Raster aside = alps(8.5 + kSrtm / 2);
    aside.north = 46.9;
    const auto dem = test::readDems({west, write(aside), east});
    ASSERT_TRUE(dem.ok()) << dem.status();
    const auto [posts, off] =
        offThePlane(*dem, {8.7, 46.6}, fabric::Vec2(2 * kSrtm, 0.1 - 2 * kSrtm));
    EXPECT_GT(posts, 500);
    EXPECT_LE(off, kWarped);
}

/// The west would be joined to the east, before what lies over it.
TEST_F(DemMosaic, TakesTheLastNamedThoughAnEarlierOneIsOfTheGridOfALaterOne) {
    const std::string west = write(alps(8.5));
    const std::string east = write(alps(8.7));
    test::Raster over = alps(8.6 + kSrtm / 2);
    over.columns = 60;
    over.height = constant(5000);
    const auto dem = test::readDems({west, write(over), east});
    ASSERT_TRUE(dem.ok()) << dem.status();
    const auto& grid = dem->grid;
    EXPECT_GT(std::ranges::count(grid.heights, 5000.0F), 10000);
}

/// As GDAL reads GeoTIFFs that say what a pixel is, and nothing of a CRS.
TEST_F(DemMosaic, TakesAnEngineeringCrsWithoutANameForNone) {
    const char* const unnamed = "LOCAL_CS[\"unnamed\",UNIT[\"unknown\",1]]";
    const std::string nowhere =
        write({.crs = unnamed, .west = 500000, .north = 5200100, .height = constant(1)});
    const std::string plain =
        write({.epsg = 0, .west = 500100, .north = 5200100, .height = constant(2)});
    const auto both = test::readDems({nowhere, plain});
    ASSERT_TRUE(both.ok()) << both.status();
    EXPECT_EQ(both->crsWkt, "");
    EXPECT_EQ(both->grid.columns, 20);
    const std::string good = write({.west = 500000, .north = 5200100, .height = constant(3)});
    EXPECT_THAT(test::readDems({good, nowhere}).status().ToString(),
                HasSubstr(nowhere + ": has not a CRS, unlike " + good));
    const std::string named = write({.crs = "LOCAL_CS[\"pit\",UNIT[\"metre\",1]]",
                                     .west = 500000,
                                     .north = 5200100,
                                     .height = constant(4)});
    EXPECT_THAT(test::readDem(named)->crsWkt, HasSubstr("pit"));
}

/// Until it ends, this process may open no more than `files`; `most` is how far it may raise that.
class OpenFilesLimit {
public:
    OpenFilesLimit(rlim_t files, rlim_t most) {
        getrlimit(RLIMIT_NOFILE, &before_);
        const rlimit limit{files, std::min(most, before_.rlim_max)};
        EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &limit), 0);
    }
    OpenFilesLimit(const OpenFilesLimit&) = delete;
    OpenFilesLimit& operator=(const OpenFilesLimit&) = delete;
    ~OpenFilesLimit() { setrlimit(RLIMIT_NOFILE, &before_); }

private:
    rlimit before_{};
};

TEST_F(DemMosaic, HasMoreRastersThanAProcessBeginsWithOpenFiles) {
    std::vector<std::string> tiles;
    for (int k = 0; k < 90; ++k)
        tiles.push_back(
            write({.west = 500000.0 + 100 * k, .north = 5200100, .height = constant(k)}));
    {
        const OpenFilesLimit limit(60, RLIM_INFINITY);
        const auto dem = test::readDems(tiles);
        ASSERT_TRUE(dem.ok()) << dem.status();
        EXPECT_EQ(dem->grid.at(895, 5), 89);
    }
    // In a process of its own: a limit that cannot be raised holds for good.
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            const OpenFilesLimit limit(60, 60);
            const auto dem = test::readDems(tiles);
            std::cerr << dem.status();
            std::exit(absl::IsResourceExhausted(dem.status()) ? 0 : 1);
        },
        testing::ExitedWithCode(0), "at most 60 files; allow more \\(ulimit -n\\)");
}

/// Directories of a TIFF are GDAL's simplest subdatasets.
TEST_F(DemMosaic, TakesWhatGdalNamesInAFile) {
    GDALAllRegister();
    const std::string path = folder_.path("two.tif");
    for (const int height : {10, 20}) {
        const GDALDatasetUniquePtr memory(GetGDALDriverManager()->GetDriverByName("MEM")->Create(
            "", 4, 4, 1, GDT_Float32, nullptr));
        memory->GetRasterBand(1)->Fill(height);
        const char* const append[] = {"APPEND_SUBDATASET=YES", nullptr};
        ASSERT_NE(GDALDatasetUniquePtr(GetGDALDriverManager()->GetDriverByName("GTiff")->CreateCopy(
                      path.c_str(), memory.get(), FALSE, height == 10 ? nullptr : append, nullptr,
                      nullptr)),
                  nullptr);
    }
    const auto first = test::readDems({"GTIFF_DIR:1:" + path});
    const auto second = test::readDems({"GTIFF_DIR:2:" + path});
    const auto relative =
        test::readDems({"GTIFF_DIR:2:" + std::filesystem::relative(path).string()});
    ASSERT_TRUE(first.ok() && second.ok() && relative.ok()) << first.status() << second.status();
    EXPECT_EQ(first->grid.at(1, 1), 10);
    EXPECT_EQ(second->grid.at(1, 1), 20);
    EXPECT_NE(first->sourceHash, second->sourceHash);
    EXPECT_EQ(second->sourceHash, relative->sourceHash);
    const auto third = test::readDems({"GTIFF_DIR:3:" + path});
    EXPECT_EQ(third.status().code(), absl::StatusCode::kNotFound) << third.status();
}

TEST_F(DemMosaic, RefusesWhatCannotBeBroughtTogether) {
    const std::string good = write({.west = 500000, .north = 5200100, .height = constant(1)});
    const std::string plain =
        write({.epsg = 0, .west = 500000, .north = 5200100, .height = constant(1)});
    const auto mixed = test::readDems({good, plain});
    EXPECT_EQ(mixed.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(mixed.status().ToString(), HasSubstr(plain));
    const auto missing = test::readDems({good, folder_.path("none.tif")});
    EXPECT_EQ(missing.status().code(), absl::StatusCode::kNotFound);
    const std::string far = write({.west = 500000, .north = -5e9, .height = constant(1)});
    EXPECT_FALSE(test::readDems({good, far}).ok());
    EXPECT_FALSE(test::readDems({}).ok());
}

}  // namespace
}  // namespace eyrie::import
