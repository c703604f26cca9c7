// SPDX-License-Identifier: Apache-2.0
// Poles, the antimeridian, continents and the earth, all below the ellipsoid: every post is held
// against the height of its place, which formulas of their own and PROJ find.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include "tests/renderer/import/dem_mosaic_fixture.h"

namespace eyrie::import {
namespace {

using test::DemMosaic;
using test::kDegrees;
using testing::HasSubstr;

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
/// between them interpolation leaves 1.2 m, and the warper's thousandth of a pixel 0.14. A post
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
        EXPECT_LE(around.worst, 1.4);
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
        EXPECT_LE(found.worst, 1.4) << one.name;
    }
}

/// Posts from 94.5 to 65.5 degrees, of a formula that goes on; and from the pole on.
TEST_F(HardCase26, RowsBeyondAPoleAreLeftOutAndSaidSo) {
    const auto capFrom = [&](double north) {
        return test::readDem(write({.epsg = kDegrees,
                                    .west = -180,
                                    .north = north,
                                    .pixel = 1,
                                    .columns = 360,
                                    .rows = 30,
                                    .height = constant(5)}));
    };
    const auto beyond = capFrom(95);
    ASSERT_TRUE(beyond.ok()) << beyond.status();
    EXPECT_THAT(beyond->notes,
                testing::Contains("5 of 30 rows lie beyond a pole; they are left out"));
    const auto onPole = capFrom(90.5);
    ASSERT_TRUE(onPole.ok()) << onPole.status();
    EXPECT_THAT(onPole->notes, testing::Not(testing::Contains(HasSubstr("beyond a pole"))));
    const auto south = capFrom(-62.5);
    ASSERT_TRUE(south.ok()) << south.status();
    EXPECT_THAT(south->notes,
                testing::Contains("2 of 30 rows lie beyond a pole; they are left out"));
}

/// Grids with posts on the poles, and on the meridian where they begin, twice, reach half a pixel
/// beyond both; others do by a rounding. Pixels of a degree, see below.
TEST_F(HardCase26, GridsBeyondThePolesAndATurnHaveAllOfTheEarth) {
    struct Case {
        double west, north, pixel;
        int columns, rows;
    };
    for (const Case& one : {Case{-180.5, 90.5, 1, 361, 181}, Case{-0.5, 90.5, 1, 361, 181},
                            Case{0, 90, 1 + 1e-12, 360, 180}}) {
        const auto dem = test::readDem(write({.epsg = kDegrees,
                                              .west = one.west,
                                              .north = one.north,
                                              .pixel = one.pixel,
                                              .columns = one.columns,
                                              .rows = one.rows,
                                              .height = deep}));
        ASSERT_TRUE(dem.ok()) << dem.status();
        EXPECT_THAT(dem->crsWkt, HasSubstr("Equidistant cylindrical"));
        EXPECT_EQ(dem->grid.columns, 360);
        EXPECT_EQ(dem->grid.rows, 180);
        const Checked found = check(*dem, fromCrs(dem->crsWkt), [&](const Place& at) {
            const double turns = std::floor((at.longitude - one.west) / 360);
            const double east = at.longitude - one.west - 360 * turns;
            return east > 1 && east < 359 && std::abs(at.latitude) < 89.2;
        });
        EXPECT_GT(found.posts, 63000);
        EXPECT_EQ(found.open, 0) << one.west;
        EXPECT_LE(found.worst, 26);
    }
}

/// Tiles of one grid that go once around, or a rounding or a column farther.
TEST_F(HardCase26, TilesAroundTheEarthHaveAllOfIt) {
    struct Case {
        double west, pixel;
        int columns;  ///< of each tile; the second begins one earlier where both have a column
        bool overlaps;
    };
    for (const Case& one :
         {Case{-180, 1, 180, false}, Case{0, 1 + 1e-12, 180, false}, Case{-180.5, 1, 181, true}}) {
        std::vector<std::string> tiles;
        for (const int half : {0, 1})
            tiles.push_back(
                write({.epsg = kDegrees,
                       .west = one.west + half * (one.columns - (one.overlaps ? 1 : 0)) * one.pixel,
                       .north = 90,
                       .pixel = one.pixel,
                       .columns = one.columns,
                       .rows = 180,
                       .height = deep}));
        for (int order = 0; order < 2; ++order) {
            const auto dem = test::readDems(tiles);
            ASSERT_TRUE(dem.ok()) << dem.status();
            const Checked found = check(*dem, fromCrs(dem->crsWkt), [](const Place& at) {
                return std::abs(at.latitude) < 89.2;
            });
            EXPECT_GT(found.posts, 63000);
            EXPECT_EQ(found.open, 0) << one.west << ", " << one.columns << " order " << order;
            std::ranges::reverse(tiles);
        }
    }
}

/// Weather models' earth, the moon and Mars: every post lies as far from its neighbour as on the
/// body's ground.
TEST_F(HardCase26, DegreesOnOtherBodiesAreBroughtToTheirMetres) {
    struct Case {
        double radius, inverseFlattening, south;
        const char* projection;
    };
    for (const Case& one : {Case{6371229, 0, 45, "Transverse Mercator around 12, 47"},
                            Case{1737400, 0, 20, "Transverse Mercator around 12, 22"},
                            Case{1737400, 0, 86, "UPS North"}, Case{1737400, 0, -90, "UPS South"},
                            Case{3396190, 169.8944472, 86, "UPS North"}}) {
        const std::string crs =
            fmt::format(R"(GEOGCS["body",DATUM["body",SPHEROID["body",{},{}]],)"
                        R"(PRIMEM["meridian",0],UNIT["degree",0.0174532925199433]])",
                        one.radius, one.inverseFlattening);
        const auto dem = test::readDem(write({.crs = crs.c_str(),
                                              .west = 10,
                                              .north = one.south + 4,
                                              .pixel = 0.1,
                                              .columns = 40,
                                              .rows = 40,
                                              .height = constant(5)}));
        ASSERT_TRUE(dem.ok()) << one.projection << dem.status();
        EXPECT_THAT(dem->crsWkt, HasSubstr(one.projection));
        EXPECT_THAT(dem->notes, testing::Not(testing::Contains(HasSubstr("too great or too"))));
        const double area =
            one.radius * one.radius * (4 * M_PI / 180) *
            std::abs(std::sin((one.south + 4) * M_PI / 180) - std::sin(one.south * M_PI / 180));
        const auto posts = std::ranges::count_if(dem->grid.heights, [](float h) { return h == 5; });
        EXPECT_NEAR(static_cast<double>(posts) * dem->grid.perColumn.x * dem->grid.perRow.y / area,
                    1, 0.05)
            << one.projection;
    }
}

TEST_F(HardCase26, DegreesOfARotatedPoleAreRefused) {
    const std::string path = folder_.path("rotated.vrt");
    std::ofstream(path)
        << R"(<VRTDataset rasterXSize="20" rasterYSize="20"><SRS>GEOGCRS["rot",BASEGEOGCRS["WGS 84",)"
           R"(DATUM["World Geodetic System 1984",ELLIPSOID["WGS 84",6378137,298.257223563]]],)"
           R"(DERIVINGCONVERSION["Rotated_pole",METHOD["PROJ ob_tran o_proj=longlat"],)"
           R"(PARAMETER["o_lon_p",0],PARAMETER["o_lat_p",39.25],PARAMETER["lon_0",18]],)"
           R"(CS[ellipsoidal,2],AXIS["longitude",east],AXIS["latitude",north],)"
           R"(ANGLEUNIT["degree",0.0174532925199433]]</SRS>)"
           R"(<GeoTransform>-28, 0.5, 0, 22, 0, -0.5</GeoTransform>)"
           R"(<VRTRasterBand dataType="Float32" band="1"/></VRTDataset>)";
    EXPECT_THAT(std::string(test::readDem(path).status().message()), HasSubstr("rotated pole"));
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
