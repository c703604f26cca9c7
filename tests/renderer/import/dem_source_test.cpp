// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/dem_source.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include "fabric/partial_file.h"
#include "renderer/import/gdal_handles.h"
#include "renderer/import/geotiff_writer.h"
#include "renderer/import/terrain_synth.h"
#include "renderer/import/whole_file.h"
#include "tests/renderer/import/terrain_fixture.h"
#include "tests/support/page_server.h"

namespace eyrie::import {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

constexpr const char* kSharedData = EYRIE_SOURCE_DIR "/../shared/data/";

class DemSource : public testing::Test {
protected:
    std::string written(const std::string& name, const std::string& text) const {
        std::ofstream(folder_.path(name), std::ios::binary) << text;
        return folder_.path(name);
    }

    /// An ESRI ASCII grid, 10 m posts, lower left corner at (1000, 2000).
    std::string asciiGrid(int columns, int rows, const std::string& values) const {
        return written("grid.asc",
                       "ncols " + std::to_string(columns) + "\nnrows " + std::to_string(rows) +
                           "\nxllcorner 1000\nyllcorner 2000\ncellsize 10\nNODATA_value -9999\n" +
                           values + "\n");
    }

    /// A virtual raster over a 3 x 2 grid of 0 to 5, with `dataset` and `band` elements of one's
    /// own.
    std::string virtualRaster(const std::string& dataset, const std::string& band,
                              const std::string& bandType = "Float32", int columns = 3,
                              int rows = 2) const {
        const std::string source = asciiGrid(3, 2, "0 1 2\n3 4 5");
        return written("virtual.vrt",
                       "<VRTDataset rasterXSize=\"" + std::to_string(columns) +
                           "\" rasterYSize=\"" + std::to_string(rows) + "\">" + dataset +
                           "<VRTRasterBand dataType=\"" + bandType + "\" band=\"1\">" + band +
                           "<SimpleSource><SourceFilename relativeToVRT=\"0\">" + source +
                           "</SourceFilename><SourceBand>1</SourceBand></SimpleSource>"
                           "</VRTRasterBand></VRTDataset>");
    }

    void expectRefused(const std::string& path, absl::StatusCode code,
                       const std::string& words) const {
        testing::internal::CaptureStderr();
        const auto dem = test::readDem(path);
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
        EXPECT_EQ(dem.status().code(), code) << path << ": " << dem.status();
        EXPECT_THAT(dem.status().ToString(), HasSubstr(words));
        EXPECT_THAT(dem.status().ToString(), HasSubstr(path));
    }

    TemporaryFolder folder_;
};

TEST_F(DemSource, IsGivenUpWhenItsServerStopsUnlessTheUserSaysOtherwise) {
    const auto patience = [] { return CPLGetConfigOption("GDAL_HTTP_LOW_SPEED_TIME", nullptr); };
    {
        const QuietGdal outer;
        const QuietGdal inner;
        EXPECT_STREQ(patience(), "20");
    }
    EXPECT_EQ(patience(), nullptr);
    CPLSetConfigOption("GDAL_HTTP_LOW_SPEED_TIME", "300");
    {
        const QuietGdal gdal;
        EXPECT_STREQ(patience(), "300");
    }
    EXPECT_STREQ(patience(), "300");
    CPLSetConfigOption("GDAL_HTTP_LOW_SPEED_TIME", nullptr);
}

TEST_F(DemSource, PutsTheSouthernRowFirstAndPostsOnPixelCentres) {
    const auto dem = test::readDem(asciiGrid(3, 2, "0 1 2\n3 4 -9999"));
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_EQ(dem->grid.columns, 3);
    EXPECT_EQ(dem->grid.rows, 2);
    EXPECT_EQ(dem->grid.at(0, 0), 3);
    EXPECT_EQ(dem->grid.at(2, 1), 2);
    EXPECT_TRUE(std::isnan(dem->grid.at(2, 0)));
    EXPECT_THAT(dem->findings, testing::IsEmpty());
    EXPECT_EQ(dem->grid.origin, fabric::Vec2(1005, 2005));
    EXPECT_EQ(dem->grid.perColumn, fabric::Vec2(10, 0));
    EXPECT_EQ(dem->grid.perRow, fabric::Vec2(0, 10));
    EXPECT_NE(dem->sourceHash, 0U);
}

TEST_F(DemSource, AppliesScaleOffsetAndFeet) {
    const auto dem = test::readDem(
        virtualRaster("", "<UnitType>ft</UnitType><Offset>100</Offset><Scale>2</Scale>"));
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_FLOAT_EQ(dem->grid.at(0, 1), 30.48F);
    EXPECT_FLOAT_EQ(dem->grid.at(2, 0), 110 * 0.3048F);
    EXPECT_THAT(dem->notes, testing::Contains(HasSubstr("ft")));
}

TEST_F(DemSource, TurnsUnitsOfTheCrsToMetres) {
    const auto dem = test::readDem(virtualRaster(
        "<SRS>EPSG:2263</SRS><GeoTransform>1000,100,0,5000,0,-100</GeoTransform>", ""));
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_NEAR(dem->grid.perColumn.x, 100 * 1200.0 / 3937, 1e-9);
    EXPECT_NEAR(dem->grid.origin.x, 1050 * 1200.0 / 3937, 1e-9);
}

TEST_F(DemSource, SaysWhereNothingTellsTheUnitOfHeightsBesidePlacesInFeet) {
    const std::string place = "<GeoTransform>1000,100,0,5000,0,-100</GeoTransform>";
    const auto notesOf = [&](const std::string& crs, const std::string& band) {
        const auto dem = test::readDem(virtualRaster("<SRS>" + crs + "</SRS>" + place, band));
        EXPECT_TRUE(dem.ok()) << dem.status();
        return dem.ok() ? dem->notes : std::vector<std::string>();
    };
    const auto isSaid = testing::Contains(HasSubstr("nothing says the unit of its heights"));
    EXPECT_THAT(notesOf("EPSG:2263", ""), isSaid);
    EXPECT_THAT(notesOf("EPSG:2263", "<UnitType>m</UnitType>"), testing::Not(isSaid));
    EXPECT_THAT(notesOf("EPSG:2263+6360", ""), testing::Not(isSaid));
    EXPECT_THAT(notesOf("EPSG:32632", ""), testing::Not(isSaid));
}

TEST_F(DemSource, GoesByTheCrsWhereAUnitIsUnknown) {
    const auto dem = test::readDem(virtualRaster(
        "<SRS>EPSG:26910+6360</SRS><GeoTransform>500000,10,0,5200000,0,-10</GeoTransform>",
        "<UnitType>Fuss</UnitType>"));
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_FLOAT_EQ(dem->grid.at(2, 0), static_cast<float>(5 * 1200.0 / 3937));
    EXPECT_THAT(dem->notes, testing::Contains(HasSubstr("'Fuss' is unknown")));
}

/// As EHdr has where a colour table lies beside it.
TEST_F(DemSource, TakesHeightsThatHaveColours) {
    const std::string colours =
        "<ColorInterp>Palette</ColorInterp><ColorTable><Entry c1=\"0\" c2=\"90\" c3=\"0\" "
        "c4=\"255\"/></ColorTable>";
    const auto dem = test::readDem(virtualRaster("", colours, "Int16"));
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_EQ(dem->grid.at(2, 0), 5);
    expectRefused(virtualRaster("", colours, "Byte"), absl::StatusCode::kInvalidArgument,
                  "palette indices");
    expectRefused(virtualRaster("", "<ColorInterp>Red</ColorInterp>", "Int16"),
                  absl::StatusCode::kInvalidArgument, "a picture's");
}

/// Where a post's coordinates are on the earth by the CRS that a terrain says it has.
fabric::Vec2 degreesOf(const std::string& wkt, fabric::Vec2 place) {
    OGRSpatialReference from;
    EXPECT_EQ(from.importFromWkt(wkt.c_str()), OGRERR_NONE) << wkt;
    OGRSpatialReference degrees;
    degrees.importFromEPSG(4269);
    for (OGRSpatialReference* crs : {&from, &degrees})
        crs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> there(
        OGRCreateCoordinateTransformation(&from, &degrees));
    EXPECT_NE(there, nullptr);
    EXPECT_TRUE(there != nullptr && there->Transform(1, &place.x, &place.y));
    return place;
}

TEST_F(DemSource, TheCrsOfFeetTurnedToMetresIsOneOfMetres) {
    constexpr double kMetresPerFoot = 1200.0 / 3937;  // EPSG:2263's
    OGRSpatialReference file;
    ASSERT_EQ(file.importFromEPSG(2263), OGRERR_NONE);
    const fabric::Vec2 expected =
        degreesOf(wktOf(OGRSpatialReference::ToHandle(&file)), {1000050, 204950});
    for (const char* crs : {"EPSG:2263", "EPSG:2263+6360"}) {
        const auto dem = test::readDem(virtualRaster(
            fmt::format("<SRS>{}</SRS><GeoTransform>1000000,100,0,205000,0,-100</GeoTransform>",
                        crs),
            ""));
        ASSERT_TRUE(dem.ok()) << dem.status();
        const fabric::Vec2 first{1000050 * kMetresPerFoot, 204950 * kMetresPerFoot};
        const fabric::Vec2 found = degreesOf(dem->crsWkt, first);
        EXPECT_NEAR(found.x, expected.x, 1e-9) << crs;
        EXPECT_NEAR(found.y, expected.y, 1e-9) << crs;
        EXPECT_THAT(dem->crsWkt, testing::Not(HasSubstr("US survey foot"))) << crs;
    }
}

TEST_F(DemSource, KeepsARotatedGridRightHanded) {
    const auto dem = test::readDem(std::string(kSharedData) + "hard/dem/rio_rotated.tif");
    ASSERT_TRUE(dem.ok()) << dem.status();
    const terrain::HeightGrid& grid = dem->grid;
    EXPECT_NEAR(glm::length(grid.perColumn), 20, 1e-9);
    EXPECT_NEAR(glm::length(grid.perRow), 10, 1e-9);
    EXPECT_GT(grid.perColumn.x * grid.perRow.y - grid.perColumn.y * grid.perRow.x, 0);
    EXPECT_NE(grid.perColumn.y, 0);
}

TEST_F(DemSource, ReprojectsDegreesToTheUtmZoneOfTheirCentre) {
    struct Case {
        const char* transform;
        const char* crs;
    };
    const Case cases[] = {{"9,0.001,0,47,0,-0.001", "UTM zone 32N"},
                          {"-70,0.001,0,-33,0,-0.001", "UTM zone 19S"},
                          {"359.5,0.001,0,10,0,-0.001", "UTM zone 30N"},
                          {"20,0.001,0,86,0,-0.001", "UPS North"},
                          {"20,0.001,0,-86,0,-0.001", "UPS South"}};
    for (const Case& example : cases) {
        const auto dem = test::readDem(
            virtualRaster("<SRS dataAxisToSRSAxisMapping=\"2,1\">EPSG:4326</SRS><GeoTransform>" +
                              std::string(example.transform) + "</GeoTransform>",
                          ""));
        ASSERT_TRUE(dem.ok()) << dem.status();
        EXPECT_THAT(dem->crsWkt, HasSubstr(example.crs)) << example.transform;
        EXPECT_EQ(dem->grid.perColumn.x, dem->grid.perRow.y);
        for (const float h : dem->grid.heights)
            EXPECT_TRUE(std::isnan(h) || (h >= 0 && h <= 5)) << h;
    }
}

TEST_F(DemSource, ReadsEverythingThatIsNoHeightAsNodata) {
    const auto dem = test::readDem(
        written("grid.asc",
                "ncols 4\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n"
                "1.5 nan inf -9999\n-3.4e38 3.4e38 2 -32768\n"));
    ASSERT_TRUE(dem.ok()) << dem.status();
    std::string pattern;
    for (const float h : dem->grid.heights) pattern += std::isnan(h) ? '-' : 'x';
    EXPECT_EQ(pattern, "--xxx---");  // -32768 is a height unless the raster has 16 bits
    EXPECT_THAT(dem->findings,
                testing::ElementsAre(HasSubstr("3.4028235e+38 in column 2 and row 0")));
}

/// Floats of a raster, which text grids cannot hold; declared to be nodata, the other one, or none.
TEST_F(DemSource, ReadsInfinitiesAsNodataWhetherDeclaredOrNot) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const terrain::HeightGrid grid{
        .columns = 3, .rows = 2, .heights = {1, kInfinity, 2, -kInfinity, 3, 4}};
    ASSERT_TRUE(writeGeoTiff(grid, folder_.path("infinite.tif")).ok());
    struct Case {
        const char* nodata;
        const char* found;  ///< what was not declared
    };
    for (const auto& [nodata, found] :
         {Case{"", "-inf in column 0 and row 0"},
          Case{"<NoDataValue>inf</NoDataValue>", "-inf in column 0 and row 0"},
          Case{"<NoDataValue>-inf</NoDataValue>", "inf in column 1 and row 1"}}) {
        const auto dem = test::readDem(written(
            "infinite.vrt",
            std::string("<VRTDataset rasterXSize=\"3\" rasterYSize=\"2\"><GeoTransform>0, 1, 0, "
                        "0, 0, -1</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\">") +
                nodata +
                "<SimpleSource><SourceFilename relativeToVRT=\"1\">infinite.tif</SourceFilename>"
                "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>"));
        ASSERT_TRUE(dem.ok()) << nodata << dem.status();
        std::string pattern;
        for (const float h : dem->grid.heights) pattern += std::isnan(h) ? '-' : 'x';
        EXPECT_EQ(pattern, "x-x-xx") << nodata;
        EXPECT_THAT(dem->findings, testing::ElementsAre(testing::StartsWith(found))) << nodata;
    }
}

TEST_F(DemSource, SaysWhereOnlyScaleOrOffsetMakeHeightsImpossible) {
    const auto dem = test::readDem(virtualRaster("", "<Offset>0</Offset><Scale>1e38</Scale>"));
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_EQ(std::ranges::count_if(dem->grid.heights, [](float h) { return std::isnan(h); }), 5);
    EXPECT_THAT(dem->findings, testing::ElementsAre(HasSubstr("1e+38 in column 1 and row 0")));
}

/// Of which floats have every second one only.
TEST_F(DemSource, HeightsBesideNodataAreHeightsHoweverLargeTheyAre) {
    const std::string source =
        written("large.asc",
                "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value 16777217\n"
                "16777216 16777217 16777218\n1 2 3\n");
    const std::string wide = written(
        "wide.vrt",
        "<VRTDataset rasterXSize=\"3\" rasterYSize=\"2\"><VRTRasterBand dataType=\"Float64\" "
        "band=\"1\"><NoDataValue>16777217</NoDataValue><Scale>0.001</Scale><SimpleSource>"
        "<SourceFilename relativeToVRT=\"1\">large.asc</SourceFilename><SourceBand>1</SourceBand>"
        "</SimpleSource></VRTRasterBand></VRTDataset>");
    for (const auto& [path, scale] : {std::pair(source, 1.0F), {wide, 0.001F}}) {
        const auto dem = test::readDem(path);
        ASSERT_TRUE(dem.ok()) << dem.status();
        EXPECT_FLOAT_EQ(dem->grid.at(0, 1), 16777216 * scale);
        EXPECT_TRUE(std::isnan(dem->grid.at(1, 1))) << path;
        EXPECT_FLOAT_EQ(dem->grid.at(2, 1), 16777218 * scale);
    }
}

TEST_F(DemSource, NodataOfFloatsMayHaveMoreDigits) {
    const auto dem =
        test::readDem(written("grid.asc",
                              "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n"
                              "NODATA_value -9999.9\n1.5 -9999.9\n2 3\n"));
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_EQ(dem->grid.at(0, 1), 1.5F);
    EXPECT_TRUE(std::isnan(dem->grid.at(1, 1)));
}

TEST_F(DemSource, HeightsBeyondWhatScenesReachAreNodata) {
    const auto dem = test::readDem(asciiGrid(3, 2, "1e20 -1.01e14 0.5\n9.9e13 -9.9e13 1"));
    ASSERT_TRUE(dem.ok()) << dem.status();
    std::string pattern;
    for (const float h : dem->grid.heights) pattern += std::isnan(h) ? '-' : 'x';
    EXPECT_EQ(pattern, "xxx--x");
    EXPECT_THAT(dem->findings, testing::ElementsAre(HasSubstr("1e+20 in column 0 and row 0")));
}

TEST_F(DemSource, ReadsTheLowest16BitValueAsNodata) {
    const auto dem = test::readDem(
        virtualRaster("", "<NoDataValue>-32678</NoDataValue><Offset>0</Offset>", "Int16"));
    ASSERT_TRUE(dem.ok()) << dem.status();
    const auto hole = test::readDem(std::string(kSharedData) + "hard/dem/N44E005_big_hole.tif.gz");
    ASSERT_TRUE(hole.ok()) << hole.status();
    for (const float h : hole->grid.heights) ASSERT_TRUE(std::isnan(h) || h > -100) << h;
}

/// As GDAL before 3.7 tells bytes that are signed.
TEST_F(DemSource, ReadsSignedBytesAsSuch) {
    const std::string source = asciiGrid(3, 2, "0 1 127 128 214 255");
    const auto dem = test::readDem(
        written("signed.vrt",
                "<VRTDataset rasterXSize=\"3\" rasterYSize=\"2\">"
                "<VRTRasterBand dataType=\"Byte\" band=\"1\"><NoDataValue>-42</NoDataValue>"
                "<Metadata domain=\"IMAGE_STRUCTURE\"><MDI key=\"PIXELTYPE\">SIGNEDBYTE</MDI>"
                "</Metadata><SimpleSource><SourceFilename relativeToVRT=\"0\">" +
                    source +
                    "</SourceFilename><SourceBand>1</SourceBand></SimpleSource>"
                    "</VRTRasterBand></VRTDataset>"));
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_EQ(dem->grid.at(0, 0), -128);
    EXPECT_TRUE(std::isnan(dem->grid.at(1, 0)));
    EXPECT_EQ(dem->grid.at(2, 0), -1);
    EXPECT_EQ(dem->grid.at(2, 1), 127);
}

/// The source as its own mask: the one post of 0 is none.
TEST_F(DemSource, LeavesOpenWhatABandsOwnMaskHides) {
    const auto dem = test::readDem(
        virtualRaster("",
                      "<MaskBand><VRTRasterBand dataType=\"Byte\"><SimpleSource>"
                      "<SourceFilename relativeToVRT=\"1\">grid.asc</SourceFilename>"
                      "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></MaskBand>"));
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_TRUE(std::isnan(dem->grid.at(0, 1)));
    EXPECT_EQ(dem->grid.at(1, 1), 1);
    EXPECT_EQ(dem->grid.at(2, 0), 5);
}

/// As gdalwarp -dstalpha writes it: of floats, which GDAL's own masks leave out.
TEST_F(DemSource, LeavesOpenWhereAnAlphaBandIsZero) {
    const std::string source =
        "<SimpleSource><SourceFilename relativeToVRT=\"0\">" + asciiGrid(3, 2, "0 1 2 3 4 5") +
        "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand>";
    const auto dem = test::readDem(written("alpha.vrt",
                                           "<VRTDataset rasterXSize=\"3\" rasterYSize=\"2\">"
                                           "<VRTRasterBand dataType=\"Float32\" band=\"1\">" +
                                               source +
                                               "<VRTRasterBand dataType=\"Float32\" band=\"2\">"
                                               "<ColorInterp>Alpha</ColorInterp>" +
                                               source + "</VRTDataset>"));
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_TRUE(std::isnan(dem->grid.at(0, 1)));
    EXPECT_EQ(dem->grid.at(1, 1), 1);
}

TEST_F(DemSource, RefusesWhatSaysWhereItIsWithoutAGeotransform) {
    constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;
    expectRefused(virtualRaster("<GCPList Projection=\"EPSG:32632\">"
                                "<GCP Id=\"1\" Pixel=\"0\" Line=\"0\" X=\"500000\" Y=\"5000000\"/>"
                                "</GCPList>",
                                ""),
                  kInvalid, "ground control points");
    expectRefused(
        virtualRaster("<Metadata domain=\"RPC\"><MDI key=\"LINE_OFF\">1</MDI></Metadata>", ""),
        kInvalid, "gdalwarp -rpc");
    expectRefused(virtualRaster("<Metadata domain=\"GEOLOCATION\"><MDI key=\"X_BAND\">1</MDI>"
                                "</Metadata>",
                                ""),
                  kInvalid, "gdalwarp -geoloc");
    expectRefused(virtualRaster("<SRS dataAxisToSRSAxisMapping=\"2,1\">EPSG:4326</SRS>", ""),
                  kInvalid, "brought from degrees to metres");
}

TEST_F(DemSource, NamesARasterOfAnArchiveOfSeveralFiles) {
    const std::string archive = folder_.path("several.zip");
    const std::string grid = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n";
    GDALAllRegister();
    for (const auto& [name, text] :
         {std::pair<const char*, std::string>{"readme.txt", "About it."}, {"dem/1.asc", grid}}) {
        VSILFILE* const file = VSIFOpenL(("/vsizip/" + archive + "/" + name).c_str(), "wb");
        ASSERT_NE(file, nullptr);
        VSIFWriteL(text.data(), 1, text.size(), file);
        VSIFCloseL(file);
    }
    const std::string inside = "/vsizip/" + archive + "/dem/1.asc";
    expectRefused(archive, absl::StatusCode::kInvalidArgument, "such as " + inside);
    EXPECT_TRUE(test::readDem(inside).ok());
}

TEST_F(DemSource, LooksIntoArchivesHoweverTheirNamesAreWritten) {
    const std::string grid = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n";
    GDALAllRegister();
    const auto pack = [&](const std::string& name) {
        VSILFILE* const file = VSIFOpenL(name.c_str(), "wb");
        VSIFWriteL(grid.data(), 1, grid.size(), file);
        VSIFCloseL(file);
    };
    const std::string zip = folder_.path("dem.zip");
    pack("/vsizip/" + zip + "/dem.asc");
    pack("/vsigzip/" + folder_.path("DEM.ASC.GZ"));
    EXPECT_TRUE(test::readDem(folder_.path("DEM.ASC.GZ")).ok());
    test::PageServer server(test::contents(zip));
    const auto elsewhere = test::readDem(server.url("dem.zip?version=2"));
    EXPECT_TRUE(elsewhere.ok()) << elsewhere.status();
    std::filesystem::rename(zip, folder_.path("DEM.ZIP"));
    EXPECT_TRUE(test::readDem(folder_.path("DEM.ZIP")).ok());
}

/// The form that SRTM comes in: its driver goes by the name.
TEST_F(DemSource, ReadsTheOnlyFileOfAnArchiveByItsOwnName) {
    constexpr int kSide = 1201;
    std::string heights;
    for (int i = 0; i < kSide * kSide; ++i) heights += std::string("\x01\xF4", 2);  // 500
    const std::string zip = folder_.path("N46E008.SRTMGL3.hgt.zip");
    GDALAllRegister();
    VSILFILE* const file = VSIFOpenL(("/vsizip/" + zip + "/N46E008.hgt").c_str(), "wb");
    ASSERT_NE(file, nullptr);
    VSIFWriteL(heights.data(), 1, heights.size(), file);
    VSIFCloseL(file);
    const auto dem = test::readDem(zip);
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_EQ(dem->grid.at(dem->grid.columns / 2, dem->grid.rows / 2), 500);
    std::filesystem::rename(zip, folder_.path("N46E008.zip"));
    EXPECT_TRUE(test::readDem(folder_.path("N46E008.zip")).ok());
}

TEST_F(DemSource, RefusesWhatIsNoRaster) {
    expectRefused(folder_.path("none.tif"), absl::StatusCode::kNotFound, "no such file");
    expectRefused(written("text.tif", "not a raster at all"), absl::StatusCode::kInvalidArgument,
                  "is no raster");
    expectRefused(written("empty.tif", ""), absl::StatusCode::kInvalidArgument, "is no raster");
    expectRefused(written("broken.tif.gz", "not gzip"), absl::StatusCode::kInvalidArgument,
                  "is no raster");
    const auto folder = test::readDem(folder_.path(""));
    EXPECT_FALSE(folder.ok());
}

TEST_F(DemSource, RefusesRastersTooSmallForATriangle) {
    expectRefused(asciiGrid(1, 1, "7"), absl::StatusCode::kInvalidArgument, "1 x 1 posts");
    expectRefused(asciiGrid(5, 1, "1 2 3 4 5"), absl::StatusCode::kInvalidArgument, "5 x 1 posts");
    expectRefused(asciiGrid(1, 3, "1\n2\n3"), absl::StatusCode::kInvalidArgument, "1 x 3 posts");
}

TEST_F(DemSource, RefusesPicturesAndComplexNumbers) {
    const std::string hard = std::string(kSharedData) + "hard/dem/";
    expectRefused(hard + "gt_utm.tif", absl::StatusCode::kInvalidArgument, "palette");
    expectRefused(hard + "rio_RGB.byte.tif.gz", absl::StatusCode::kInvalidArgument, "picture");
    expectRefused(virtualRaster("", "", "CFloat32"), absl::StatusCode::kInvalidArgument, "complex");
}

TEST_F(DemSource, RefusesGeoreferencesWithoutArea) {
    for (const char* transform : {"0,1,0,0,0,0", "0,nan,0,0,0,-1", "0,inf,0,0,0,-1", "0,1,2,0,1,2"})
        expectRefused(
            virtualRaster("<GeoTransform>" + std::string(transform) + "</GeoTransform>", ""),
            absl::StatusCode::kInvalidArgument, "geotransform");
}

TEST_F(DemSource, RefusesPlacesBeyondWhatScenesReach) {
    const auto at = [this](const char* transform) {
        return virtualRaster("<GeoTransform>" + std::string(transform) + "</GeoTransform>", "");
    };
    EXPECT_TRUE(test::readDem(at("-99999999999990,10,0,99999999999990,0,-10")).ok());
    for (const auto& [transform, metres] : {std::pair("2e14,10,0,0,0,-10", "2e+14"),
                                            {"0,10,0,-2e14,0,-10", "-2e+14"},
                                            {"0,6e13,0,0,0,-10", "1.5e+14"},
                                            {"0,10,0,0,0,-1e14", "-1.5e+14"},
                                            {"1e300,1,0,0,0,-1", "1e+300"}})
        expectRefused(at(transform), absl::StatusCode::kInvalidArgument,
                      fmt::format("reaches to {} metres; scenes reach from -1e+14 to 1e+14: give "
                                  "it the right georeference",
                                  metres));
}

TEST_F(DemSource, RefusesDegreesBeyondThePoles) {
    expectRefused(virtualRaster("<SRS dataAxisToSRSAxisMapping=\"2,1\">EPSG:4326</SRS>"
                                "<GeoTransform>-180,120,0,290,0,-90</GeoTransform>",
                                ""),
                  absl::StatusCode::kInvalidArgument, "around latitude 200.0");
}

TEST_F(DemSource, RefusesCoordinatesFromTheEarthsCentre) {
    expectRefused(
        virtualRaster("<SRS>EPSG:4978</SRS><GeoTransform>0,30,0,0,0,-30</GeoTransform>", ""),
        absl::StatusCode::kInvalidArgument, "its CRS (WGS 84) counts from the earth's");
}

TEST_F(DemSource, RefusesMorePostsThanATerrainHoldsBeforeReading) {
    expectRefused(virtualRaster("", "", "Float32", 200000, 200000),
                  absl::StatusCode::kResourceExhausted, "200000 x 200000");
}

TEST_F(DemSource, CallsATruncatedFileUnreadable) {
    const std::string path = folder_.path("cut.tif");
    ASSERT_TRUE(writeGeoTiff(synthesizeTerrain(200, 1), path).ok());
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    EXPECT_FALSE(test::readDem(path).ok());
}

/// What it lacks GDAL reads as zeros.
TEST_F(DemSource, RefusesAFileOfEnviThatIsShorterThanItsHeaderSays) {
    const std::string path = folder_.path("cut.img");
    GDALAllRegister();
    const GDALDatasetH file =
        GDALCreate(GDALGetDriverByName("ENVI"), path.c_str(), 40, 30, 1, GDT_Int16, nullptr);
    GDALFillRaster(GDALGetRasterBand(file, 1), 100, 0);
    GDALClose(file);
    EXPECT_TRUE(test::readDem(path).ok());
    const auto virtualOneOf = [&](const std::string& source) {
        return written("of_" + source + ".vrt",
                       "<VRTDataset rasterXSize=\"40\" rasterYSize=\"30\"><VRTRasterBand "
                       "dataType=\"Int16\" band=\"1\"><SimpleSource><SourceFilename "
                       "relativeToVRT=\"1\">" +
                           source +
                           "</SourceFilename><SourceBand>1</SourceBand></SimpleSource>"
                           "</VRTRasterBand></VRTDataset>");
    };
    const std::string inner = virtualOneOf("cut.img");
    const std::string outer = virtualOneOf("of_cut.img.vrt");
    EXPECT_TRUE(test::readDem(outer).ok());
    std::filesystem::resize_file(path, 2398);
    expectRefused(path, absl::StatusCode::kDataLoss, "has 2398 bytes, and 2400 by its header");
    for (const std::string& referring : {inner, outer}) {
        const absl::Status status = test::readDem(referring).status();
        EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss) << status;
        EXPECT_THAT(status.ToString(), HasSubstr(path + ": has 2398 bytes")) << referring;
    }
}

TEST_F(DemSource, WrittenAnewRemovesWhatAKilledWriterLeft) {
    const std::string path = folder_.path("a.tif");
    std::ofstream(path + ".partial-0123456789abcdef") << "half";
    ASSERT_TRUE(writeGeoTiff(synthesizeTerrain(200, 1), path).ok());
    EXPECT_EQ(folder_.files(), std::vector<std::string>{"a.tif"});
}

TEST_F(DemSource, KeepsItsLockWhileGdalWritesIt) {
    const std::string path = folder_.path("a.tif");
    auto file = WholeFile::create(path);
    ASSERT_TRUE(file.ok()) << file.status();
    GDALClose(GDALCreate(GDALGetDriverByName("GTiff"), file->partialPath().c_str(), 100, 100, 1,
                         GDT_Float32, nullptr));
    fabric::removeAbandoned(path);
    ASSERT_TRUE(file->commit().ok());
    EXPECT_GT(std::filesystem::file_size(path), 100U);
}

TEST_F(DemSource, WritesNothingBesideCompressedFiles) {
    const std::string copy = folder_.path("bigtujunga.tif.gz");
    ASSERT_TRUE(
        std::filesystem::copy_file(std::string(kSharedData) + "terrain/bigtujunga.tif.gz", copy))
        << "shared test data is missing";
    ASSERT_TRUE(test::readDem(copy).ok());
    EXPECT_EQ(folder_.files().size(), 1U);
}

/// Real files: their extremes as their README gives them or, where it does not, as read when the
/// test was written.
struct RealDem {
    const char* path;
    std::int32_t columns;
    std::int32_t rows;
    float min;
    float max;
    bool isExact;  ///< not resampled: minimum and maximum to the last bit
};

class RealDems : public testing::TestWithParam<RealDem> {};

TEST_P(RealDems, AreReadAsDocumented) {
    const RealDem& expected = GetParam();
    const auto dem = test::readDem(std::string(kSharedData) + expected.path);
    ASSERT_TRUE(dem.ok()) << dem.status();
    EXPECT_EQ(dem->grid.columns, expected.columns);
    EXPECT_EQ(dem->grid.rows, expected.rows);
    terrain::HeightStatistics found;
    found.add(dem->grid.heights.data(), static_cast<std::int32_t>(dem->grid.heights.size()));
    if (expected.isExact) {
        EXPECT_EQ(std::lround(found.min), std::lround(expected.min));
        EXPECT_EQ(std::lround(found.max), std::lround(expected.max));
    } else {  // bilinear: between the source's extremes, and near them
        EXPECT_GE(found.min, expected.min);
        EXPECT_LE(found.max, expected.max);
        EXPECT_GE(found.max, expected.max - 60);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Shared, RealDems,
    testing::Values(RealDem{"terrain/bigtujunga.tif.gz", 1197, 643, 315, 2295, true},
                    RealDem{"terrain/SainteHelens.dem.gz", 327, 468, 682, 2543, true},
                    RealDem{"terrain/exploradores_aster_dem.tif", 539, 618, 318, 3960, true},
                    RealDem{"terrain/N44E005_UTM.tif.gz", 922, 1262, 33, 2745, true},
                    RealDem{"terrain/mt_rainier_90m.tif.gz", 991, 1416, 263, 4371, false},
                    RealDem{"terrain/N44W072.hgt.gz", 1030, 1411, 115, 1908, false},
                    RealDem{"terrain/utah_zion_srtm90.tif", 422, 515, 1024, 2892, false},
                    RealDem{"hard/dem/wb_DEM.tif", 237, 188, 212, 1233, true},
                    RealDem{"hard/dem/rio_float_nan.tif", 3, 2, -2, 1, true},
                    RealDem{"hard/dem/rio_rotated.tif", 10, 15, 0, 149, true},
                    RealDem{"hard/dem/RealisticTerrain.ter", 257, 257, -79, 875, true},
                    RealDem{"hard/dem/eudem_N2000000E3000000.tif", 42, 42, 0, 2006, true},
                    RealDem{"hard/dem/richdem_garbrecht_valley.dem", 25, 25, 0, 4, true}),
    [](const auto& tested) {
        std::string name = std::filesystem::path(tested.param.path).filename().string();
        for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
        return name;
    });

}  // namespace
}  // namespace eyrie::import
