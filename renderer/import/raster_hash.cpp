// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/raster_hash.h"

#include <memory>
#include <vector>

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <xxhash.h>

#include "fabric/status.h"
#include "renderer/import/raster_file.h"
#include "renderer/import/raster_name.h"

namespace eyrie::import {
namespace {

absl::StatusOr<std::uint64_t> hashFile(const std::string& path) {
    const std::unique_ptr<VSILFILE, Releaser<VSIFCloseL>> file(VSIFOpenL(path.c_str(), "rb"));
    if (!file) {
        RETURN_IF_ERROR(checkOpenFiles(path));
        return absl::NotFoundError(fmt::format("{}: no such file, or not readable", path));
    }
    const std::unique_ptr<XXH64_state_t, Releaser<XXH64_freeState>> state(XXH64_createState());
    XXH64_reset(state.get(), 0);
    std::vector<char> buffer(std::size_t{1} << 20);
    while (const std::size_t got = VSIFReadL(buffer.data(), 1, buffer.size(), file.get()))
        XXH64_update(state.get(), buffer.data(), got);
    return XXH64_digest(state.get());
}

/// Of what was named: the file or, where it is something in a file, which.
absl::StatusOr<std::uint64_t> hashNamed(const std::string& path) {
    if (VSIStatBufL status; VSIStatL(path.c_str(), &status) == 0)
        return hashFile(path);
    const std::string part = partOfFile(path);
    return XXH64(part.data(), part.size(), 0);
}

}  // namespace

absl::StatusOr<std::uint64_t> rasterHash(const std::string& path, GDALDatasetH raster) {
    ASSIGN_OR_RETURN(std::uint64_t hash, hashNamed(path));
    for (const std::string& file : allFilesOf(raster)) {
        if (path == file || gdalPath(path) == file)
            continue;
        const absl::StatusOr<std::uint64_t> other = hashFile(file);
        if (other.ok())
            hash = hash * 0x9e3779b97f4a7c15 + *other;
        else if (absl::IsResourceExhausted(other.status()))
            return other.status();
    }
    return hash;
}

absl::StatusOr<std::uint64_t> rasterHash(const std::string& path) {
    QuietGdal gdal;
    ASSIGN_OR_RETURN(const Dataset raster,
                     openRaster(path,
                                "a raster such as a GeoTIFF, or a mesh whose name ends in .ply, "
                                ".obj, .glb or as README.md lists",
                                gdal));
    return rasterHash(path, raster.get());
}

}  // namespace eyrie::import
