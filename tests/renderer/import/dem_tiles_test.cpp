// SPDX-License-Identifier: Apache-2.0
// Terrain that is cut into tiles, as elevation models are delivered: what is between them.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <utility>
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

/// A tenth steep to the east and half of that to the north.
double slope(double x, double y) { return (x - 500000) * 0.1 + (y - 5200000) * 0.05 + 200; }

/// By posts that are on the plane, and open ones: of those of which `isInside`.
std::pair<int, int> onSlope(const test::Dem& dem,
                            const std::function<bool(double, double)>& isInside) {
    // Rounding of heights to floats, and a thousandth of a pixel 90 m wide.
    constexpr double kOff = 0.02;
    std::pair<int, int> seen(0, 0);
    for (std::int32_t j = 0; j < dem.grid.rows; ++j)
        for (std::int32_t i = 0; i < dem.grid.columns; ++i) {
            const double x = dem.grid.origin.x + dem.grid.perColumn.x * i;
            const double y = dem.grid.origin.y + dem.grid.perRow.y * j;
            if (!isInside(x, y))
                continue;
            const float height = dem.grid.at(i, j);
            if (std::isnan(height))
                ++seen.second;
            else if (++seen.first; std::abs(height - slope(x, y)) > kOff)
                ADD_FAILURE() << x << " " << y << ": " << height << ", not " << slope(x, y);
        }
    return seen;
}

/// By itself each of the coarse ones would be flat for half a pixel, up to 4 m too high or low.
TEST_F(DemMosaic, APlaneIsAPlaneWhereACoarseRasterEndsAtAFinerOne) {
    for (const double pixel : {30.0, 90.0, 37.0})
        for (const double shift : {0.0, 3.0, -4.0}) {  // over the coarse one, or into its pixels
            const test::Raster coarse{.west = 500000,
                                      .north = 5203330,
                                      .pixel = pixel,
                                      .columns = static_cast<int>(3330 / pixel),
                                      .rows = static_cast<int>(3330 / pixel),
                                      .height = slope};
            const double east = coarse.west + pixel * coarse.columns - std::abs(shift);
            const double south = coarse.north - pixel * coarse.rows + std::abs(shift);
            const test::Raster beside{.west = east,
                                      .north = coarse.north + shift,
                                      .columns = 40,
                                      .rows = 300,
                                      .height = slope};
            const test::Raster below{.west = coarse.west + shift,
                                     .north = south,
                                     .pixel = 11,
                                     .columns = 320,
                                     .rows = 50,
                                     .height = slope};
            const auto dem = test::readDems({write(coarse), write(beside), write(below)});
            ASSERT_TRUE(dem.ok()) << dem.status();
            const auto [posts, open] = onSlope(*dem, [&](double x, double y) {
                return x > coarse.west + pixel && x < east + 300 && y > south - 400 &&
                       y < coarse.north - pixel && (x < east - 200 || y > south + 400);
            });
            EXPECT_GT(posts, 90000);
            EXPECT_EQ(open, 0);
        }
}

/// Of the coarse one some pixels are open, and a finer one lies in that hole, but for a corner.
TEST_F(DemMosaic, APlaneIsAPlaneWhereAFinerRasterLiesInAHoleAndNothingElseIsCovered) {
    const auto isHole = [](double x, double y) {
        return x > 500600 && x < 501200 && y > 5200600 && y < 5201200;
    };
    const std::string coarse =
        write({.west = 500000,
               .north = 5201800,
               .pixel = 30,
               .columns = 60,
               .rows = 60,
               .height = [&](double x, double y) { return isHole(x, y) ? -9999 : slope(x, y); }});
    const std::string fine = write({.west = 500600,
                                    .north = 5201200,
                                    .columns = 60,
                                    .rows = 60,
                                    .height = [&](double x, double y) {
                                        return x > 500900 && y > 5200900 ? -9999 : slope(x, y);
                                    }});
    const auto dem = test::readDems({coarse, fine});
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_EQ(dem->grid.columns, 180);
    const auto [posts, open] = onSlope(*dem, [](double x, double y) {
        return x > 500030 && x < 501770 && y > 5200030 && y < 5201770 &&
               !(x > 500880 && x < 501220 && y > 5200880 && y < 5201220);
    });
    EXPECT_GT(posts, 25000);
    EXPECT_EQ(open, 0);
    EXPECT_EQ(std::ranges::count_if(dem->grid.heights, [](float h) { return std::isnan(h); }),
              30 * 30);
}

/// Around the hole rims tell something over more posts than are resampled at once.
TEST_F(DemMosaic, APlaneIsAPlaneWhereARastersPixelsAreFarWiderThanPosts) {
    constexpr double kPixel = 1500, kWest = 500000, kNorth = 5212000;
    constexpr double kHole = 3 * kPixel;  // from the north-western corner
    const test::Raster coarse{.west = kWest,
                              .north = kNorth,
                              .pixel = kPixel,
                              .columns = 8,
                              .rows = 8,
                              .height = [&](double x, double y) {
                                  return x > kWest + kHole && x < kWest + kHole + kPixel &&
                                                 y < kNorth - kHole && y > kNorth - kHole - kPixel
                                             ? -9999
                                             : slope(x, y);
                              }};
    const test::Raster fine{.west = kWest + kHole,
                            .north = kNorth - kHole,
                            .columns = 150,
                            .rows = 150,
                            .height = slope};
    const auto dem = test::readDems({write(coarse), write(fine)});
    ASSERT_TRUE(dem.ok()) << dem.status();
    const double inside = 7 * kPixel;
    const auto [posts, open] = onSlope(*dem, [&](double x, double y) {
        return x > kWest + kPixel && x < kWest + inside && y < kNorth - kPixel &&
               y > kNorth - inside;
    });
    EXPECT_GT(posts, 800000);
    EXPECT_EQ(open, 0);
}

/// The fine one is of a zone's metres, the coarse one, in degrees, lies around it; between them are
/// posts in pixels of neither.
TEST_F(DemMosaic, APlaneIsAPlaneWhereRastersOfTwoCrsMeet) {
    OGRSpatialReference utm, degrees;
    utm.importFromEPSG(test::kUtm32);
    degrees.importFromEPSG(kDegrees);
    degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> toUtm(
        OGRCreateCoordinateTransformation(&degrees, &utm));
    const std::string fine =
        write({.west = 500000, .north = 5203000, .columns = 300, .rows = 300, .height = slope});
    const std::string coarse =
        write({.epsg = kDegrees,
               .west = 8.98,
               .north = 47.0,
               .pixel = 1.0 / 1200,
               .columns = 96,
               .rows = 72,
               .height = [&](double x, double y) {
                   toUtm->Transform(1, &x, &y);
                   const bool isUnder = x > 500000 && x < 503000 && y > 5200000 && y < 5203000;
                   return isUnder ? -9999 : slope(x, y);
               }});
    for (const auto& order : {std::vector{fine, coarse}, std::vector{coarse, fine}}) {
        const auto dem = test::readDems(order);
        ASSERT_TRUE(dem.ok()) << dem.status();
        const auto [posts, open] = onSlope(*dem, [](double x, double y) {
            return x > 499500 && x < 503500 && y > 5199500 && y < 5203500;
        });
        EXPECT_GT(posts, 140000);
        EXPECT_EQ(open, 1490);
    }
}

/// One ends at 180 degrees, the other, finer one begins at -180. Pixels of the coarse one fall by
/// 20 m to each side.
TEST_F(DemMosaic, APlaneIsAPlaneWhereRastersMeetAtTheAntimeridian) {
    constexpr double kCoarse = 1.0 / 1200;
    const auto plane = [](double longitude, double latitude) {
        const double east = longitude - 360 * std::floor(longitude / 360) - 180;
        return (east + latitude - 46) / kCoarse * 20;
    };
    const std::string coarse = write({.epsg = kDegrees,
                                      .west = 179.9,
                                      .north = 46.1,
                                      .pixel = kCoarse,
                                      .columns = 120,
                                      .rows = 120,
                                      .height = plane});
    const std::string fine = write({.epsg = kDegrees,
                                    .west = -180,
                                    .north = 46.1,
                                    .pixel = kCoarse / 3,
                                    .columns = 360,
                                    .rows = 360,
                                    .height = plane});
    const auto dem = test::readDems({coarse, fine});
    ASSERT_TRUE(dem.ok()) << dem.status();
    int seen = 0;
    double worst = 0;
    forEachPostInDegrees(*dem, [&](double x, double y, float height) {
        if (std::abs(x) < 179.99 || std::abs(y - 46.05) > 0.04)
            return;
        ++seen;
        worst = std::isnan(height) ? 1e9 : std::max(worst, std::abs(height - plane(x, y)));
    });
    EXPECT_GT(seen, 10000);
    EXPECT_LT(worst, 0.05);
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
