// SPDX-License-Identifier: Apache-2.0
// Where pictures lie on a terrain.
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/terrain_import.h"
#include "tests/renderer/import/imagery_import.h"

namespace eyrie::import {
namespace {

using fabric::Rgba;
using test::kSouth;
using test::kWest;
using test::Picture;
using testing::HasSubstr;

using HardCase26 = ImageryImport;

TEST_F(ImageryImport, LaysEachPixelWhereItStands) {
    const auto file = imported(test::slope(90, 70, 10), {write(over(890, 690, 10, waves(1200)))});
    ASSERT_NE(file, nullptr);
    EXPECT_EQ(file->index().imagery->pyramid.texelShift(), 0);
    expectColours(*file, 10, waves(1200));
    EXPECT_GT(file->index().imagery->psnrDb, 38);
    EXPECT_EQ(file->index().imagery->coveredTexels, 89U * 69U);
}

TEST_F(ImageryImport, MayBe64TimesFinerThanTheElevations) {
    const auto file = imported(test::slope(20, 14, 64), {write(over(1216, 832, 1, waves(150)))});
    ASSERT_NE(file, nullptr);
    EXPECT_EQ(file->index().imagery->pyramid.texelShift(), 6);
    EXPECT_EQ(file->index().imagery->pyramid.width(0), 19 * 64);
    expectColours(*file, 64, waves(150));
}

TEST_F(ImageryImport, MayBe64TimesCoarserThanTheElevations) {
    // Bilinear between pixels of 64 m: a wave of 1500 m is off by at most 100 (1 - cos(pi 64 /
    // 1500)).
    const auto file =
        imported(test::slope(1200, 700, 1), {write(over(1199, 699, 64, waves(12000)))});
    ASSERT_NE(file, nullptr);
    EXPECT_EQ(file->index().imagery->pyramid.texelShift(), -6);
    EXPECT_EQ(file->index().imagery->pyramid.width(0), 19);
    expectColours(*file, 1, waves(12000));
}

TEST_F(ImageryImport, MayBeOnePixel) {
    const Rgba colour{200, 120, 40, 255};
    Picture picture = over(100, 100, 1, [=](double, double) { return colour; });
    picture.west = kWest - 50;
    picture.north = kSouth + 150;
    picture.pixel = 200;
    picture.columns = picture.rows = 1;
    const auto file = imported(test::slope(11, 11, 10), {write(picture)});
    ASSERT_NE(file, nullptr);
    expectColours(
        *file, 10, [=](double, double) { return colour; }, 4);
}

TEST_F(ImageryImport, ThatIsCoarserThanTheElevationsCoversTheirRim) {
    const Rgba colour{200, 120, 40, 255};
    const std::pair<std::int32_t, std::int32_t> sizes[] = {{134, 73}, {300, 5}, {5, 300}, {97, 97}};
    for (const auto& [columns, rows] : sizes)
        for (const double pixel : {3.7, 16.0, 1000.0}) {
            Picture picture =
                over(columns - 1, rows - 1, pixel, [=](double, double) { return colour; });
            // To the rim of the terrain and no farther, in pixels as large at most.
            picture.columns = static_cast<int>(std::ceil((columns - 1) / pixel));
            picture.rows = static_cast<int>(std::ceil((rows - 1) / pixel));
            picture.isGeoreferenced = false;
            const auto file = imported(test::slope(columns, rows, 1), {write(picture)});
            ASSERT_NE(file, nullptr);
            const terrain::ImageryIndex& imagery = *file->index().imagery;
            EXPECT_EQ(imagery.coveredTexels, imagery.finestTexels())
                << columns << " x " << rows << " posts, pixels of " << pixel << " m";
        }
}

TEST_F(ImageryImport, BringsPicturesOfAnotherCrsToTheTerrains) {
    // Degrees around 15 E 45 N, where zone 33 has its middle; colours by the exact inverse.
    OGRSpatialReference utm;
    OGRSpatialReference degrees;
    utm.importFromEPSG(test::kUtm33);
    degrees.importFromEPSG(4326);
    degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> project(
        OGRCreateCoordinateTransformation(&degrees, &utm));
    const std::unique_ptr<OGRCoordinateTransformation> inverse(
        OGRCreateCoordinateTransformation(&utm, &degrees));
    double west = kWest;
    double south = kSouth;
    inverse->Transform(1, &west, &south);
    Picture picture{.epsg = 4326,
                    .west = west - 0.001,
                    .north = south + 0.015,
                    .pixel = 0.0001,
                    .columns = 200,
                    .rows = 160,
                    .colour = [&](double x, double y) {
                        project->Transform(1, &x, &y);
                        return waves(1200)(x, y);
                    }};
    const auto file = imported(test::slope(90, 70, 10), {write(picture)});
    ASSERT_NE(file, nullptr);
    expectColours(*file, 10, waves(1200));
}

/// Far from the terrain's meridian its pixels are as large as one likes.
TEST_F(ImageryImport, HasTexelsAsFineAsAPictureOfTheEarthHasPixelsThere) {
    std::ofstream(folder_.path("earth.vrt"))
        << "<VRTDataset rasterXSize=\"43200\" rasterYSize=\"21600\"><SRS>EPSG:4326</SRS>"
           "<GeoTransform>-180, 0.00833333333333333, 0, 90, 0, -0.00833333333333333</GeoTransform>"
           "<VRTRasterBand dataType=\"Byte\" band=\"1\"/></VRTDataset>";
    // 657 by 928 m at 45 degrees.
    const auto file = imported(test::slope(257, 257, 100), {folder_.path("earth.vrt")});
    ASSERT_NE(file, nullptr);
    EXPECT_LE(file->index().imagery->pyramid.texelPosts(0), 1.19 * 6.57);
}

TEST_F(ImageryImport, HasTexelsAsFineAsTheShorterSideOfPixels) {
    terrain::HeightGrid grid = test::slope(200, 200, 10);
    grid.origin = {kWest, 7'767'000};  // 70 degrees north, where a degree is 38 by 111.5 km
    Picture picture{.epsg = 4326,
                    .west = 14.95,
                    .north = 70.04,
                    .pixel = 58 / 111.5e3,
                    .columns = 300,
                    .rows = 150,
                    .colour = waves(1)};
    const auto file = imported(grid, {write(picture)});
    ASSERT_NE(file, nullptr);
    EXPECT_EQ(file->index().imagery->pyramid.texelPosts(0), 2);
}

/// Hard case 26: a picture of all longitudes over a terrain with the pole in it. Expected is the
/// colour of the place that PROJ says.
TEST_F(HardCase26, APictureAroundThePoleCoversEveryTexel) {
    const auto colour = [](double longitude, double latitude) {
        const double x = std::cos(latitude * M_PI / 180) * std::cos(longitude * M_PI / 180);
        const double y = std::cos(latitude * M_PI / 180) * std::sin(longitude * M_PI / 180);
        const auto wave = [](double t) {
            return static_cast<std::uint8_t>(128 + 90 * std::sin(t));
        };
        return Rgba{wave(40 * x), wave(40 * y), wave(30 * (x + y)), 255};
    };
    constexpr int kPosts = 200;
    constexpr double kPost = 3000;
    const fabric::Vec2 first(2e6 - 90.5 * kPost, 2e6 - 110.5 * kPost);  // of the southern row
    GDALAllRegister();
    OGRSpatialReference ups, degrees;
    ups.importFromEPSG(32661);
    ups.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    degrees.importFromEPSG(4326);
    degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    {
        const GDALDatasetUniquePtr dem(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
            folder_.path("pole.tif").c_str(), kPosts, kPosts, 1, GDT_Float32, nullptr));
        std::array<double, 6> transform{
            first.x - kPost / 2, kPost, 0, first.y + (kPosts - 0.5) * kPost, 0, -kPost};
        dem->SetGeoTransform(transform.data());
        dem->SetSpatialRef(&ups);
        dem->GetRasterBand(1)->Fill(100);
    }
    import::TerrainImportOptions options;
    options.imagery = {write({.epsg = 4326,
                              .west = -180,
                              .north = 90,
                              .pixel = 0.05,
                              .columns = 7200,
                              .rows = 100,
                              .colour = colour})};
    const std::string out = folder_.path("pole.eyt");
    const auto report = import::importTerrain({folder_.path("pole.tif")}, out, options, {});
    ASSERT_TRUE(report.ok()) << report.status();
    EXPECT_THAT(report->notes, testing::Not(testing::Contains(HasSubstr("left out"))));
    const auto file = *terrain::EytFile::open(out);
    const test::TexelImage image = test::wholeLevel(*file, 0);
    const double texel = kPost * file->index().imagery->pyramid.texelPosts(0);
    const std::unique_ptr<OGRCoordinateTransformation> place(
        OGRCreateCoordinateTransformation(&ups, &degrees));
    int open = 0, wrong = 0;
    for (std::int64_t j = 0; j < image.height; ++j)
        for (std::int64_t i = 0; i < image.width; ++i) {
            double x = first.x + (static_cast<double>(i) + 0.5) * texel;
            double y = first.y + (static_cast<double>(j) + 0.5) * texel;
            if (x > first.x + (kPosts - 1) * kPost || y > first.y + (kPosts - 1) * kPost)
                continue;
            place->Transform(1, &x, &y);
            open += image.at(i, j).a == 0 ? 1 : 0;
            wrong += difference(image.at(i, j), colour(x, y)) > 2 * kTolerance ? 1 : 0;
        }
    EXPECT_EQ(open, 0) << "of " << image.texels.size();
    EXPECT_EQ(wrong, 0) << "of " << image.texels.size();
}

/// Both of all longitudes, the elevations from one degree farther west: one of the picture's rims
/// lies at the western end of the terrain and not, as the other, at its eastern one. The second
/// picture is of more than 360 degrees, by a rounding, and from Greenwich.
TEST_F(HardCase26, APictureOfTheEarthCoversATerrainOfTheEarth) {
    GDALAllRegister();
    for (const auto& [west, pixel] : {std::pair(-180.0, 1.0), std::pair(0.0, 1 + 1e-12)}) {
        {
            const GDALDatasetUniquePtr dem(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
                folder_.path("earth.tif").c_str(), 180, 90, 1, GDT_Float32, nullptr));
            std::array<double, 6> transform{-181, 2, 0, 90, 0, -2};
            OGRSpatialReference degrees;
            degrees.importFromEPSG(4326);
            dem->SetGeoTransform(transform.data());
            dem->SetSpatialRef(&degrees);
            dem->GetRasterBand(1)->Fill(100);
        }
        const auto colour = [](double longitude, double latitude) {
            const auto wave = [](double degrees) {
                return static_cast<std::uint8_t>(128 + 90 * std::sin(degrees * M_PI / 180));
            };
            return Rgba{wave(longitude), wave(2 * latitude), wave(longitude + 90), 255};
        };
        import::TerrainImportOptions options;
        options.imagery = {write({.epsg = 4326,
                                  .west = west,
                                  .north = 90,
                                  .pixel = pixel,
                                  .columns = 360,
                                  .rows = 180,
                                  .colour = colour})};
        const std::string out = folder_.path("earth.eyt");
        const auto report = import::importTerrain({folder_.path("earth.tif")}, out, options, {});
        ASSERT_TRUE(report.ok()) << report.status();
        EXPECT_THAT(report->notes, testing::Not(testing::Contains(HasSubstr("left out"))));
        const auto file = *terrain::EytFile::open(out);
        const test::TexelImage image = test::wholeLevel(*file, 0);
        constexpr double kMetresPerDegree = 6378137 * M_PI / 180;
        const fabric::Mat4& place = file->index().objectFromLattice;
        const double texel = file->index().imagery->pyramid.texelPosts(0);
        int open = 0, wrong = 0;
        for (std::int64_t j = 0; j < image.height; ++j)
            for (std::int64_t i = 0; i < image.width; ++i) {
                const double x = place[3].x + place[0].x * (static_cast<double>(i) + 0.5) * texel;
                const double y = place[3].y + place[1].y * (static_cast<double>(j) + 0.5) * texel;
                const double longitude = x / kMetresPerDegree - 1;
                const double latitude = y / kMetresPerDegree;
                if (longitude > 178 || latitude > 89)
                    continue;
                open += image.at(i, j).a == 0 ? 1 : 0;
                wrong +=
                    difference(image.at(i, j), colour(longitude, latitude)) > kTolerance ? 1 : 0;
            }
        EXPECT_EQ(open, 0) << "of " << image.texels.size();
        EXPECT_EQ(wrong, 0) << "of " << image.texels.size();
    }
}

TEST_F(ImageryImport, SaysThatAMapThatGoesOnPast180DegreesIsCutOffThere) {
    GDALAllRegister();
    const std::string dem = folder_.path("dem60.tif");
    {
        const GDALDatasetUniquePtr file(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
            dem.c_str(), 100, 100, 1, GDT_Float32, nullptr));
        std::array<double, 6> transform{829'000, 100, 0, 105'000, 0, -100};  // 180 E is at 834 km
        OGRSpatialReference utm;
        utm.importFromEPSG(32660);
        file->SetGeoTransform(transform.data());
        file->SetSpatialRef(&utm);
        file->GetRasterBand(1)->Fill(100);
    }
    constexpr double kHalfTurn = 20'037'508.34;
    const auto notesWith = [&](double west, int columns) {
        TerrainImportOptions options;
        options.imagery = {write({.epsg = 3857,
                                  .west = west,
                                  .north = 116'000,
                                  .pixel = 60,
                                  .columns = columns,
                                  .rows = 400,
                                  .colour = waves(1000)})};
        const auto report = importTerrain({dem}, folder_.path("out.eyt"), options, {});
        EXPECT_TRUE(report.ok()) << report.status();
        return report.ok() ? report->notes : std::vector<std::string>();
    };
    const auto isCutOff = testing::Contains(HasSubstr("picture.tif: a part of it is left out"));
    EXPECT_THAT(notesWith(kHalfTurn - 12'000, 400), isCutOff);
    EXPECT_THAT(notesWith(-kHalfTurn - 12'000, 400), isCutOff);
    EXPECT_THAT(notesWith(kHalfTurn - 12'000, 200), testing::Not(isCutOff));
    EXPECT_THAT(notesWith(-kHalfTurn, 200), testing::Not(isCutOff));
}

/// With a CRS, too: it says nothing of where a picture lies that has no place in it.
TEST_F(ImageryImport, StretchesAPictureWithoutAPlaceOverTheWholeTerrain) {
    for (const int epsg : {0, 4326}) {
        SCOPED_TRACE(epsg);
        // Four quarters: north-west, north-east, south-west, south-east.
        Picture picture{.epsg = epsg,
                        .north = 20,
                        .columns = 20,
                        .rows = 20,
                        .colour =
                            [](double x, double y) {
                                return Rgba{static_cast<std::uint8_t>(x < 10 ? 40 : 200),
                                            static_cast<std::uint8_t>(y > 10 ? 200 : 40), 0, 255};
                            },
                        .isGeoreferenced = false};
        const auto file = imported(test::slope(65, 65, 10), {write(picture)});
        ASSERT_NE(file, nullptr);
        const test::TexelImage image = test::wholeLevel(*file, 0);
        const std::int64_t low = image.width / 8;
        const std::int64_t high = image.width - 1 - low;
        EXPECT_LE(difference(image.at(low, high), {40, 200, 0, 255}), kTolerance) << "north-west";
        EXPECT_LE(difference(image.at(high, high), {200, 200, 0, 255}), kTolerance) << "north-east";
        EXPECT_LE(difference(image.at(low, low), {40, 40, 0, 255}), kTolerance) << "south-west";
        EXPECT_LE(difference(image.at(high, low), {200, 40, 0, 255}), kTolerance) << "south-east";
    }
}

/// As GDAL reads GeoTIFFs that say what a pixel is, and nothing of a CRS.
TEST_F(ImageryImport, WithAnEngineeringCrsWithoutANameIsInTheTerrains) {
    write(over(290, 290, 10, waves(100)));
    writeVrt("unnamed.vrt", 29,
             "<SRS>LOCAL_CS[\"unnamed\",UNIT[\"unknown\",1]]</SRS>"
             "<GeoTransform>500000,10,0,5000290,0,-10</GeoTransform>");
    const auto file = imported(test::slope(30, 30, 10), {folder_.path("unnamed.vrt")});
    ASSERT_NE(file, nullptr);
    EXPECT_EQ(file->index().imagery->coveredTexels, 29U * 29U);
}

TEST_F(ImageryImport, WithoutAGeotransformSaysHowItIsToBeBroughtToOne) {
    write(over(290, 290, 10, waves(100)));
    writeVrt("points.vrt", 37,
             "<GCPList Projection=\"EPSG:32633\">"
             "<GCP Id=\"1\" Pixel=\"0\" Line=\"0\" X=\"500000\" Y=\"5000000\"/></GCPList>");
    const absl::Status status = importError(test::slope(30, 30, 10), {folder_.path("points.vrt")});
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(status.ToString(), HasSubstr("ground control points"));
    EXPECT_THAT(status.ToString(), HasSubstr("gdalwarp"));
}

TEST_F(ImageryImport, BesideTheTerrainIsAnError) {
    Picture picture = over(100, 100, 10, waves(100));
    picture.west += 50'000;
    const std::string path = write(picture);
    const absl::Status status = importError(test::slope(11, 11, 10), {path});
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(status.ToString(), HasSubstr("overlaps"));
    EXPECT_THAT(status.ToString(), HasSubstr(path));
    EXPECT_THAT(folder_.files(), testing::Not(testing::Contains(HasSubstr("with.eyt"))));
}

}  // namespace
}  // namespace eyrie::import
