// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "renderer/import/gdal_handles.h"

namespace eyrie::import {

/// For people, where lengths between posts of a grid, which `reference` places in units of `crs`,
/// are off by more than 1 % from those on the ellipsoid; otherwise, and where `crs` is null or no
/// map of an ellipsoid, empty. It looks at the grid's corners, at its middle and between.
std::string lengthCaveat(OGRSpatialReferenceH crs, const Georeference& reference, int columns,
                         int rows);

}  // namespace eyrie::import
