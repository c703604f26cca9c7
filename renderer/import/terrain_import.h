// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/progress.h"
#include "renderer/terrain/height_grid.h"

namespace eyrie::import {

/// Error allowed at level L >= 1: this share of postMetres * 2^(L - 2), which from level 2 on is
/// the spacing of the level's samples. Level 0 is exact where heights are whole metres, and within
/// three quarters of a height step otherwise. Over real and synthetic mountains 3/8 draws the
/// fewest triangles at 1 and 2 pixels (1/4 and 1/2 draw up to a fifth more), 800 to 4000 a tile.
inline constexpr double kErrorPerSpacing = 0.375;

/// What an import made.
struct TerrainImportReport {
    std::int32_t columns = 0;
    std::int32_t rows = 0;
    int levels = 0;
    std::uint64_t triangles = 0;  ///< of level 0
    std::uint64_t nodataPosts = 0;
    std::uint64_t sizeBytes = 0;
    double postMetres = 0;
    double heightStepMetres = 0;
    double finestErrorMetres = 0;
    double coarsestErrorMetres = 0;
    std::vector<std::string> notes;  ///< what was assumed or changed, for people
};

/// Makes an .eyt of the elevation model `dem`. `out` appears complete or not at all.
/// Stages reported: reading, measuring, smoothing, building.
/// Errors: those of readDem; NotFound, PermissionDenied, ResourceExhausted for `out`; Cancelled.
absl::StatusOr<TerrainImportReport> importTerrain(const std::string& dem, const std::string& out,
                                                  const ImportControl& control);

/// What an .eyt says of where its grid came from.
struct TerrainSource {
    std::string name;  ///< for messages
    std::string crsWkt;
    std::uint64_t hash = 0;
};

/// The same from a grid in memory. InvalidArgument also when no cell has data on three corners.
absl::StatusOr<TerrainImportReport> importTerrain(const terrain::HeightGrid& grid,
                                                  const TerrainSource& source,
                                                  const std::string& out,
                                                  const ImportControl& control);

}  // namespace eyrie::import
