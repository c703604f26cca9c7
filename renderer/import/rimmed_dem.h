// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "renderer/import/dem_warp.h"
#include "renderer/import/gdal_handles.h"

namespace eyrie::import {

/// Another raster of heights that may lie beside one.
struct DemNeighbour {
    GDALDatasetH heights = nullptr;
    PixelBox box;  ///< that it covers of the mosaic's grid, to a pixel
};

/// `heights` with a pixel more where it has no data beside some, around its rim and in its holes:
/// of the first of `neighbours` that has the height of such a pixel's centre. Resampled by itself
/// it would be flat for half a pixel there. A neighbour has what lies between posts with data only:
/// beside its own rim it knows no better. NaN is nodata.
///
/// `grid` is the mosaic's, in its `crs` (null: all are without one). What is referred to must
/// outlive it.
Dataset rimmed(GDALDatasetH heights, const std::vector<DemNeighbour>& neighbours,
               const PixelGrid& grid, OGRSpatialReferenceH crs);

}  // namespace eyrie::import
