// SPDX-License-Identifier: Apache-2.0
// Pictures laid over a terrain: what is stored is compared with formulas over the ground, evaluated
// where the texels lie.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/terrain_import.h"
#include "renderer/terrain/imagery/bc1.h"
#include "tests/renderer/import/imagery_fixture.h"

namespace eyrie::import {
namespace {

using fabric::Rgba;
using terrain::TextureId;
using terrain::TexturePyramid;
using test::kSouth;
using test::kWest;
using test::Picture;
using testing::HasSubstr;

/// BC1's own error on the smooth colours below, and the rounding of two resamplings.
constexpr int kTolerance = 10;

std::uint8_t wave(double metres, double period) {
    return static_cast<std::uint8_t>(std::lround(128 + 100 * std::sin(2 * M_PI * metres / period)));
}

/// Colours that tell x from y and change slowly over `period` metres.
std::function<Rgba(double, double)> waves(double period) {
    return [period](double x, double y) {
        return Rgba{wave(x - kWest, period), wave(y - kSouth, period * 1.3), 90, 255};
    };
}

int difference(const Rgba& a, const Rgba& b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

class ImageryImport : public testing::Test {
protected:
    std::string write(const Picture& picture, const std::string& name = "picture.tif") {
        const std::string path = folder_.path(name);
        test::writePicture(path, picture);
        return path;
    }

    /// Around all of a terrain of so many metres, and a little more.
    static Picture over(double metresX, double metresY, double pixel,
                        std::function<Rgba(double, double)> colour) {
        const double margin = 4 * pixel;
        return {.west = kWest - margin,
                .north = kSouth + metresY + margin,
                .pixel = pixel,
                .columns = static_cast<int>(std::ceil((metresX + 2 * margin) / pixel)),
                .rows = static_cast<int>(std::ceil((metresY + 2 * margin) / pixel)),
                .colour = std::move(colour)};
    }

    std::shared_ptr<const terrain::EytFile> imported(const terrain::HeightGrid& grid,
                                                     const std::vector<std::string>& pictures) {
        auto file = test::importedWith(grid, pictures, folder_);
        EXPECT_TRUE(file.ok()) << file.status();
        return file.ok() ? *file : nullptr;
    }

    absl::Status importError(const terrain::HeightGrid& grid,
                             const std::vector<std::string>& pictures) {
        return test::importedWith(grid, pictures, folder_).status();
    }

    /// Compares texels whose middle lies in the grid with `colour`; holes wherever that has alpha
    /// 0.
    static void expectColours(const terrain::EytFile& file, double postMetres,
                              const std::function<Rgba(double, double)>& colour,
                              int tolerance = kTolerance) {
        const TexturePyramid& pyramid = file.index().imagery->pyramid;
        const test::TexelImage image = test::wholeLevel(file, 0);
        const double texel = postMetres * pyramid.texelPosts(0);
        int wrong = 0;
        for (std::int64_t y = 0; y < image.height; ++y)
            for (std::int64_t x = 0; x < image.width; ++x) {
                const Rgba expected = colour(kWest + (static_cast<double>(x) + 0.5) * texel,
                                             kSouth + (static_cast<double>(y) + 0.5) * texel);
                const Rgba& found = image.at(x, y);
                if (expected.a == found.a &&
                    (found.a == 0 || difference(expected, found) <= tolerance))
                    continue;
                if (++wrong < 5)
                    ADD_FAILURE() << x << ", " << y << ": " << +found.r << ' ' << +found.g << ' '
                                  << +found.b << ' ' << +found.a << ", expected " << +expected.r
                                  << ' ' << +expected.g << ' ' << +expected.b << ' ' << +expected.a;
            }
        EXPECT_EQ(wrong, 0) << "of " << image.texels.size();
    }

    test::TemporaryFolder folder_;
};

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

TEST_F(ImageryImport, LeavesHolesWhereNoPictureHasAPixel) {
    const auto colour = [](double x, double y) {
        return x < kWest + 480 || y > kSouth + 320 ? Rgba{0, 0, 0, 0} : Rgba{60, 160, 90, 255};
    };
    const auto file = imported(test::slope(97, 65, 10), {write(over(960, 640, 10, colour))});
    ASSERT_NE(file, nullptr);
    expectColours(*file, 10, colour);
    EXPECT_EQ(file->index().imagery->coveredTexels, 48U * 32U);
}

TEST_F(ImageryImport, StoresNothingOfTilesWithoutAPixel) {
    Picture picture = over(0, 0, 1, [](double, double) { return Rgba{60, 160, 90, 255}; });
    picture.west = kWest;
    picture.north = kSouth + 100;
    picture.columns = picture.rows = 100;
    const auto file = imported(test::slope(120, 120, 10), {write(picture)});
    ASSERT_NE(file, nullptr);
    const terrain::ImageryIndex& imagery = *file->index().imagery;
    ASSERT_GE(imagery.pyramid.tilesX(0), 3);
    EXPECT_TRUE(imagery.has({0, 0, 0}));
    EXPECT_FALSE(imagery.has({0, 1, 0}));
    EXPECT_TRUE(imagery.has(imagery.pyramid.top()));
}

TEST_F(ImageryImport, TakesTheFinestAndThenTheLastPicture) {
    const auto filled = [](Rgba colour) { return [=](double, double) { return colour; }; };
    const Rgba red{200, 0, 0, 255};
    const Rgba green{0, 200, 0, 255};
    const Rgba blue{0, 0, 200, 255};
    Picture coarse = over(960, 640, 20, filled(red));
    Picture first = over(960, 640, 10, filled(green));
    first.columns = 68;  // to x = 640
    Picture last = over(960, 640, 10, filled(blue));
    last.columns = 36;  // to x = 320
    const auto file =
        imported(test::slope(97, 65, 10),
                 {write(first, "a.tif"), write(last, "b.tif"), write(coarse, "c.tif")});
    ASSERT_NE(file, nullptr);
    expectColours(*file, 10, [&](double x, double) {
        return x < kWest + 320 ? blue : x < kWest + 640 ? green : red;
    });
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

TEST_F(ImageryImport, StretchesAPictureWithoutAPlaceOverTheWholeTerrain) {
    // Four quarters: north-west, north-east, south-west, south-east.
    Picture picture{.epsg = 0,
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

TEST_F(ImageryImport, ReadsGreyPalettesAndOtherThan8Bits) {
    struct Kind {
        const char* name;
        GDALDataType type;
        int bands;
        Rgba expected;
    };
    std::unique_ptr<char*, decltype(&CSLDestroy)> fourBits(CSLAddString(nullptr, "NBITS=4"),
                                                           &CSLDestroy);
    for (const Kind& kind : {Kind{"grey", GDT_Byte, 1, {77, 77, 77, 255}},
                             Kind{"narrow", GDT_Byte, 1, {170, 170, 170, 255}},
                             Kind{"palette", GDT_Byte, 1, {10, 200, 30, 255}},
                             Kind{"deep", GDT_UInt16, 3, {77, 128, 255, 255}}}) {
        const std::string path = folder_.path(std::string(kind.name) + ".tif");
        {
            GDALAllRegister();
            const GDALDatasetUniquePtr file(
                GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
                    path.c_str(), 40, 40, kind.bands, kind.type,
                    std::string_view(kind.name) == "narrow" ? fourBits.get() : nullptr));
            std::array<double, 6> transform{kWest - 50, 10, 0, kSouth + 350, 0, -10};
            file->SetGeoTransform(transform.data());
            OGRSpatialReference crs;
            crs.importFromEPSG(test::kUtm33);
            file->SetSpatialRef(&crs);
            if (std::string_view(kind.name) == "palette") {
                GDALColorTable table;
                const GDALColorEntry entry{10, 200, 30, 255};
                table.SetColorEntry(3, &entry);
                file->GetRasterBand(1)->SetColorTable(&table);
                file->GetRasterBand(1)->Fill(3);
            } else if (kind.type == GDT_Byte) {
                file->GetRasterBand(1)->Fill(std::string_view(kind.name) == "narrow" ? 10 : 77);
            } else {
                file->GetRasterBand(1)->Fill(77 * 16);
                file->GetRasterBand(2)->Fill(128 * 16);
                file->GetRasterBand(3)->Fill(255 * 16);
            }
        }
        const auto file = imported(test::slope(30, 30, 10), {path});
        ASSERT_NE(file, nullptr) << kind.name;
        SCOPED_TRACE(kind.name);
        expectColours(
            *file, 10, [&](double, double) { return kind.expected; }, 4);
        EXPECT_FALSE(std::ifstream(path + ".aux.xml").good()) << "nothing is written beside it";
    }
}

TEST_F(ImageryImport, LeavesHolesWhereABandsOwnMaskHides) {
    const std::string path = write(over(290, 290, 10, [](double, double) {
        return Rgba{10, 200, 30, 255};
    }));
    const auto band = [](int number, const char* more) {
        return fmt::format(
            "<VRTRasterBand dataType=\"Byte\" band=\"{}\">{}<SimpleSource>"
            "<SourceFilename relativeToVRT=\"1\">picture.tif</SourceFilename>"
            "<SourceBand>{}</SourceBand></SimpleSource></VRTRasterBand>",
            number, more, number);
    };
    // The picture's north, 19 of its 38 rows.
    const char* const kMask =
        "<MaskBand><VRTRasterBand dataType=\"Byte\"><SimpleSource>"
        "<SourceFilename relativeToVRT=\"1\">picture.tif</SourceFilename><SourceBand>2</SourceBand>"
        "<SrcRect xOff=\"0\" yOff=\"0\" xSize=\"37\" ySize=\"19\"/>"
        "<DstRect xOff=\"0\" yOff=\"0\" xSize=\"37\" ySize=\"19\"/>"
        "</SimpleSource></VRTRasterBand></MaskBand>";
    const std::string masked = folder_.path("masked.vrt");
    std::ofstream(masked) << "<VRTDataset rasterXSize=\"37\" rasterYSize=\"37\">"
                          << "<SRS>EPSG:32633</SRS><GeoTransform>"
                          << fmt::format("{}, 10, 0, {}, 0, -10", kWest - 40, kSouth + 330)
                          << "</GeoTransform>" << band(1, kMask) << band(2, kMask) << band(3, kMask)
                          << "</VRTDataset>";
    const auto file = imported(test::slope(30, 30, 10), {masked});
    ASSERT_NE(file, nullptr);
    expectColours(
        *file, 10,
        [](double, double y) {
            return y > kSouth + 140 ? Rgba{10, 200, 30, 255} : Rgba{0, 0, 0, 0};
        },
        4);
}

TEST_F(ImageryImport, WithoutAGeotransformSaysHowItIsToBeBroughtToOne) {
    write(over(290, 290, 10, waves(100)));
    std::ofstream(folder_.path("points.vrt"))
        << "<VRTDataset rasterXSize=\"37\" rasterYSize=\"37\"><GCPList Projection=\"EPSG:32633\">"
           "<GCP Id=\"1\" Pixel=\"0\" Line=\"0\" X=\"500000\" Y=\"5000000\"/></GCPList>"
           "<VRTRasterBand dataType=\"Byte\" band=\"1\"><SimpleSource>"
           "<SourceFilename relativeToVRT=\"1\">picture.tif</SourceFilename>"
           "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
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

TEST_F(ImageryImport, OfHolesAloneIsAnError) {
    const auto holes = [](double, double) { return Rgba{1, 2, 3, 0}; };
    const absl::Status status =
        importError(test::slope(11, 11, 10), {write(over(100, 100, 10, holes))});
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(status.ToString(), HasSubstr("no picture has a pixel"));
    EXPECT_THAT(folder_.files(), testing::Not(testing::Contains(HasSubstr("with.eyt"))));
}

TEST_F(ImageryImport, RefusesWhatIsNoPicture) {
    const std::string dem = folder_.path("floats.tif");
    {
        GDALAllRegister();
        const GDALDatasetUniquePtr file(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
            dem.c_str(), 8, 8, 1, GDT_Float32, nullptr));
    }
    EXPECT_THAT(importError(test::slope(11, 11, 10), {dem}).ToString(), HasSubstr("Float32"));
    EXPECT_EQ(importError(test::slope(11, 11, 10), {folder_.path("none.tif")}).code(),
              absl::StatusCode::kNotFound);
    std::ofstream(folder_.path("text.tif")) << "no picture at all";
    EXPECT_THAT(importError(test::slope(11, 11, 10), {folder_.path("text.tif")}).ToString(),
                HasSubstr("is no raster"));
}

TEST_F(ImageryImport, CutOffPictureIsDataLossAndLeavesNothing) {
    const std::string path = write(over(3000, 3000, 5, waves(300)));
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    const absl::Status status = importError(test::slope(301, 301, 10), {path});
    EXPECT_FALSE(status.ok());
    EXPECT_THAT(status.ToString(), HasSubstr(path));
    EXPECT_THAT(folder_.files(), testing::Not(testing::Contains(HasSubstr("with.eyt"))));
}

/// The blocks beyond a tile's sides are its neighbours' own, so filtering sees no border.
TEST_F(ImageryImport, TilesHaveTheirNeighboursBlocksAsBorder) {
    std::uint32_t state = 1;
    const auto noise = [&state](double, double) {
        state = state * 1664525 + 1013904223;
        return Rgba{static_cast<std::uint8_t>(state >> 24), static_cast<std::uint8_t>(state >> 16),
                    static_cast<std::uint8_t>(state >> 8), 255};
    };
    const auto file = imported(test::slope(151, 141, 10), {write(over(1500, 1400, 1.25, noise))});
    ASSERT_NE(file, nullptr);
    const TexturePyramid& pyramid = file->index().imagery->pyramid;
    ASSERT_GE(pyramid.levels(), 3);
    for (int level = 0; level < pyramid.levels() - 1; ++level)
        for (std::int32_t y = 0; y < pyramid.tilesY(level); ++y)
            for (std::int32_t x = 0; x + 1 < pyramid.tilesX(level); ++x) {
                const auto left = *file->readTexture({level, x, y});
                const auto right = *file->readTexture({level, x + 1, y});
                for (std::int32_t row = 0; row < left->blocksY(); ++row) {
                    const auto l =
                        left->blocks().subspan(static_cast<std::size_t>(row * left->blocksX()),
                                               static_cast<std::size_t>(left->blocksX()));
                    const auto r =
                        right->blocks().subspan(static_cast<std::size_t>(row * right->blocksX()),
                                                static_cast<std::size_t>(right->blocksX()));
                    ASSERT_EQ(l.back(), r[1]) << level << ' ' << x << ' ' << y << ' ' << row;
                    ASSERT_EQ(l[l.size() - 2], r[0]) << level << ' ' << x << ' ' << y << ' ' << row;
                }
            }
}

/// Each coarser level is the mean of the one below, in linear light, but for BC1.
TEST_F(ImageryImport, CoarserLevelsAreMeansOfFinerOnes) {
    const auto file =
        imported(test::slope(111, 101, 10), {write(over(1100, 1000, 1.25, waves(1200)))});
    ASSERT_NE(file, nullptr);
    ASSERT_EQ(file->index().imagery->pyramid.levels(), 2);
    const test::TexelImage fine = test::wholeLevel(*file, 0);
    const test::TexelImage coarse = test::wholeLevel(*file, 1);
    EXPECT_EQ(coarse.width, (fine.width + 1) / 2);
    const auto linear = [](int byte) { return std::pow(byte / 255.0, 2.2); };
    for (std::int64_t y = 0; y + 1 < coarse.height; ++y)
        for (std::int64_t x = 0; x + 1 < coarse.width; ++x) {
            double sum = 0;
            for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}})
                sum += linear(fine.at(2 * x + u, 2 * y + v).r);
            EXPECT_NEAR(255 * std::pow(sum / 4, 1 / 2.2), coarse.at(x, y).r, kTolerance)
                << x << ' ' << y;
        }
}

TEST_F(ImageryImport, GivesTheSameBytesWhateverTheMemoryAndThreads) {
    const std::string path = write(over(1500, 1400, 1.25, waves(170)));
    const terrain::HeightGrid grid = test::slope(151, 141, 10);
    ASSERT_NE(imported(grid, {path}), nullptr);
    const std::string whole = test::contents(folder_.path("with.eyt"));
    ASSERT_TRUE(test::importedWith(grid, {path}, folder_, {.memoryBytes = 1, .threads = 1}).ok());
    EXPECT_TRUE(test::contents(folder_.path("with.eyt")) == whole);
    EXPECT_THAT(folder_.files(), testing::Not(testing::Contains(HasSubstr("scratch"))));
}

TEST_F(ImageryImport, CalledOffLeavesNoFileAndGoesOnLater) {
    const std::string dem = folder_.path("dem.tif");
    const std::string out = folder_.path("out.eyt");
    ASSERT_NE(imported(test::slope(800, 700, 2), {}), nullptr);  // writes the DEM
    const TerrainImportOptions how{.memoryBytes = 1,
                                   .imagery = {write(over(1598, 1398, 1, waves(170)))}};
    std::stop_source stop;
    ImportControl control{[&](std::string_view stage, double fraction) {
                              if (stage == "imagery" && fraction > 0.3)
                                  stop.request_stop();
                          },
                          stop.get_token()};
    EXPECT_EQ(importTerrain({dem}, out, how, control).status().code(),
              absl::StatusCode::kCancelled);
    EXPECT_THAT(folder_.files(), testing::Not(testing::Contains("out.eyt")));
    std::vector<std::string> stages;
    control = {[&](std::string_view stage, double) {
                   if (stages.empty() || stages.back() != stage)
                       stages.emplace_back(stage);
               },
               {}};
    ASSERT_TRUE(importTerrain({dem}, out, how, control).ok());
    EXPECT_THAT(stages, testing::ElementsAre("checking", "imagery"));
    EXPECT_TRUE(terrain::EytFile::open(out).ok());
    EXPECT_THAT(folder_.files(), testing::Not(testing::Contains(HasSubstr("partial"))));
}

TEST_F(ImageryImport, DamagedTilesAreDataLoss) {
    ASSERT_NE(imported(test::slope(90, 70, 10), {write(over(890, 690, 10, waves(1200)))}), nullptr);
    const std::string path = folder_.path("with.eyt");
    const auto file = *terrain::EytFile::open(path);
    const terrain::PageRecord record = file->index().imagery->tiles[0];
    ASSERT_GT(record.bytes, 0U);
    std::fstream bytes(path, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(record.offset + record.bytes / 2));
    bytes.put('\x5a');
    bytes.close();
    const auto damaged = *terrain::EytFile::open(path);
    const auto page = damaged->readTexture({0, 0, 0});
    EXPECT_EQ(page.status().code(), absl::StatusCode::kDataLoss);
    EXPECT_THAT(page.status().ToString(), HasSubstr("texture tile 0/0/0"));
}

}  // namespace
}  // namespace eyrie::import
