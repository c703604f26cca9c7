// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/geotiff_writer.h"

#include <cstdio>
#include <filesystem>
#include <limits>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "fabric/replaceable.h"
#include "fabric/status.h"
#include "renderer/import/gdal_handles.h"

namespace eyrie::import {

absl::Status writeGeoTiff(const terrain::HeightGrid& grid, const std::string& path) {
    const auto folder = std::filesystem::absolute(path).parent_path();
    if (std::error_code ignored; !std::filesystem::is_directory(folder, ignored))
        return absl::NotFoundError(fmt::format(
            "{}: cannot create it: {} is no folder; create it first", path, folder.string()));
    RETURN_IF_ERROR(fabric::checkReplaceable(path));
    QuietGdal gdal;
    const std::string partial = fmt::format("{}.partial-{}", path, getpid());
    const auto failed = [&](const char* what) {
        std::remove(partial.c_str());
        return absl::UnavailableError(fmt::format("{}: {} ({})", path, what, gdal.takeError()));
    };
    {
        const Dataset file(GDALCreate(GDALGetDriverByName("GTiff"), partial.c_str(), grid.columns,
                                      grid.rows, 1, GDT_Float32, nullptr));
        if (!file)
            return failed("cannot be written");
        const fabric::Vec2 corner = grid.origin - (grid.perColumn - grid.perRow) * 0.5 +
                                    grid.perRow * static_cast<double>(grid.rows - 1);
        std::array<double, 6> transform = geoTransform({corner, grid.perColumn, -grid.perRow});
        const SpatialReference crs(OSRNewSpatialReference(nullptr));
        constexpr int kUtm33North = 32633;
        OSRImportFromEPSG(crs.get(), kUtm33North);
        const GDALRasterBandH band = GDALGetRasterBand(file.get(), 1);
        GDALSetGeoTransform(file.get(), transform.data());
        GDALSetSpatialRef(file.get(), crs.get());
        GDALSetRasterNoDataValue(band, std::numeric_limits<double>::quiet_NaN());
        // Rows from the last to the first: a negative line spacing turns the grid over.
        const auto stride = static_cast<GSpacing>(sizeof(float)) * grid.columns;
        if (GDALRasterIOEx(band, GF_Write, 0, 0, grid.columns, grid.rows,
                           const_cast<float*>(grid.row(grid.rows - 1)), grid.columns, grid.rows,
                           GDT_Float32, sizeof(float), -stride, nullptr) != CE_None)
            return failed("cannot be written");
    }
    if (const std::string error = gdal.takeError(); !error.empty()) {
        std::remove(partial.c_str());
        return absl::UnavailableError(fmt::format("{}: cannot be written ({})", path, error));
    }
    if (std::rename(partial.c_str(), path.c_str()) != 0)
        return failed("cannot be renamed from its partial file");
    return absl::OkStatus();
}

}  // namespace eyrie::import
