// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/dem_file.h"
#include "renderer/import/dem_source.h"

namespace eyrie::import {

/// Brings several rasters, or one in degrees, to one grid in metres, as openDems says, and leaves
/// the hash to it. `gdal` outlives the call. Errors: those of openDems but for the files' own.
absl::StatusOr<DemSource> mosaicOf(std::vector<DemFile> files, QuietGdal& gdal);

}  // namespace eyrie::import
