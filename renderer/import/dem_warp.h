// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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

/// A lazily computed reprojection of a raster of heights in metres, which must outlive it: to the
/// grid that GDAL suggests, or to `box` of `grid`. `name` is for messages.
absl::StatusOr<Dataset> reprojected(GDALDatasetH heights, const std::string& name,
                                    const std::string& targetWkt, QuietGdal& gdal);
absl::StatusOr<Dataset> reprojected(GDALDatasetH heights, const std::string& name,
                                    const std::string& targetWkt, const PixelGrid& grid,
                                    const PixelBox& box, QuietGdal& gdal);

}  // namespace eyrie::import
