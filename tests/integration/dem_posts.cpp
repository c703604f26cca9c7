// SPDX-License-Identifier: Apache-2.0
#include "tests/integration/dem_posts.h"

#include <array>
#include <limits>

#include <fmt/format.h>
#include <gdal_priv.h>

namespace eyrie::test {

absl::StatusOr<truth::HeightGrid> readPosts(const std::string& path) {
    GDALAllRegister();
    const GDALDatasetUniquePtr file(
        GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
    std::array<double, 6> transform{};
    if (!file || file->GetGeoTransform(transform.data()) != CE_None)
        return absl::NotFoundError(fmt::format("{}: no georeferenced raster", path));
    if (file->GetSpatialRef() == nullptr || file->GetSpatialRef()->IsProjected() == 0)
        return absl::InvalidArgumentError(fmt::format("{}: not in a projected CRS", path));
    truth::HeightGrid grid;
    grid.columns = file->GetRasterXSize();
    grid.rows = file->GetRasterYSize();
    grid.perColumn = {transform[1], transform[4]};
    grid.perRow = {transform[2], transform[5]};
    grid.origin = fabric::Vec2(transform[0], transform[3]) + 0.5 * (grid.perColumn + grid.perRow);
    grid.heights.resize(static_cast<std::size_t>(grid.columns) *
                        static_cast<std::size_t>(grid.rows));
    GDALRasterBand* band = file->GetRasterBand(1);
    if (band->RasterIO(GF_Read, 0, 0, grid.columns, grid.rows, grid.heights.data(), grid.columns,
                       grid.rows, GDT_Float32, 0, 0) != CE_None)
        return absl::DataLossError(fmt::format("{}: {}", path, CPLGetLastErrorMsg()));
    int hasNodata = 0;
    const auto nodata = static_cast<float>(band->GetNoDataValue(&hasNodata));
    for (float& height : grid.heights)
        if (hasNodata != 0 && height == nodata)
            height = std::numeric_limits<float>::quiet_NaN();
    return grid;
}

}  // namespace eyrie::test
