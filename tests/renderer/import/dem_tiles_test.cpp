// SPDX-License-Identifier: Apache-2.0
// Terrain that is cut into tiles, as elevation models are delivered: what is between them.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include "tests/renderer/import/dem_mosaic_fixture.h"

namespace eyrie::import {
namespace {

using test::DemMosaic;
using test::kDegrees;

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

}  // namespace
}  // namespace eyrie::import
