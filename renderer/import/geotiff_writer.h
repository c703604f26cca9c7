// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/status.h>

#include "renderer/terrain/height_grid.h"

namespace eyrie::import {

/// Writes an unrotated grid as GeoTIFF, float32, in UTM zone 33 north, north row first.
/// Appears whole or not at all (WholeFile). Nothing is left behind on errors: InvalidArgument (no
/// file has this name, but a folder, a pipe or a device), NotFound, PermissionDenied,
/// ResourceExhausted, Unavailable.
absl::Status writeGeoTiff(const terrain::HeightGrid& grid, const std::string& path);

}  // namespace eyrie::import
