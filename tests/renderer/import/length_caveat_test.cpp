// SPDX-License-Identifier: Apache-2.0
// Maps whose lengths are not those on the ground, alone and as what others are brought to.
#include "renderer/import/length_caveat.h"

#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/renderer/import/dem_mosaic_fixture.h"

namespace eyrie::import {
namespace {

using test::DemMosaic;
using test::kDegrees;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kOff = "too great or too small";

/// 100 posts of 100 m on the map, around 9 east, 47 north.
test::Raster webMercator(const std::function<double(double, double)>& height) {
    return {.epsg = 3857,
            .west = 1000000,
            .north = 5950000,
            .pixel = 100,
            .columns = 100,
            .rows = 100,
            .height = height};
}

/// J. P. Snyder, Map Projections: A Working Manual (1987), page 44: a map of the sphere is
/// stretched by 1 / cos 47.05, 46.8 %; the ellipsoid's ground to the north is 0.1 % less.
TEST_F(DemMosaic, TellsHowFarLengthsInWebMercatorAreOff) {
    const std::string map = write(webMercator(constant(1)));
    const std::string degrees = write(
        {.epsg = kDegrees, .west = 8.99, .north = 47.1, .pixel = 0.01, .height = constant(1)});
    for (const std::vector<std::string>& rasters : {std::vector{map}, std::vector{map, degrees}}) {
        const auto dem = test::readDems(rasters);
        ASSERT_TRUE(dem.ok()) << dem.status();
        EXPECT_THAT(dem->notes,
                    Contains(HasSubstr("lengths in WGS 84 / Pseudo-Mercator are up to 47.")));
    }
}

TEST_F(DemMosaic, TellsNothingOfLengthsThatAreNearlyThoseOnTheGround) {
    for (const test::Raster& raster :
         {test::Raster{.west = 500000, .north = 5200100, .height = constant(1)},
          test::Raster{.epsg = 2263, .west = 1000000, .north = 205000, .height = constant(1)},
          test::Raster{.epsg = 3413, .west = -50, .north = -2000000, .height = constant(1)},
          test::Raster{.epsg = 0, .height = constant(1)}}) {
        const auto dem = test::readDem(write(raster));
        ASSERT_TRUE(dem.ok()) << dem.status();
        EXPECT_THAT(dem->notes, Not(Contains(HasSubstr(kOff)))) << raster.epsg;
    }
}

/// In UTM lengths 18 degrees from the zone's meridian are 5 % too great on the equator.
TEST_F(DemMosaic, TellsOfLengthsInAZoneThatIsTooWide) {
    const auto notes = [&](int degrees) {
        const auto dem = test::readDem(write({.epsg = kDegrees,
                                              .west = -9,
                                              .north = 5,
                                              .pixel = 0.1,
                                              .columns = 10 * degrees,
                                              .rows = 100,
                                              .height = constant(1)}));
        EXPECT_TRUE(dem.ok()) << dem.status();
        return dem.ok() ? dem->notes : std::vector<std::string>{};
    };
    EXPECT_THAT(notes(30), Contains(HasSubstr("zone 32N are up to 5.1 % too great or too small")));
    EXPECT_THAT(notes(6), Not(Contains(HasSubstr(kOff))));
}

/// Where longitudes leap the map's scale, 3 % less than 1 at the pole, goes on.
TEST_F(DemMosaic, TellsOfLengthsAcrossAPoleAsBesideIt) {
    const auto dem = test::readDem(write({.epsg = 3413,
                                          .west = -100000,
                                          .north = 100000,
                                          .pixel = 1000,
                                          .columns = 200,
                                          .rows = 200,
                                          .height = constant(1)}));
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_THAT(dem->notes, Contains(HasSubstr("are up to 3.0 %")));
}

}  // namespace
}  // namespace eyrie::import
