// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <absl/status/status.h>

#include "renderer/import/height_source.h"
#include "renderer/import/progress.h"
#include "renderer/import/terrain_stages.h"
#include "renderer/terrain/deviation.h"

namespace eyrie::import {

/// An elevation model of the source's shape with room on `scratch`, and no heights yet.
terrain::ElevationModel emptyModel(const terrain::GridFrame& frame, terrain::Scratch& scratch);

/// Tiles of 128 cells that are read into a model, and those whose posts its statistics count.
struct ReadingShare {
    terrain::TileFilter needed = {};
    terrain::TileFilter counted = {};
};

/// Reads `source`, all of it or a share, into `model`: heights, statistics, summary. Lone posts
/// (lone_posts.h) are nodata but in the statistics, which are of the source. Its stage is
/// HeightSource::readingStage; memory for a few strips of 129 rows. Errors: the source's, the
/// scratch's, Cancelled.
absl::Status readElevation(HeightSource& source, const terrain::Scratch& scratch,
                           const ImportControl& control, terrain::ElevationModel& model,
                           const ReadingShare& share = {});

/// What reading leaves in memory: of `model`, and what was found in the posts of `source`. Refers
/// to both.
TerrainStages::State readingState(HeightSource& source, terrain::ElevationModel& model);

/// What is wrong with a source, called `name`, all of whose posts are nodata.
absl::Status noHeights(const std::string& name, const HeightSource& source);

/// Adds up the posts of a tile of `frame` but for those that a next tile has, too: over all tiles
/// each post counts once. Rows of `posts` are `stride` apart.
void countTile(const terrain::GridFrame& frame, std::int32_t x, std::int32_t y, const float* posts,
               std::ptrdiff_t stride, terrain::HeightStatistics& statistics);

}  // namespace eyrie::import
