// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/geotiff_writer.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>
#include <system_error>

#include <fmt/format.h>

#include "fabric/replaceable.h"
#include "fabric/status.h"
#include "renderer/import/gdal_handles.h"
#include "renderer/import/whole_file.h"

namespace eyrie::import {

absl::Status writeGeoTiff(const terrain::HeightGrid& grid, const std::string& path) {
    const auto folder = std::filesystem::absolute(path).parent_path();
    if (std::error_code ignored; !std::filesystem::is_directory(folder, ignored))
        return absl::NotFoundError(fmt::format(
            "{}: cannot create it: {} is no folder; create it first", path, folder.string()));
    RETURN_IF_ERROR(fabric::checkReplaceable(path));
    QuietGdal gdal;
    ASSIGN_OR_RETURN(WholeFile whole, WholeFile::create(path));
    const auto cannotBeWritten = [&](const std::string& error) {
        for (const int known : {ENOSPC, EDQUOT, EFBIG})  // as libtiff tells them
            if (error.find(std::strerror(known)) != std::string::npos)
                return fabric::writeError(path, "cannot write it", known);
        return absl::UnavailableError(fmt::format("{}: cannot be written ({})", path, error));
    };
    {
        // GDAL does not remove what is no raster yet, and so writes the file that is locked.
        const Dataset file(GDALCreate(GDALGetDriverByName("GTiff"), whole.partialPath().c_str(),
                                      grid.columns, grid.rows, 1, GDT_Float32, nullptr));
        if (!file)
            return cannotBeWritten(gdal.takeError());
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
            return cannotBeWritten(gdal.takeError());
    }
    if (const std::string error = gdal.takeError(); !error.empty())
        return cannotBeWritten(error);
    return whole.commit();
}

}  // namespace eyrie::import
