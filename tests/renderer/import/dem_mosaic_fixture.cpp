// SPDX-License-Identifier: Apache-2.0
#include "tests/renderer/import/dem_mosaic_fixture.h"

#include <array>
#include <cstddef>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

namespace eyrie::test {

std::string DemMosaic::write(const Raster& raster) {
    GDALAllRegister();
    const std::string path = folder_.path(fmt::format("{}.tif", files_++));
    const GDALDatasetUniquePtr file(GetGDALDriverManager()
                                        ->GetDriverByName(raster.driver)
                                        ->Create(path.c_str(), raster.columns, raster.rows, 1,
                                                 raster.isDouble ? GDT_Float64 : GDT_Float32,
                                                 nullptr));
    std::array<double, 6> transform{raster.west, raster.pixel, 0, raster.north, 0, -raster.pixel};
    file->SetGeoTransform(transform.data());
    if (raster.epsg != 0) {
        OGRSpatialReference crs;
        if (raster.crs != nullptr)
            crs.SetFromUserInput(raster.crs);
        else
            crs.importFromEPSG(raster.epsg);
        file->SetSpatialRef(&crs);
    }
    GDALRasterBand* const band = file->GetRasterBand(1);
    band->SetNoDataValue(raster.nodata);
    if (*raster.unit != 0)
        band->SetUnitType(raster.unit);
    band->SetScale(raster.scale);
    band->SetOffset(raster.offset);
    std::vector<double> row(static_cast<std::size_t>(raster.columns));
    for (int j = 0; j < raster.rows; ++j) {
        for (int i = 0; i < raster.columns; ++i)
            row[static_cast<std::size_t>(i)] = raster.height(
                raster.west + raster.pixel * (i + 0.5), raster.north - raster.pixel * (j + 0.5));
        EXPECT_EQ(band->RasterIO(GF_Write, 0, j, raster.columns, 1, row.data(), raster.columns, 1,
                                 GDT_Float64, 0, 0, nullptr),
                  CE_None);
    }
    return path;
}

}  // namespace eyrie::test
