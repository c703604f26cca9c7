// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/statusor.h>

#include "renderer/import/gdal_handles.h"

namespace eyrie::import {

/// The name under which GDAL looks into a .gz or .zip.
std::string gdalPath(const std::string& path);

/// InvalidArgument when GDAL reads no raster there; `wanted` says what to give instead.
absl::StatusOr<Dataset> openRaster(const std::string& path, const char* wanted, QuietGdal& gdal);

}  // namespace eyrie::import
