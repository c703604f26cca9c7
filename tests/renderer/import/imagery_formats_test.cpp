// SPDX-License-Identifier: Apache-2.0
// What pictures may be.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <stop_token>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/geotiff_writer.h"
#include "renderer/import/picture_fingerprint.h"
#include "tests/renderer/import/imagery_import.h"

namespace eyrie::import {
namespace {

using fabric::Rgba;
using test::kSouth;
using test::kWest;
using testing::HasSubstr;

TEST_F(ImageryImport, ReadsGreyPalettesAndOtherThan8Bits) {
    struct Kind {
        const char* name;
        GDALDataType type;
        int bands;
        Rgba expected;
    };
    std::unique_ptr<char*, decltype(&CSLDestroy)> fourBits(CSLAddString(nullptr, "NBITS=4"),
                                                           &CSLDestroy);
    std::unique_ptr<char*, decltype(&CSLDestroy)> whiteFirst(
        CSLAddString(nullptr, "PHOTOMETRIC=MINISWHITE"), &CSLDestroy);
    for (const Kind& kind : {Kind{"grey", GDT_Byte, 1, {77, 77, 77, 255}},
                             Kind{"negative", GDT_Byte, 1, {178, 178, 178, 255}},
                             Kind{"narrow", GDT_Byte, 1, {170, 170, 170, 255}},
                             Kind{"palette", GDT_Byte, 1, {10, 200, 30, 255}},
                             Kind{"deep", GDT_UInt16, 3, {77, 128, 255, 255}}}) {
        const std::string path = folder_.path(std::string(kind.name) + ".tif");
        {
            GDALAllRegister();
            const GDALDatasetUniquePtr file(
                GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
                    path.c_str(), 40, 40, kind.bands, kind.type,
                    std::string_view(kind.name) == "narrow"     ? fourBits.get()
                    : std::string_view(kind.name) == "negative" ? whiteFirst.get()
                                                                : nullptr));
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

TEST_F(ImageryImport, KnowsWhatIsOpaqueInMoreThan8Bits) {
    struct Kind {
        const char* name;
        GDALDataType type;
        const char* option;
        double opaque;
    };
    for (const Kind& kind : {Kind{"16 bits", GDT_UInt16, nullptr, 65535},
                             Kind{"12 bits", GDT_UInt16, "NBITS=12", 4095},
                             Kind{"8 bits of 16", GDT_UInt16, nullptr, 255},
                             Kind{"12 bits without a tag", GDT_UInt16, nullptr, 4000},
                             Kind{"signed", GDT_Int16, nullptr, 32767}}) {
        const std::string path = folder_.path(std::string(kind.name) + ".tif");
        {
            GDALAllRegister();
            const std::unique_ptr<char*, decltype(&CSLDestroy)> options(
                CSLAddString(CSLAddString(CSLAddString(nullptr, "ALPHA=YES"), "PHOTOMETRIC=RGB"),
                             kind.option != nullptr ? kind.option : "TILED=NO"),
                &CSLDestroy);
            const GDALDatasetUniquePtr file(
                GetGDALDriverManager()->GetDriverByName("GTiff")->Create(path.c_str(), 40, 40, 4,
                                                                         kind.type, options.get()));
            std::array<double, 6> transform{kWest - 50, 10, 0, kSouth + 350, 0, -10};
            file->SetGeoTransform(transform.data());
            OGRSpatialReference crs;
            crs.importFromEPSG(test::kUtm33);
            file->SetSpatialRef(&crs);
            for (int band = 1; band <= 3; ++band) file->GetRasterBand(band)->Fill(200);
            file->GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
            file->GetRasterBand(4)->Fill(kind.opaque);
        }
        SCOPED_TRACE(kind.name);
        const auto file = imported(test::slope(30, 30, 10), {path});
        ASSERT_NE(file, nullptr);
        EXPECT_EQ(file->index().imagery->coveredTexels, file->index().imagery->finestTexels());
    }
}

/// The brightest pixels lie in rows that a look at every 32nd block passes over.
TEST_F(ImageryImport, TurnsAllValuesTo8BitsByTheBrightestOfAll) {
    const std::string path = folder_.path("glint.tif");
    {
        GDALAllRegister();
        constexpr int kSide = 2048;
        const GDALDatasetUniquePtr file(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
            path.c_str(), kSide, kSide, 1, GDT_UInt16, nullptr));
        std::array<double, 6> transform{kWest - 10, 0.2, 0, kSouth + 380, 0, -0.2};
        file->SetGeoTransform(transform.data());
        OGRSpatialReference crs;
        crs.importFromEPSG(test::kUtm33);
        file->SetSpatialRef(&crs);
        std::vector<std::uint16_t> row(kSide, 500);
        for (int y = 0; y < kSide; ++y) {
            std::fill(row.begin(), row.begin() + 1400, y >= 1037 && y < 1078 ? 4000 : 500);
            ASSERT_EQ(file->GetRasterBand(1)->RasterIO(GF_Write, 0, y, kSide, 1, row.data(), kSide,
                                                       1, GDT_UInt16, 0, 0, nullptr),
                      CE_None);
        }
    }
    const auto file = imported(test::slope(30, 30, 10), {path});
    ASSERT_NE(file, nullptr);
    const test::TexelImage image = test::wholeLevel(*file, 0);
    const auto dark = std::ranges::count_if(
        image.texels, [](const Rgba& texel) { return std::abs(texel.r - 255 / 8) < 4; });
    EXPECT_GT(dark, static_cast<std::ptrdiff_t>(image.texels.size() * 9 / 10));
    EXPECT_TRUE(std::ranges::any_of(image.texels, [](const Rgba& t) { return t.r > 250; }));
}

TEST_F(ImageryImport, FingerprintsOfVirtualPicturesAreOfWhatTheyName) {
    const auto fingerprint = [&](std::uint8_t grey) {
        write(over(100, 100, 10, [=](double, double) { return Rgba{grey, grey, grey, 255}; }));
        writeVrt("virtual.vrt", 18, "");
        return pictureFingerprint({folder_.path("virtual.vrt")});
    };
    const std::uint64_t first = fingerprint(10);
    EXPECT_NE(fingerprint(20), first);
    EXPECT_EQ(fingerprint(10), first);
}

TEST_F(ImageryImport, FingerprintsAreOfWhatLiesBetweenTheEndsOfLargeFiles) {
    constexpr std::size_t kEnd = 1 << 20;
    const auto fingerprint = [&](char middle) {
        std::ofstream(folder_.path("large"), std::ios::binary)
            << std::string(kEnd, 'a') << std::string(kEnd, middle) << std::string(kEnd, 'a');
        return pictureFingerprint({folder_.path("large")});
    };
    const std::uint64_t first = fingerprint('b');
    EXPECT_NE(fingerprint('c'), first);
    EXPECT_EQ(fingerprint('b'), first);
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

TEST_F(ImageryImport, RefusesColoursOfSeveralDepthsNamingTheBand) {
    write(over(290, 290, 10, waves(300)));
    const auto errorOf = [&](const char* green, const char* blue, const char* alpha = "Byte") {
        std::ofstream vrt(folder_.path("mixed.vrt"));
        vrt << "<VRTDataset rasterXSize=\"37\" rasterYSize=\"37\">";
        int number = 0;
        for (const char* type : {"Byte", green, blue, alpha}) {
            ++number;
            vrt << fmt::format(
                "<VRTRasterBand dataType=\"{0}\" band=\"{1}\"><ColorInterp>{2}</ColorInterp>"
                "<SimpleSource><SourceFilename relativeToVRT=\"1\">picture.tif</SourceFilename>"
                "<SourceBand>{1}</SourceBand></SimpleSource></VRTRasterBand>",
                type, number, number < 4 ? "Undefined" : "Alpha");
        }
        vrt << "</VRTDataset>";
        vrt.close();
        return importError(test::slope(30, 30, 10), {folder_.path("mixed.vrt")});
    };
    EXPECT_TRUE(errorOf("Byte", "Byte").ok());
    EXPECT_TRUE(errorOf("Byte", "Byte", "UInt16").ok()) << "its most is found";
    const absl::Status deep = errorOf("UInt16", "Byte");
    EXPECT_EQ(deep.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(deep.ToString(), HasSubstr("its band 1 holds Byte values and its band 2 UInt16"));
    const absl::Status floats = errorOf("Byte", "Float32");
    EXPECT_EQ(floats.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(floats.ToString(), HasSubstr("its band 3 holds Float32 values"));
    const absl::Status shares = errorOf("Byte", "Byte", "Float32");
    EXPECT_EQ(shares.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(shares.ToString(), HasSubstr("its band 4, alpha, holds Float32 values"));
}

TEST_F(ImageryImport, CutOffPictureIsDataLossAndLeavesNothing) {
    const std::string path = write(over(3000, 3000, 5, waves(300)));
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    const absl::Status status = importError(test::slope(301, 301, 10), {path});
    EXPECT_FALSE(status.ok());
    EXPECT_THAT(status.ToString(), HasSubstr(path));
    EXPECT_THAT(folder_.files(), testing::Not(testing::Contains(HasSubstr("with.eyt"))));
}

/// A raster written anew, as gdal_translate does with such arguments.
void translate(const std::string& from, const std::string& to, const char* arguments) {
    CPLStringList words(CSLTokenizeString(arguments));
    const std::unique_ptr<GDALTranslateOptions, decltype(&GDALTranslateOptionsFree)> options(
        GDALTranslateOptionsNew(words.List(), nullptr), &GDALTranslateOptionsFree);
    const GDALDatasetUniquePtr file(GDALDataset::Open(from.c_str()));
    ASSERT_NE(file, nullptr);
    GDALClose(GDALTranslate(to.c_str(), GDALDataset::ToHandle(file.get()), options.get(), nullptr));
}

/// Of which GDAL makes grey by itself.
TEST_F(ImageryImport, CutOffJpegIsDataLoss) {
    const std::string path = folder_.path("cut.jpg");
    translate(write(over(3000, 3000, 5, waves(300))), path, "-of JPEG -b 1 -b 2 -b 3");
    ASSERT_TRUE(importError(test::slope(301, 301, 10), {path}).ok());
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    const absl::Status status = importError(test::slope(301, 301, 10), {path});
    EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss);
    EXPECT_THAT(status.ToString(), HasSubstr("cut.jpg: its pixels cannot be read"));
}

/// Of JPEGs in a GeoTIFF libjpeg's warnings stop nothing.
TEST_F(ImageryImport, SaysOfWhichPicturesPixelsMayBeWrong) {
    const std::string path = folder_.path("damaged.tif");
    translate(write(over(3000, 3000, 5, waves(300))), path,
              "-b 1 -b 2 -b 3 -co COMPRESS=JPEG -co TILED=YES");
    {
        const std::string bytes = test::contents(path);
        const std::size_t scan = bytes.rfind("\xff\xda", bytes.size() / 2);
        ASSERT_NE(scan, std::string::npos);
        std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(static_cast<std::streamoff>(scan + 150));
        file << std::string(100, '\0');
    }
    const std::string dem = folder_.path("dem.tif");
    ASSERT_TRUE(writeGeoTiff(test::slope(301, 301, 10), dem).ok());
    const auto report = importTerrain({dem}, folder_.path("out.eyt"), {.imagery = {path}}, {});
    ASSERT_TRUE(report.ok()) << report.status();
    EXPECT_THAT(report->notes, testing::Contains(testing::AllOf(
                                   HasSubstr("damaged.tif: some of its pixels may be wrong"),
                                   HasSubstr("Corrupt JPEG data"))));
}

/// Of 40 x 40 pixels around the slope of 30 x 30 posts.
GDALDatasetUniquePtr createAround(const std::string& path, GDALDataType type,
                                  const std::vector<const char*>& options) {
    GDALAllRegister();
    CPLStringList list;
    for (const char* option : options) list.AddString(option);
    GDALDatasetUniquePtr file(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        path.c_str(), 40, 40, 4, type, list.List()));
    std::array<double, 6> transform{kWest - 50, 10, 0, kSouth + 350, 0, -10};
    file->SetGeoTransform(transform.data());
    OGRSpatialReference crs;
    crs.importFromEPSG(test::kUtm33);
    file->SetSpatialRef(&crs);
    return file;
}

/// What is hidden is as bright as can be.
TEST_F(ImageryImport, TurnsValuesTo8BitsByTheBrightestThatIsNotHidden) {
    constexpr int kSide = 40;
    {
        const auto file =
            createAround(folder_.path("hidden.tif"), GDT_UInt16, {"ALPHA=YES", "PHOTOMETRIC=RGB"});
        constexpr std::array<std::uint16_t, 4> kValues = {3000, 2000, 1000, 65535};
        for (int band = 1; band <= 4; ++band) {
            std::vector<std::uint16_t> values(kSide * kSide,
                                              kValues[static_cast<std::size_t>(band - 1)]);
            for (std::size_t k = 0; k < values.size(); ++k)
                if (k % kSide < 20)
                    values[k] = band == 4 ? 0 : 65535;
            ASSERT_EQ(
                file->GetRasterBand(band)->RasterIO(GF_Write, 0, 0, kSide, kSide, values.data(),
                                                    kSide, kSide, GDT_UInt16, 0, 0, nullptr),
                CE_None);
        }
    }
    const auto band = [](int number, const std::string& more) {
        return fmt::format(
            "<VRTRasterBand dataType=\"UInt16\" band=\"{0}\">{1}<SimpleSource>"
            "<SourceFilename relativeToVRT=\"1\">hidden.tif</SourceFilename>"
            "<SourceBand>{0}</SourceBand></SimpleSource></VRTRasterBand>",
            number, more);
    };
    const std::string mask = "<MaskBand>" + band(4, "") + "</MaskBand>";
    std::ofstream(folder_.path("masked.vrt"))
        << "<VRTDataset rasterXSize=\"40\" rasterYSize=\"40\"><SRS>EPSG:32633</SRS><GeoTransform>"
        << fmt::format("{}, 10, 0, {}, 0, -10", kWest - 50, kSouth + 350) << "</GeoTransform>"
        << band(1, mask) << band(2, mask) << band(3, mask) << "</VRTDataset>";
    for (const char* name : {"hidden.tif", "masked.vrt"}) {
        SCOPED_TRACE(name);
        const auto file = imported(test::slope(30, 30, 10), {folder_.path(name)});
        ASSERT_NE(file, nullptr);
        expectColours(*file, 10, [](double x, double) {
            return x < kWest + 150 ? Rgba{0, 0, 0, 0} : Rgba{255, 170, 85, 255};
        });
    }
}

TEST_F(ImageryImport, KnowsWhatIsOpaqueInLessThan8Bits) {
    {
        const auto file = createAround(folder_.path("narrow.tif"), GDT_Byte,
                                       {"NBITS=4", "ALPHA=YES", "PHOTOMETRIC=RGB"});
        for (int band = 1; band <= 3; ++band) file->GetRasterBand(band)->Fill(10);
        file->GetRasterBand(4)->Fill(15);
    }
    const auto file = imported(test::slope(30, 30, 10), {folder_.path("narrow.tif")});
    ASSERT_NE(file, nullptr);
    expectColours(
        *file, 10,
        [](double, double) {
            return Rgba{170, 170, 170, 255};
        },
        4);
}

/// Of 8 bits GDAL turns them into red, green and blue itself.
TEST_F(ImageryImport, OfPrintersColoursIn16BitsIsAnErrorWithARemedy) {
    const std::string path = folder_.path("cmyk.tif");
    {
        const auto file = createAround(path, GDT_UInt16, {"PHOTOMETRIC=CMYK"});
        file->GetRasterBand(1)->Fill(0);
        file->GetRasterBand(2)->Fill(65535);
        file->GetRasterBand(3)->Fill(65535);
        file->GetRasterBand(4)->Fill(0);
    }
    const absl::Status status = importError(test::slope(30, 30, 10), {path});
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(status.ToString(), HasSubstr("cmyk.tif: its band 1 is Cyan"));
    const std::string remedy = "-ot Byte -scale 0 65535 0 255 -co PHOTOMETRIC=CMYK";
    EXPECT_THAT(status.ToString(), HasSubstr("gdal_translate " + remedy));
    translate(path, folder_.path("byte.tif"), remedy.c_str());
    const auto file = imported(test::slope(30, 30, 10), {folder_.path("byte.tif")});
    ASSERT_NE(file, nullptr);
    expectColours(
        *file, 10,
        [](double, double) {
            return Rgba{255, 0, 0, 255};
        },
        4);
}

/// One half of a terrain, of one value of 16 bits.
void writeHalf(const std::string& path, bool isEastern, std::uint16_t value) {
    GDALAllRegister();
    const GDALDatasetUniquePtr file(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        path.c_str(), 20, 40, 1, GDT_UInt16, nullptr));
    std::array<double, 6> transform{
        kWest - 50 + (isEastern ? 200 : 0), 10, 0, kSouth + 350, 0, -10};
    file->SetGeoTransform(transform.data());
    OGRSpatialReference crs;
    crs.importFromEPSG(test::kUtm33);
    file->SetSpatialRef(&crs);
    file->GetRasterBand(1)->Fill(value);
}

TEST_F(ImageryImport, TurnsPicturesBesideEachOtherTo8BitsByTheBrightestOfAll) {
    const std::string west = folder_.path("west.tif");
    const std::string east = folder_.path("east.tif");
    writeHalf(east, true, 4000);
    for (const int value : {500, 0}) {
        writeHalf(west, false, static_cast<std::uint16_t>(value));
        const auto file = imported(test::slope(30, 30, 10), {west, east});
        ASSERT_NE(file, nullptr);
        const int dark = value * 255 / 4000;
        expectColours(
            *file, 10,
            [&](double x, double) {
                const auto grey = static_cast<std::uint8_t>(x < kWest + 150 ? dark : 255);
                return Rgba{grey, grey, grey, 255};
            },
            4);
    }
}

TEST_F(ImageryImport, IsCalledOffWhileItLooksForTheBrightest) {
    const std::string dem = folder_.path("dem.tif");
    const std::string picture = folder_.path("half.tif");
    ASSERT_TRUE(writeGeoTiff(test::slope(30, 30, 10), dem).ok());
    writeHalf(picture, false, 500);
    std::stop_source stop;
    const ImportControl control{[&](std::string_view stage, double) {
                                    if (stage == "looking for the brightest")
                                        stop.request_stop();
                                },
                                stop.get_token()};
    EXPECT_TRUE(absl::IsCancelled(
        importTerrain({dem}, folder_.path("out.eyt"), {.imagery = {picture}}, control).status()));
}

}  // namespace
}  // namespace eyrie::import
