// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/raster_hash.h"

#include <array>
#include <string>
#include <vector>

#include <cpl_vsi.h>
#include <xxhash.h>

#include "fabric/status.h"
#include "renderer/import/file_hash.h"
#include "renderer/import/raster_file.h"
#include "renderer/import/raster_name.h"
#include "renderer/page/remote_name.h"

namespace eyrie::import {
namespace {

/// Of what was named: the file or, where it is something in a file, which.
absl::StatusOr<std::uint64_t> hashNamed(const std::string& path, const std::string& folder,
                                        const std::stop_token& stop) {
    const std::string name = page::gdalName(path);
    if (VSIStatBufL status; VSIStatL(name.c_str(), &status) == 0)
        return fileHash(name, folder, stop);
    const std::string part = partOfFile(path);
    return XXH64(part.data(), part.size(), 0);
}

}  // namespace

absl::StatusOr<std::uint64_t> rasterHash(const std::string& path, GDALDatasetH raster,
                                         const std::string& hashFolder,
                                         const std::stop_token& stop) {
    ASSIGN_OR_RETURN(std::uint64_t hash, hashNamed(path, hashFolder, stop));
    for (const std::string& file : allFilesOf(raster)) {
        if (path == file || gdalPath(path) == file)
            continue;
        const absl::StatusOr<std::uint64_t> other = fileHash(file, hashFolder, stop);
        if (other.ok())
            hash = hash * 0x9e3779b97f4a7c15 + *other;
        else if (!absl::IsNotFound(other.status()))
            return other.status();
    }
    return hash;
}

absl::StatusOr<std::uint64_t> placedRasterHash(const std::string& path,
                                               const std::stop_token& stop) {
    QuietGdal gdal;
    ASSIGN_OR_RETURN(const Dataset raster,
                     openRaster(path,
                                "a raster such as a GeoTIFF, or a mesh whose name ends in .ply, "
                                ".obj, .glb or as README.md lists",
                                gdal));
    ASSIGN_OR_RETURN(const std::uint64_t hash, rasterHash(path, raster.get(), "", stop));
    std::array<double, 6> place{};
    if (GDALGetGeoTransform(raster.get(), place.data()) != CE_None)
        return hash;
    return XXH64(place.data(), sizeof(place), hash);
}

}  // namespace eyrie::import
