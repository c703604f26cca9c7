// SPDX-License-Identifier: Apache-2.0
// Several rasters as one terrain: expected heights come from formulas over the ground, evaluated
// where the mosaic says that its posts stand.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <limits>
#include <random>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <sys/resource.h>

#include "renderer/import/dem_source.h"
#include "tests/renderer/import/terrain_fixture.h"

namespace eyrie::import {
namespace {

using testing::HasSubstr;

constexpr int kUtm32 = 32632;
constexpr int kDegrees = 4326;

/// A raster whose pixels are `height` of their centres' coordinates.
struct Raster {
    int epsg = kUtm32;
    const char* crs = nullptr;  ///< instead, such as EPSG:26910+6360
    const char* driver = "GTiff";
    double west = 0;
    double north = 0;
    double pixel = 10;
    int columns = 10;
    int rows = 10;
    std::function<double(double, double)> height;
    double nodata = -9999;
    const char* unit = "";
    double scale = 1;
};

class DemMosaic : public testing::Test {
protected:
    std::string write(const Raster& raster) {
        GDALAllRegister();
        const std::string path = folder_.path(fmt::format("{}.tif", files_++));
        const GDALDatasetUniquePtr file(
            GetGDALDriverManager()
                ->GetDriverByName(raster.driver)
                ->Create(path.c_str(), raster.columns, raster.rows, 1, GDT_Float32, nullptr));
        std::array<double, 6> transform{raster.west, raster.pixel, 0, raster.north,
                                        0,           -raster.pixel};
        file->SetGeoTransform(transform.data());
        if (raster.epsg != 0) {
            OGRSpatialReference crs;
            if (raster.crs != nullptr)
                crs.SetFromUserInput(raster.crs);
            else
                crs.importFromEPSG(raster.epsg);
            file->SetSpatialRef(&crs);
        }
        GDALRasterBand* const band = file->GetRasterBand(1);
        band->SetNoDataValue(raster.nodata);
        if (*raster.unit != 0)
            band->SetUnitType(raster.unit);
        band->SetScale(raster.scale);
        std::vector<float> row(static_cast<std::size_t>(raster.columns));
        for (int j = 0; j < raster.rows; ++j) {
            for (int i = 0; i < raster.columns; ++i)
                row[static_cast<std::size_t>(i)] =
                    static_cast<float>(raster.height(raster.west + raster.pixel * (i + 0.5),
                                                     raster.north - raster.pixel * (j + 0.5)));
            EXPECT_EQ(band->RasterIO(GF_Write, 0, j, raster.columns, 1, row.data(), raster.columns,
                                     1, GDT_Float32, 0, 0, nullptr),
                      CE_None);
        }
        return path;
    }

    static std::function<double(double, double)> constant(double height) {
        return [height](double, double) { return height; };
    }

    test::TemporaryFolder folder_;
    int files_ = 0;
};

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

TEST_F(DemMosaic, HonoursEachRastersOwnNodata) {
    const auto half = [](double nodata) {
        return [nodata](double x, double) { return x < 500050 ? nodata : 8.0; };
    };
    const std::string a =
        write({.west = 500000, .north = 5200100, .height = half(-1), .nodata = -1});
    const std::string b = write({.west = 500000,
                                 .north = 5200200,
                                 .height = half(std::numeric_limits<double>::infinity()),
                                 .nodata = 0});
    const std::string c =
        write({.west = 500000, .north = 5200300, .height = half(std::nan("")), .nodata = 650});
    const auto dem = test::readDems({a, b, c});
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_EQ(dem->grid.rows, 30);
    for (std::int32_t j = 0; j < 30; ++j)
        for (std::int32_t i = 0; i < 10; ++i) {
            if (i < 5)
                EXPECT_TRUE(std::isnan(dem->grid.at(i, j))) << i << " " << j;
            else
                EXPECT_EQ(dem->grid.at(i, j), 8);
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

/// Calls `look(longitude, latitude, height)` for every post.
template <typename Look>
void forEachPostInDegrees(const test::Dem& dem, const Look& look) {
    OGRSpatialReference local, degrees;
    local.importFromWkt(dem.crsWkt.c_str());
    local.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    degrees.importFromEPSG(kDegrees);
    degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> toDegrees(
        OGRCreateCoordinateTransformation(&local, &degrees));
    for (std::int32_t j = 0; j < dem.grid.rows; ++j)
        for (std::int32_t i = 0; i < dem.grid.columns; ++i) {
            double x = dem.grid.origin.x + dem.grid.perColumn.x * i;
            double y = dem.grid.origin.y + dem.grid.perRow.y * j;
            toDegrees->Transform(1, &x, &y);
            look(x, y, dem.grid.at(i, j));
        }
}

/// Two by two tiles that touch and do not overlap; of every second tiling the eastern ones have
/// other pixels, as some elevation models have towards the poles.
TEST_F(DemMosaic, NoPostIsOpenBetweenTilesThatTouch) {
    constexpr unsigned kSeed = 7;
    std::mt19937 random(kSeed);
    const auto upTo = [&](double most) {
        return std::uniform_real_distribution<double>(0, most)(random);
    };
    for (int k = 0; k < 24; ++k) {
        const double side = 0.02 + upTo(0.4);
        const int pixels = 40 + static_cast<int>(upTo(60));
        const int eastern = k % 2 == 0 ? pixels : pixels - 3 - static_cast<int>(upTo(20));
        const double west = -170 + upTo(330);
        const double north = -60 + upTo(130);
        std::vector<std::string> tiles;
        for (int tile = 0; tile < 4; ++tile) {
            const int count = tile % 2 == 0 ? pixels : eastern;
            tiles.push_back(write({.epsg = kDegrees,
                                   .west = west + side * (tile % 2),
                                   .north = north - side * (tile / 2),
                                   .pixel = side / count,
                                   .columns = count,
                                   .rows = count,
                                   .height = constant(500)}));
        }
        const auto dem = test::readDems(tiles);
        ASSERT_TRUE(dem.ok()) << dem.status();
        const double rim = 2 * side / eastern;
        int open = 0;
        forEachPostInDegrees(*dem, [&](double x, double y, float height) {
            const double toRim =
                std::min({x - west, west + 2 * side - x, north - y, y - (north - 2 * side)});
            open += toRim > rim && std::isnan(height) ? 1 : 0;
        });
        EXPECT_EQ(open, 0) << "tiling " << k << " of seed " << kSeed << ": " << west << " " << north
                           << " " << side << " " << pixels << " " << eastern;
    }
}

/// The ground rises by up to 75 m a pixel: half a pixel without a neighbour would be far off.
TEST_F(DemMosaic, BetweenTilesThatTouchHeightsAreAsExactAsWithinThem) {
    const auto hills = [](double x, double y) {
        return 1000 + 500 * std::sin(x * 150) * std::cos(y * 130);
    };
    std::vector<std::string> tiles;
    for (int tile = 0; tile < 4; ++tile)
        tiles.push_back(write({.epsg = kDegrees,
                               .west = 9 + 0.1 * (tile % 2),
                               .north = 47 - 0.1 * (tile / 2),
                               .pixel = 0.001,
                               .columns = 100,
                               .rows = 100,
                               .height = hills}));
    const auto dem = test::readDems(tiles);
    ASSERT_TRUE(dem.ok()) << dem.status();
    double within = 0, between = 0;
    int seen = 0;
    forEachPostInDegrees(*dem, [&](double x, double y, float height) {
        const double toSeam = std::min(std::abs(x - 9.1), std::abs(y - 46.9));
        if (std::min({x - 9, 9.2 - x, y - 46.8, 47 - y}) < 0.002)
            return;
        const double error = std::abs(height - hills(x, y));
        ASSERT_FALSE(std::isnan(error)) << x << " " << y;
        (toSeam < 0.001 ? between : within) = std::max(toSeam < 0.001 ? between : within, error);
        seen += toSeam < 0.001 ? 1 : 0;
    });
    EXPECT_GT(seen, 500);
    EXPECT_LE(between, within * 1.1);
    EXPECT_LT(within, 10);
}

/// The last lies on the grid of the first, and what lies on another is between them.
TEST_F(DemMosaic, TilesOfOneGridAreNotJoinedPastWhatIsBetweenThem) {
    const auto tile = [&](double pixel, int columns, double height) {
        return write({.epsg = kDegrees,
                      .west = 9,
                      .north = 47,
                      .pixel = pixel,
                      .columns = columns,
                      .rows = 40,
                      .height = constant(height)});
    };
    const auto dem =
        test::readDems({tile(0.001, 40, 1), tile(0.001005, 40, 2), tile(0.001, 20, 3)});
    ASSERT_TRUE(dem.ok()) << dem.status();
    const std::int32_t row = dem->grid.rows / 2;
    EXPECT_EQ(dem->grid.at(dem->grid.columns / 4, row), 3);
    EXPECT_EQ(dem->grid.at(dem->grid.columns * 3 / 4, row), 2);
}

TEST_F(DemMosaic, WhereTilesOfOneGridOverlapTheLastNamedIsTaken) {
    const auto tile = [&](int column, double height) {
        return write({.epsg = kDegrees,
                      .west = 9 + 0.001 * column,
                      .north = 47,
                      .pixel = 0.001,
                      .columns = 40,
                      .rows = 40,
                      .height = [=](double x, double) {
                          return column == 20 && x > 9.05 ? -9999.0 : height;
                      }});
    };
    const auto dem = test::readDems({tile(0, 1), tile(40, 3), tile(20, 2)});
    ASSERT_TRUE(dem.ok()) << dem.status();
    const auto at = [&](int eighths) {
        return dem->grid.at(dem->grid.columns * eighths / 8, dem->grid.rows / 2);
    };
    EXPECT_EQ(at(1), 1);
    EXPECT_EQ(at(3), 2);
    EXPECT_EQ(at(6), 3) << "a hole shows what is below";
    EXPECT_EQ(at(7), 3);
}

TEST_F(DemMosaic, JoinsStripsOfOnePixel) {
    std::vector<std::string> strips;
    for (int k = 0; k < 3; ++k)
        strips.push_back(write({.west = 500000.0 + 10 * k,
                                .north = 5200100,
                                .columns = 1,
                                .rows = 4,
                                .height = constant(k)}));
    const auto dem = test::readDems(strips);
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_EQ(dem->grid.columns, 3);
    for (std::int32_t i = 0; i < 3; ++i) EXPECT_EQ(dem->grid.at(i, 2), static_cast<float>(i));
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

/// Heights from 9,000 m below the ellipsoid to 1,000 below, by where on the earth a place lies, so
/// that neither the poles nor the antimeridian are special.
double deep(double longitude, double latitude) {
    const double lon = longitude * M_PI / 180, lat = latitude * M_PI / 180;
    return 2000 * std::sin(8 * std::cos(lat) * std::cos(lon)) +
           2000 * std::cos(7 * std::cos(lat) * std::sin(lon)) - 5000;
}

struct Place {
    double longitude;
    double latitude;
};

/// J. P. Snyder, Map Projections: A Working Manual (1987), pages 160 to 162: the ellipsoidal polar
/// stereographic projection of UPS, backwards.
Place fromUps(double x, double y, bool isNorth) {
    constexpr double kA = 6378137, kF = 1 / 298.257223563, kScale = 0.994, kFalse = 2e6;
    const double e = std::sqrt(kF * (2 - kF));
    const double dx = x - kFalse, dy = isNorth ? kFalse - y : y - kFalse;
    const double t = std::hypot(dx, dy) *
                     std::sqrt(std::pow(1 + e, 1 + e) * std::pow(1 - e, 1 - e)) / (2 * kA * kScale);
    double latitude = M_PI / 2 - 2 * std::atan(t);
    for (int i = 0; i < 5; ++i) {
        const double s = e * std::sin(latitude);
        latitude = M_PI / 2 - 2 * std::atan(t * std::pow((1 - s) / (1 + s), e / 2));
    }
    return {std::atan2(dx, dy) * 180 / M_PI, (isNorth ? latitude : -latitude) * 180 / M_PI};
}

class HardCase26 : public DemMosaic {
protected:
    struct Checked {
        std::int64_t posts = 0;
        std::int64_t open = 0;
        double worst = 0;  ///< metres, away from the raster's rim
    };

    /// Compares every post with the height of its place where `isInside` says that the raster has
    /// posts all around it.
    static Checked check(const test::Dem& dem, const std::function<Place(double, double)>& place,
                         const std::function<bool(const Place&)>& isInside) {
        Checked checked;
        for (std::int32_t j = 0; j < dem.grid.rows; ++j)
            for (std::int32_t i = 0; i < dem.grid.columns; ++i) {
                const Place at = place(dem.grid.origin.x + dem.grid.perColumn.x * i,
                                       dem.grid.origin.y + dem.grid.perRow.y * j);
                if (!isInside(at))
                    continue;
                ++checked.posts;
                const double height = dem.grid.at(i, j);
                if (std::isnan(height))
                    ++checked.open;
                else
                    checked.worst =
                        std::max(checked.worst, std::abs(height - deep(at.longitude, at.latitude)));
            }
        return checked;
    }

    /// By PROJ, which import leaves to GDAL's warper.
    static std::function<Place(double, double)> fromCrs(const std::string& wkt) {
        OGRSpatialReference local, degrees;
        local.importFromWkt(wkt.c_str());
        local.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        degrees.importFromEPSG(kDegrees);
        degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        const std::shared_ptr<OGRCoordinateTransformation> transformation(
            OGRCreateCoordinateTransformation(&local, &degrees));
        return [transformation](double x, double y) {
            transformation->Transform(1, &x, &y);
            return Place{x, y};
        };
    }
};

/// A cap of all longitudes, with the pole in its middle and the antimeridian as a seam, where a
/// raster ends and begins. Pixels of half a degree, over which the ground falls by 140 m at most:
/// between them interpolation leaves 1.2 m, and the warper's hundredth of a pixel 1.4. A post
/// farther on it is 6 m.
TEST_F(HardCase26, PolarCapsHaveEveryPlaceWhereSnydersFormulasHaveIt) {
    for (const bool isNorth : {true, false}) {
        const auto dem = test::readDem(write({.epsg = kDegrees,
                                              .west = -180,
                                              .north = isNorth ? 90.0 : -84.0,
                                              .pixel = 0.5,
                                              .columns = 720,
                                              .rows = 12,
                                              .height = deep}));
        ASSERT_TRUE(dem.ok()) << dem.status();
        const auto found = [&](double fromPole, double longitude) {
            return check(
                *dem, [&](double x, double y) { return fromUps(x, y, isNorth); },
                [&](const Place& at) {
                    const double distance = 90 - std::abs(at.latitude);
                    return distance > fromPole && distance < 5.4 &&
                           std::abs(at.longitude) < longitude;
                });
        };
        const Checked around = found(0.6, 179.4);
        EXPECT_GT(around.posts, 30000);
        EXPECT_EQ(around.open, 0);
        EXPECT_LE(around.worst, 2.6);
        // At the pole and at the seam the next pixel's centre is half a pixel away.
        const Checked all = found(0, 181);
        EXPECT_EQ(all.open, 0);
        EXPECT_LE(all.worst, 70);
    }
}

/// Continents, oceans and the earth, of pixels of half a degree as above; a post on another grid
/// than the raster's is interpolated once more.
TEST_F(HardCase26, WideLandsHaveEveryPlaceWhereProjHasIt) {
    struct Case {
        const char* name;
        double west, north;
        int columns, rows;
        const char* projection;
    };
    for (const Case& one :
         {Case{"Europe", -12, 72, 110, 76, "Lambert azimuthal equal-area around 15.5, 53"},
          Case{"the Pacific's islands", 150, 10, 120, 60,
               "Lambert azimuthal equal-area around -180"},
          Case{"Antarctica", -180, -60, 720, 60, "Lambert azimuthal equal-area around 0, -90"},
          Case{"the Americas", -170, 75, 280, 260, "Equidistant cylindrical"},
          Case{"the earth", -180, 90, 720, 360, "Equidistant cylindrical"},
          Case{"the earth from Greenwich", 0, 90, 720, 360, "Equidistant cylindrical"}}) {
        const auto dem = test::readDem(write({.epsg = kDegrees,
                                              .west = one.west,
                                              .north = one.north,
                                              .pixel = 0.5,
                                              .columns = one.columns,
                                              .rows = one.rows,
                                              .height = deep}));
        ASSERT_TRUE(dem.ok()) << one.name << dem.status();
        EXPECT_THAT(dem->crsWkt, HasSubstr(one.projection)) << one.name;
        const double east = one.west + 0.5 * one.columns, south = one.north - 0.5 * one.rows;
        const Checked found = check(*dem, fromCrs(dem->crsWkt), [&](const Place& at) {
            const double turns = std::floor((at.longitude - one.west) / 360);
            const double longitude = at.longitude - 360 * turns;
            return longitude > one.west + 0.6 && longitude < east - 0.6 &&
                   at.latitude < std::min(one.north, 89.9) - 0.6 &&
                   at.latitude > std::max(south, -89.9) + 0.6;
        });
        EXPECT_GT(found.posts, 5000) << one.name;
        EXPECT_EQ(found.open, 0) << one.name;
        EXPECT_LE(found.worst, 2.6) << one.name;
    }
}

/// Pixels of a degree and of two, from a degree farther west: where the finer raster is open, the
/// coarser one is interpolated, which leaves 16 times what half a degree does.
TEST_F(HardCase26, TwoRastersOfTheEarthFillEachOther) {
    const auto west = [](double longitude, double latitude) {
        return longitude > 20 ? -9999 : deep(longitude, latitude);
    };
    const std::string fine = write({.epsg = kDegrees,
                                    .west = -180,
                                    .north = 90,
                                    .pixel = 1,
                                    .columns = 360,
                                    .rows = 180,
                                    .height = west});
    const std::string coarse = write({.epsg = kDegrees,
                                      .west = -181,
                                      .north = 90,
                                      .pixel = 2,
                                      .columns = 180,
                                      .rows = 90,
                                      .height = deep});
    const auto dem = test::readDems({fine, coarse});
    ASSERT_TRUE(dem.ok()) << dem.status();
    const Checked found = check(*dem, fromCrs(dem->crsWkt), [](const Place& at) {
        return std::abs(at.latitude) < 88 && std::abs(at.longitude) < 177 &&
               std::abs(at.longitude - 20) > 1;  // the rim of what the finer one has
    });
    EXPECT_GT(found.posts, 50000);
    EXPECT_EQ(found.open, 0);
    EXPECT_LE(found.worst, 26);
}

/// Pixels of a hundredth of a degree, over which the ground falls by 3 m at most. Rasters that
/// count to 180 degrees and from -180 are one raster.
TEST_F(HardCase26, AcrossTheAntimeridianEveryPlaceIsWhereProjHasIt) {
    const auto raster = [&](double west, int columns) {
        return write({.epsg = kDegrees,
                      .west = west,
                      .north = -16,
                      .pixel = 0.01,
                      .columns = columns,
                      .rows = 200,
                      .height = deep});
    };
    for (const std::vector<std::string>& rasters :
         {std::vector{raster(178.5, 300)}, std::vector{raster(-181.5, 300)},
          std::vector{raster(178.5, 150), raster(-180, 150)}}) {
        const auto dem = test::readDems(rasters);
        ASSERT_TRUE(dem.ok()) << dem.status();
        const Checked found = check(*dem, fromCrs(dem->crsWkt), [](const Place& at) {
            const double east = at.longitude < 0 ? at.longitude + 180 : at.longitude - 180;
            return east > -1.48 && east < 1.48 && at.latitude < -16.02 && at.latitude > -17.98;
        });
        EXPECT_GT(found.posts, 50000);
        EXPECT_EQ(found.open, 0);
        EXPECT_LE(found.worst, 0.04);
    }
}

}  // namespace
}  // namespace eyrie::import
