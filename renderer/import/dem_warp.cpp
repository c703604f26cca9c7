// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/dem_warp.h"

#include <algorithm>
#include <cmath>

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_utils.h>

namespace eyrie::import {
namespace {

absl::StatusOr<Dataset> warped(const DemFile& file, const std::string& targetWkt,
                               const std::vector<std::string>& more, QuietGdal& gdal) {
    std::vector<std::string> arguments = {"-of", "VRT", "-r",   "bilinear", "-dstnodata",
                                          "nan", "-et", "0.01", "-wo",      "NUM_THREADS=ALL_CPUS"};
    for (const std::string& option : polarWarpOptions(file.dataset.get()))
        arguments.insert(arguments.end(), {"-wo", option});
    if (!targetWkt.empty())
        arguments.insert(arguments.end(), {"-t_srs", targetWkt});
    arguments.insert(arguments.end(), more.begin(), more.end());
    std::unique_ptr<char*, Releaser<CSLDestroy>> list;
    for (const std::string& argument : arguments)
        list.reset(CSLAddString(list.release(), argument.c_str()));
    const std::unique_ptr<GDALWarpAppOptions, Releaser<GDALWarpAppOptionsFree>> options(
        GDALWarpAppOptionsNew(list.get(), nullptr));
    GDALDatasetH sources[] = {file.dataset.get()};
    int usageError = 0;
    Dataset result(GDALWarp("", nullptr, 1, sources, options.get(), &usageError));
    if (!result)
        return invalid(file.path, fmt::format("cannot be reprojected ({}); reproject it with "
                                              "gdalwarp first",
                                              gdal.takeError()));
    return result;
}

}  // namespace

/// The projected CRS for data around a longitude and latitude of `geographic`.
absl::StatusOr<SpatialReference> localProjection(const std::string& path,
                                                 OGRSpatialReferenceH geographic, double longitude,
                                                 double latitude) {
    SpatialReference local(OSRNewSpatialReference(nullptr));
    OGRErr error = OGRERR_NONE;
    if (std::abs(latitude) > kUtmLimitDegrees) {
        error = OSRImportFromEPSG(local.get(), latitude > 0 ? 32661 : 32761);
    } else {
        const double wrapped = longitude - 360 * std::floor((longitude + 180) / 360);
        const int zone = std::clamp(static_cast<int>((wrapped + 180) / 6) + 1, 1, 60);
        OSRSetProjCS(local.get(),
                     fmt::format("UTM zone {}{}", zone, latitude < 0 ? 'S' : 'N').c_str());
        error = OSRCopyGeogCSFrom(local.get(), geographic);
        if (error == OGRERR_NONE)
            error = OSRSetUTM(local.get(), zone, latitude >= 0 ? 1 : 0);
    }
    if (error != OGRERR_NONE)
        return invalid(path,
                       "its geographic CRS has no UTM zone; reproject it with gdalwarp first");
    OSRSetAxisMappingStrategy(local.get(), OAMS_TRADITIONAL_GIS_ORDER);
    return local;
}

absl::StatusOr<Dataset> reprojected(const DemFile& file, const std::string& targetWkt,
                                    QuietGdal& gdal) {
    return warped(file, targetWkt, {}, gdal);
}

absl::StatusOr<Dataset> reprojected(const DemFile& file, const std::string& targetWkt,
                                    const PixelGrid& grid, const PixelBox& box, QuietGdal& gdal) {
    const double west = grid.x + grid.width * static_cast<double>(box.column);
    const double north = grid.y - grid.height * static_cast<double>(box.row);
    return warped(
        file, targetWkt,
        {"-te", fmt::format("{}", west), fmt::format("{}", north - grid.height * box.rows),
         fmt::format("{}", west + grid.width * box.columns), fmt::format("{}", north), "-ts",
         fmt::format("{}", box.columns), fmt::format("{}", box.rows)},
        gdal);
}

}  // namespace eyrie::import
