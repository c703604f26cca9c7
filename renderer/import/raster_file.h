// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/gdal_handles.h"

namespace eyrie::import {

/// The name under which GDAL reads a file at an address part by part, and looks into a .gz or .zip.
std::string gdalPath(const std::string& path);

/// A raster by any name that GDAL knows, see raster_name.h. So that a mosaic may have thousands, it
/// raises this process's limit of open files as far as it may be. Errors: NotFound;
/// InvalidArgument when GDAL reads no raster there, where `wanted` says what to give instead;
/// DataLoss when GDAL would take what the file, or one that it refers to, lacks for zeros; those of
/// checkOpenFiles.
absl::StatusOr<Dataset> openRaster(const std::string& path, const char* wanted, QuietGdal& gdal);

/// InvalidArgument, naming the remedy, for a raster without a geotransform that says in another way
/// where it is: taken for one that is nowhere it would come to lie in a wrong place.
absl::Status checkPlace(const std::string& path, GDALDatasetH raster);

/// ResourceExhausted, with `path` to blame, when this process can open no more files: to be asked
/// when something could not be opened.
absl::Status checkOpenFiles(const std::string& path);

/// Why a raster that could be opened may not be readable, for messages.
std::string whyUnreadable(const std::string& path);

/// Files that a raster consists of, as GDAL names them.
std::vector<std::string> filesOf(GDALDatasetH raster);
/// And, as GDAL names only the files that a virtual raster has itself, of virtual ones among them.
/// Each once, so that rasters that name each other come to an end.
std::vector<std::string> allFilesOf(GDALDatasetH raster);

/// As in raster_hash.h, of a raster that is open: by `path`. Its files' hashes are shared in
/// `hashFolder`, as fileHash says; empty: not at all.
absl::StatusOr<std::uint64_t> rasterHash(const std::string& path, GDALDatasetH raster,
                                         const std::string& hashFolder,
                                         const std::stop_token& stop);

}  // namespace eyrie::import
