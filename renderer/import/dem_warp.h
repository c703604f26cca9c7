// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <absl/status/statusor.h>

#include "renderer/import/gdal_handles.h"

namespace eyrie::import {

/// A north-up grid of pixels in some CRS.
struct PixelGrid {
    double x = 0;  ///< outer corner of the first pixel
    double y = 0;
    double width = 1;   ///< of a pixel
    double height = 1;  ///< positive: rows go south
};

/// Pixels of a grid, from the grid's first: may be negative.
struct PixelBox {
    std::int64_t column = 0;
    std::int64_t row = 0;
    int columns = 0;
    int rows = 0;
};

/// A raster without pixels that lies as `heights` does, for GDAL to suggest a grid for.
///
/// It ends at the poles: grids with posts on them reach half a post farther, where GDAL finds no
/// place, and it would suggest a grid for what is left when it looks at each twentieth. One of all
/// longitudes lies around `meridian`, if that is given, the middle of a map of all longitudes: a
/// corner on the map's rim could come to lie on either side, and posts are as dense as corners are
/// apart.
Dataset outlineOf(GDALDatasetH heights, std::optional<double> meridian);

/// A lazily computed reprojection of a raster of heights in metres, which must outlive it: to the
/// grid that GDAL suggests, or to `box` of `grid`. `name` is for messages.
absl::StatusOr<Dataset> reprojected(GDALDatasetH heights, const std::string& name,
                                    const std::string& targetWkt, QuietGdal& gdal);
absl::StatusOr<Dataset> reprojected(GDALDatasetH heights, const std::string& name,
                                    const std::string& targetWkt, const PixelGrid& grid,
                                    const PixelBox& box, QuietGdal& gdal);

}  // namespace eyrie::import
