// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/dem_warp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_utils.h>

#include "renderer/import/thread_limit.h"

namespace eyrie::import {
namespace {

/// GDAL widens its kernel where posts are farther apart than pixels, by how much smaller a block is
/// than what of the raster it needs, and does not give a plane back: in degrees at 46 north posts
/// were off by up to 0.07 of a pixel's fall, beside the seam of a raster of all longitudes by a
/// tenth. As narrow as these make it, it gives what the surface is at the post. Only of a raster in
/// degrees, and only in one direction, are pixels denser than posts: few are passed over.
constexpr std::array kInterpolate = {"XSCALE=1", "YSCALE=1"};

absl::StatusOr<Dataset> warped(GDALDatasetH heights, const std::string& name,
                               const std::string& targetWkt, const std::vector<std::string>& more,
                               QuietGdal& gdal) {
    // Heights are metres already: by the CRS's vertical unit GDAL would turn them once more, and
    // by its vertical datum where PROJ happens to have the grid.
    std::vector<std::string> arguments = {"-of",
                                          "VRT",
                                          "-r",
                                          "bilinear",
                                          "-dstnodata",
                                          "nan",
                                          "-et",
                                          "0.001",
                                          "-novshift",
                                          "-wo",
                                          "NUM_THREADS=" + gdalThreads()};
    for (const char* const option : kInterpolate)
        arguments.insert(arguments.end(), {"-wo", option});
    for (const std::string& option : polarWarpOptions(heights))
        arguments.insert(arguments.end(), {"-wo", option});
    if (!targetWkt.empty())
        arguments.insert(arguments.end(), {"-t_srs", targetWkt});
    arguments.insert(arguments.end(), more.begin(), more.end());
    std::unique_ptr<char*, Releaser<CSLDestroy>> list;
    for (const std::string& argument : arguments)
        list.reset(CSLAddString(list.release(), argument.c_str()));
    const std::unique_ptr<GDALWarpAppOptions, Releaser<GDALWarpAppOptionsFree>> options(
        GDALWarpAppOptionsNew(list.get(), nullptr));
    GDALDatasetH sources[] = {heights};
    int usageError = 0;
    Dataset result(GDALWarp("", nullptr, 1, sources, options.get(), &usageError));
    if (!result)
        return invalid(name, fmt::format("cannot be reprojected ({}); reproject it with "
                                         "gdalwarp first",
                                         gdal.takeError()));
    return result;
}

}  // namespace

Dataset outlineOf(GDALDatasetH heights, std::optional<double> meridian) {
    const int columns = GDALGetRasterXSize(heights);
    const int rows = GDALGetRasterYSize(heights);
    Dataset outline(
        GDALCreate(GDALGetDriverByName("VRT"), "", columns, rows, 1, GDT_Float32, nullptr));
    std::array<double, 6> t{};
    GDALGetGeoTransform(heights, t.data());
    const OGRSpatialReferenceH crs = GDALGetSpatialRef(heights);
    const double last = t[3] + t[5] * rows;
    constexpr double kPole = 90;
    if (crs != nullptr && OSRIsGeographic(crs) != 0 && t[4] == 0 &&
        std::max(std::abs(t[3]), std::abs(last)) > kPole) {
        t[3] = std::clamp(t[3], -kPole, kPole);
        t[5] = (std::clamp(last, -kPole, kPole) - t[3]) / rows;
    }
    if (meridian) {
        constexpr double kNearlyATurn = 360 * (1 - 1e-9);
        t[1] = std::copysign(std::min(std::abs(t[1]), kNearlyATurn / columns), t[1]);
        t[0] = *meridian - t[1] * columns / 2;
    }
    GDALSetGeoTransform(outline.get(), t.data());
    GDALSetSpatialRef(outline.get(), crs);
    return outline;
}

absl::StatusOr<Dataset> reprojected(GDALDatasetH heights, const std::string& name,
                                    const std::string& targetWkt, QuietGdal& gdal) {
    return warped(heights, name, targetWkt, {}, gdal);
}

absl::StatusOr<Dataset> reprojected(GDALDatasetH heights, const std::string& name,
                                    const std::string& targetWkt, const PixelGrid& grid,
                                    const PixelBox& box, QuietGdal& gdal) {
    const double west = grid.x + grid.width * static_cast<double>(box.column);
    const double north = grid.y - grid.height * static_cast<double>(box.row);
    return warped(
        heights, name, targetWkt,
        {"-te", fmt::format("{}", west), fmt::format("{}", north - grid.height * box.rows),
         fmt::format("{}", west + grid.width * box.columns), fmt::format("{}", north), "-ts",
         fmt::format("{}", box.columns), fmt::format("{}", box.rows)},
        gdal);
}

}  // namespace eyrie::import
