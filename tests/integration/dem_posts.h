// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/statusor.h>

#include "renderer/truth/terrain_ray_caster.h"

namespace eyrie::test {

/// The first band of a raster in a projected CRS of metres, read by GDAL alone: a post at each
/// pixel's centre, NaN for nodata. Shares no code with the importer.
absl::StatusOr<truth::HeightGrid> readPosts(const std::string& path);

}  // namespace eyrie::test
