// SPDX-License-Identifier: Apache-2.0
// Elevation models in tiles of which GDAL's cache has room for less than a row.
#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <numeric>
#include <string>
#include <string_view>

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/dem_source.h"
#include "renderer/import/elevation_reading.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::import {
namespace {

constexpr int kSide = 1024;  // of a tile
constexpr int kAcross = 9;
constexpr int kDown = 2;
constexpr std::string_view kEnding = ".tiles";

std::array<int, std::size_t{kAcross} * kDown> decoded;  // times, of each tile

GDALDataType type = GDT_Float32;

float heightAt(int i, int j) { return static_cast<float>(i % 1000 + j % 7); }

class TiledBand : public GDALRasterBand {
public:
    explicit TiledBand(GDALDataset* owner) {
        poDS = owner;
        nBand = 1;
        eDataType = type;
        nBlockXSize = nBlockYSize = kSide;
    }

protected:
    CPLErr IReadBlock(int x, int y, void* data) override {
        ++decoded[static_cast<std::size_t>(y * kAcross + x)];
        if (type == GDT_Float32)
            fill(static_cast<float*>(data), x, y);
        else
            fill(static_cast<double*>(data), x, y);
        return CE_None;
    }

private:
    template <typename T>
    static void fill(T* heights, int x, int y) {
        for (int v = 0; v < kSide; ++v)
            for (int u = 0; u < kSide; ++u) *heights++ = heightAt(x * kSide + u, y * kSide + v);
    }
};

/// Posts 10 m apart, without a CRS.
class TiledModel : public GDALDataset {
public:
    TiledModel() {
        nRasterXSize = kAcross * kSide;
        nRasterYSize = kDown * kSide;
        SetBand(1, new TiledBand(this));
    }

    CPLErr GetGeoTransform(double* transform) override {
        std::ranges::copy(std::array<double, 6>{0, 10, 0, 10.0 * kDown * kSide, 0, -10}, transform);
        return CE_None;
    }

    static int isOne(GDALOpenInfo* info) {
        return std::string_view(info->pszFilename).ends_with(kEnding) ? TRUE : FALSE;
    }
    static GDALDataset* open(GDALOpenInfo* info) {
        return isOne(info) == TRUE ? new TiledModel : nullptr;
    }
};

void registerTiles() {
    GDALAllRegister();
    if (GDALGetDriverByName("Tiles") != nullptr)
        return;
    auto* const driver = new GDALDriver;
    driver->SetDescription("Tiles");
    driver->SetMetadataItem(GDAL_DCAP_RASTER, "YES");
    driver->pfnIdentify = &TiledModel::isOne;
    driver->pfnOpen = &TiledModel::open;
    GetGDALDriverManager()->RegisterDriver(driver);
}

/// `share`: how many times tiles are decoded in the mean, at most.
void expectIsDecodedOnce(GDALDataType ofTiles, double share) {
    registerTiles();
    decoded = {};
    type = ofTiles;
    const test::TemporaryFolder folder;
    const std::string path = folder.path("wide" + std::string(kEnding));
    std::ofstream(path) << "tiles";
    const auto source = openDems({path}, {});
    ASSERT_TRUE(source.ok()) << source.status();
    terrain::Scratch scratch(folder.path("scratch"), std::uint64_t{1} << 30);
    terrain::ElevationModel model = emptyModel(source->posts->frame(), scratch);
    ASSERT_TRUE(readElevation(*source->posts, scratch, {}, model, {}).ok());
    EXPECT_THAT(decoded, testing::Each(testing::AllOf(testing::Ge(1), testing::Le(2))));
    EXPECT_LE(std::accumulate(decoded.begin(), decoded.end(), 0), share * decoded.size());
    EXPECT_EQ(model.statistics.nodataPosts, 0U);

    // Rows count from the south.
    constexpr std::int32_t kTile = terrain::kRasterTileCells;
    for (const auto& [x, y] :
         {std::pair(0, 0), std::pair(31, 7), std::pair(32, 8), std::pair(71, 15)}) {
        const auto tile = model.heights.tile(x, y);
        ASSERT_NE(tile, nullptr);
        EXPECT_EQ(tile[0], heightAt(x * kTile, kDown * kSide - 1 - y * kTile)) << x << ", " << y;
    }
}

/// What is read at once shares a column of posts with what lies beside it.
TEST(DemInTiles, IsDecodedOnceButForWhatIsSharedHoweverWide) {
    expectIsDecodedOnce(GDT_Float32, 1.25);
}

TEST(DemInTiles, OfWhichFewFitIsReadInNarrowerStrips) { expectIsDecodedOnce(GDT_Float64, 1.5); }

}  // namespace
}  // namespace eyrie::import
