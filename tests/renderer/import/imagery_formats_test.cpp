// SPDX-License-Identifier: Apache-2.0
// What pictures may be.
#include <fstream>
#include <memory>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace eyrie::import
