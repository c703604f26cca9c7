// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/status.h>

#include "renderer/import/height_source.h"
#include "renderer/import/progress.h"
#include "renderer/terrain/deviation.h"

namespace eyrie::import {

/// An elevation model of the source's shape with room on `scratch`, and no heights yet.
terrain::ElevationModel emptyModel(const terrain::GridFrame& frame, terrain::Scratch& scratch);

/// Reads all of `source` into `model`: heights, statistics, summary. Stage "reading"; memory for a
/// few strips of 129 rows. Errors: the source's, the scratch's, Cancelled.
absl::Status readElevation(HeightSource& source, const terrain::Scratch& scratch,
                           const ImportControl& control, terrain::ElevationModel& model);

}  // namespace eyrie::import
