// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/status.h>

#include "renderer/import/page_line.h"
#include "renderer/import/progress.h"
#include "renderer/import/terrain_stages.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/eyt_writer.h"
#include "renderer/terrain/scratch.h"

namespace eyrie::import {

/// Writes the pages of levels `first` to `end` in their order, as buildPages builds them, and fills
/// in what `index` says of them and their tiles. Some pages of a level at a time are a stage of
/// `stages`: those that an earlier run wrote are taken as they are. Errors: those of buildPages,
/// the writer's and the stages'.
absl::Status writeLevels(int first, int end, const PageSources& sources,
                         const terrain::Scratch& scratch, const ImportControl& control,
                         TerrainStages& stages, terrain::EytIndex& index,
                         terrain::EytWriter& writer);

}  // namespace eyrie::import
