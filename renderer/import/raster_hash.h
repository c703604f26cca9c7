// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stop_token>
#include <string>

#include <absl/status/statusor.h>

namespace eyrie::import {

/// XXH64 of the bytes of all files of a raster by any name that GDAL knows (raster_name.h): of that
/// named, of those beside it, and of those that a virtual raster names, itself or through others.
/// Where they lie does not count, but where on the earth the raster does: of SRTM's files their
/// names alone say that. Errors: those of openRaster and fileHash; NotFound for the file that is
/// named alone.
absl::StatusOr<std::uint64_t> placedRasterHash(const std::string& path,
                                               const std::stop_token& stop = {});

}  // namespace eyrie::import
