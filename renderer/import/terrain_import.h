// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/height_source.h"
#include "renderer/import/progress.h"
#include "renderer/terrain/height_grid.h"
#include "renderer/terrain/imagery/imagery_index.h"

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
    std::optional<terrain::ImagerySummary> imagery = {};
    std::vector<std::string> notes;  ///< what was assumed or changed, for people
};

/// How an import goes about it. None but imagery and errorMetres changes what is made.
struct TerrainImportOptions {
    /// Of the whole process, about; at least kLeastImportMemory. What does not fit goes to a
    /// scratch file.
    std::uint64_t memoryBytes = std::uint64_t{512} << 20;
    /// Folder for the scratch file; empty: that of the output.
    std::string scratchFolder = {};
    /// What heights of level 0 may be off; none: nothing that its lattice of heights can tell.
    std::optional<double> errorMetres = {};
    std::vector<std::string> imagery = {};  ///< pictures to lay over it, see openImagery
    bool startsOver = false;                ///< ignores what an interrupted import left
    bool mergesParts = false;               ///< takes what importTerrainShard has made
    int threads = 0;                        ///< GDAL's, too; 0: all
};

inline constexpr std::uint64_t kLeastImportMemory = std::uint64_t{192} << 20;

/// What an .eyt says of where its posts came from.
struct TerrainSource {
    std::string name;  ///< for messages
    std::string crsWkt;
    std::uint64_t hash = 0;
    bool isRounded = false;     ///< its posts are to floats
    bool mayBeDegrees = false;  ///< DemSource::mayBeDegrees
};

/// Makes an .eyt of elevation models, mosaicked as openMosaic says. `out` appears complete or not
/// at all.
///
/// What does not fit in memory lies in `OUT.scratch` until the import is done, and what is written
/// of the file in `OUT.partial`. An import that was called off, killed or ran out of disk leaves
/// them, and the same call goes on after the last stage, or batch of pages or texture tiles, that
/// was finished; the result is the same to the byte. Imports that fit leave nothing, and remove
/// what one that did not has left there.
///
/// With `mergesParts` what importTerrainShard has left beside `out` takes the place of reading and
/// measuring the posts and of building the finer pages; the parts are removed in the end. The file
/// is the same to the byte.
///
/// Stages reported: checking, reading, measuring (gathering and collecting of parts), joining,
/// building, with smoothing and thinning between its levels, imagery.
/// Errors: those of openMosaic, openImagery, buildImagery and PartSet; NotFound, PermissionDenied,
/// ResourceExhausted for `out` and the scratch; FailedPrecondition while another import into `out`
/// is at work; InvalidArgument when no triangle has data at its corners; Cancelled.
absl::StatusOr<TerrainImportReport> importTerrain(const std::vector<std::string>& dems,
                                                  const std::string& out,
                                                  const TerrainImportOptions& options,
                                                  const ImportControl& control);

/// The same of any source of posts; `source.hash` stands for all that it would give.
absl::StatusOr<TerrainImportReport> importTerrain(HeightSource& posts, const TerrainSource& source,
                                                  const std::string& out,
                                                  const TerrainImportOptions& options,
                                                  const ImportControl& control);

/// The same of a grid in memory.
absl::StatusOr<TerrainImportReport> importTerrain(const terrain::HeightGrid& grid,
                                                  const TerrainSource& source,
                                                  const std::string& out,
                                                  const ImportControl& control);

}  // namespace eyrie::import
