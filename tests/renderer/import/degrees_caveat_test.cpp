// SPDX-License-Identifier: Apache-2.0
// Grids without a CRS whose coordinates, which are taken for metres, are likely degrees.
#include "renderer/import/degrees_caveat.h"

#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/renderer/import/dem_mosaic_fixture.h"

namespace eyrie::import {
namespace {

using test::DemMosaic;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kCaveat = "if they are degrees";

class DegreesCaveat : public DemMosaic {
protected:
    std::vector<std::string> notesOf(const std::vector<std::string>& rasters) {
        const auto report = importTerrain(rasters, folder_.path("out.eyt"), {}, {});
        EXPECT_TRUE(report.ok()) << report.status();
        return report.ok() ? report->notes : std::vector<std::string>{};
    }
    std::vector<std::string> notesOf(const test::Raster& raster) {
        return notesOf({write(raster)});
    }
};

/// 100 posts of a hundredth of a unit, with a relief of 200 m.
test::Raster hundredths(double west) {
    return {.epsg = 0,
            .west = west,
            .north = 47,
            .pixel = 0.01,
            .columns = 100,
            .rows = 100,
            .height = [west](double x, double) { return 400 + 200 * (x - west); }};
}

TEST_F(DegreesCaveat, TellsOfPostsThatRiseSteeplyWithinLongitudesAndLatitudes) {
    EXPECT_THAT(notesOf(hundredths(8)),
                Contains(HasSubstr("(8.005 to 8.995 east, 46.005 to 46.995 north)")));
    EXPECT_THAT(notesOf({write(hundredths(8)), write(hundredths(9))}),
                Contains(HasSubstr("(8.005 to 9.995 east, 46.005 to 46.995 north)")));
}

TEST_F(DegreesCaveat, TellsOfACrsOfNoPlaceAsOfNone) {
    test::Raster raster = hundredths(8);
    raster.epsg = test::kUtm32;
    raster.crs = R"(LOCAL_CS["Arbitrary",UNIT["metre",1]])";
    EXPECT_THAT(notesOf(raster), Contains(HasSubstr(kCaveat)));
    raster.crs = R"(LOCAL_CS["site",UNIT["foot",0.3048]])";
    EXPECT_THAT(notesOf(raster), Not(Contains(HasSubstr(kCaveat))));
}

/// A site with a tree, in a grid of its own; and ground of a tenth of a degree.
TEST_F(DegreesCaveat, TellsNothingOfASmallPatchInMetres) {
    test::Raster patch{
        .epsg = 0,
        .west = 0,
        .north = 10,
        .pixel = 0.1,
        .columns = 100,
        .rows = 100,
        .height = [](double x, double y) { return x * 0.5 + (y > 9 && x > 9 ? 25 : 0); }};
    EXPECT_THAT(notesOf(patch), Not(Contains(HasSubstr(kCaveat))));
    patch.pixel = 0.001;
    patch.height = [](double x, double) { return 100 * x; };
    EXPECT_THAT(notesOf(patch), Contains(HasSubstr(kCaveat)));
}

TEST_F(DegreesCaveat, TellsNothingOfWhatCannotBeDegrees) {
    test::Raster north = hundredths(8);
    north.north = 91;
    EXPECT_THAT(notesOf(north), Not(Contains(HasSubstr(kCaveat))));
    test::Raster utm = hundredths(8);
    utm.epsg = test::kUtm32;
    EXPECT_THAT(notesOf(utm), Not(Contains(HasSubstr(kCaveat))));
}

TEST_F(DegreesCaveat, TellsNothingOfAPictureWithoutAPlace) {
    const std::string path = folder_.path("heights.pgm");
    std::ofstream(path, std::ios::binary) << "P5\n3 3\n255\n"
                                          << std::string("\0\xff\0\0\0\0\0\0\0", 9);
    const std::vector<std::string> notes = notesOf({path});
    EXPECT_THAT(notes, Contains(HasSubstr("not georeferenced")));
    EXPECT_THAT(notes, Not(Contains(HasSubstr(kCaveat))));
}

}  // namespace
}  // namespace eyrie::import
