// SPDX-License-Identifier: Apache-2.0
// Pictures that are decoded by whole rows.
#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fabric/status.h"
#include "renderer/import/geotiff_writer.h"
#include "tests/renderer/import/imagery_import.h"

namespace eyrie::import {
namespace {

using test::kSouth;
using test::kWest;
using testing::HasSubstr;

constexpr int kColumns = 14'000;
constexpr int kRows = 1'250;
constexpr std::string_view kEnding = ".counted";

/// What a decoder such as PNG's has done, which goes forward only.
struct Decoding {
    std::array<int, kRows> times{};  ///< that a row was decoded for somebody
    int beginnings = 0;
    int next = kRows;
};
Decoding decoding;

class CountedBand : public GDALRasterBand {
public:
    CountedBand(GDALDataset* owner, int number) {
        poDS = owner;
        nBand = number;
        eDataType = GDT_Byte;
        nBlockXSize = kColumns;
        nBlockYSize = 1;
    }

protected:
    CPLErr IReadBlock(int, int row, void* data) override {
        decoding.beginnings += row < decoding.next ? 1 : 0;
        decoding.next = row + 1;
        ++decoding.times[static_cast<std::size_t>(row)];
        auto* const texels = static_cast<std::uint8_t*>(data);
        for (int i = 0; i < kColumns; ++i) texels[i] = static_cast<std::uint8_t>(i / 8 + row / 8);
        return CE_None;
    }
};

/// A grey picture of 1 m from the slope's south-west on.
class CountedPicture : public GDALDataset {
public:
    CountedPicture() {
        nRasterXSize = kColumns;
        nRasterYSize = kRows;
        crs_.importFromEPSG(test::kUtm33);
        SetBand(1, new CountedBand(this, 1));
    }

    CPLErr GetGeoTransform(double* transform) override {
        std::ranges::copy(std::array<double, 6>{kWest, 1, 0, kSouth + kRows, 0, -1}, transform);
        return CE_None;
    }
    const OGRSpatialReference* GetSpatialRef() const override { return &crs_; }

    static int isOne(GDALOpenInfo* info) {
        return std::string_view(info->pszFilename).ends_with(kEnding) ? TRUE : FALSE;
    }
    static GDALDataset* open(GDALOpenInfo* info) {
        return isOne(info) == TRUE ? new CountedPicture : nullptr;
    }

private:
    OGRSpatialReference crs_;
};

class ImageryInStrips : public ImageryImport {
protected:
    ImageryInStrips() {
        if (GDALGetDriverByName("Counted") == nullptr) {
            auto* const driver = new GDALDriver;
            driver->SetDescription("Counted");
            driver->SetMetadataItem(GDAL_DCAP_RASTER, "YES");
            driver->pfnIdentify = &CountedPicture::isOne;
            driver->pfnOpen = &CountedPicture::open;
            GetGDALDriverManager()->RegisterDriver(driver);
        }
        std::ofstream(picture_) << "rows";
        decoding = {};
    }

    absl::StatusOr<TerrainImportReport> import(std::uint64_t memoryBytes) {
        const std::string dem = folder_.path("dem.tif");
        RETURN_IF_ERROR(writeGeoTiff(test::slope(220, 20, 64), dem));
        return importTerrain({dem}, folder_.path("out.eyt"),
                             {.memoryBytes = memoryBytes, .imagery = {picture_}}, {});
    }

    std::string picture_ = folder_.path("wide" + std::string(kEnding));
};

TEST_F(ImageryInStrips, AreDecodedOnceHoweverWide) {
    const auto report = import(std::uint64_t{512} << 20);
    ASSERT_TRUE(report.ok()) << report.status();
    EXPECT_THAT(decoding.times, testing::Each(testing::Le(1)));
    EXPECT_EQ(decoding.beginnings, 1);
    EXPECT_THAT(report->notes, testing::Not(testing::Contains(HasSubstr("row by row"))));
}

TEST_F(ImageryInStrips, ThatAreTooWideForTheMemoryAreSaidToBe) {
    const auto report = import(kLeastImportMemory);
    ASSERT_TRUE(report.ok()) << report.status();
    EXPECT_THAT(report->notes,
                testing::Contains(testing::AllOf(HasSubstr(picture_), HasSubstr("row by row"),
                                                 HasSubstr("TILED=YES"))));
    EXPECT_THAT(report->notes, testing::Contains(HasSubstr("not 192 MB: reading pictures takes")))
        << "and not the few tiles of the terrain";
}

}  // namespace
}  // namespace eyrie::import
