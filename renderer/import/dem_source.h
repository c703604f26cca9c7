// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

#include "renderer/import/progress.h"
#include "renderer/terrain/height_grid.h"

/// All that Eyrie does with GDAL: elevation models in, synthetic ones out.
namespace eyrie::import {

/// An elevation model in metres, ready to triangulate.
struct Dem {
    terrain::HeightGrid grid;
    std::string crsWkt;              ///< of the grid's x and y; empty: the source has none
    std::uint64_t sourceHash = 0;    ///< XXH64 of the bytes of the file that was named
    std::vector<std::string> notes;  ///< what was assumed or changed, for people
};

/// Limit on columns * rows * 4 bytes of an elevation model, before and after reprojection: the
/// whole grid is held in memory, and an import takes about twice as much again.
inline constexpr std::uint64_t kMaxDemBytes = std::uint64_t{8} << 30;

/// Reads the first band of any raster GDAL opens; `.gz` and `.zip` are looked into.
///
/// Posts are pixel centres. A geographic CRS is reprojected to the UTM zone of its centre (beyond
/// 84 degrees to polar stereographic), bilinearly, at the spacing GDAL suggests. Other CRS keep
/// their grid, rotation included, with units turned to metres. Scale, offset and foot units of the
/// band are applied. Nodata: the band's tag, its mask, NaN, infinities, magnitudes from 1e30, and
/// -32768 in 16-bit rasters.
///
/// Errors, naming file and field: NotFound, InvalidArgument (no raster, not heights, all nodata,
/// less than 2 x 2 posts, no usable georeference), ResourceExhausted (over kMaxDemBytes),
/// DataLoss (unreadable pixels), Cancelled. Nothing is printed, no file is written.
absl::StatusOr<Dem> readDem(const std::string& path, const ImportControl& control);

/// Writes an unrotated grid as GeoTIFF, float32, in UTM zone 33 north, north row first.
/// Nothing is left behind on errors: NotFound, PermissionDenied, Unavailable.
absl::Status writeGeoTiff(const terrain::HeightGrid& grid, const std::string& path);

}  // namespace eyrie::import
