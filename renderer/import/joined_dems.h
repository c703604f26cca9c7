// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "renderer/import/dem_file.h"

namespace eyrie::import {

/// Whether two files' pixels are pixels of one grid, to a thousandth of one. Degrees are counted
/// the short way round.
bool isOneGrid(const DemFile& first, const DemFile& file);

/// Files of one grid as one raster, so that there is no rim between them: resampled one by one
/// each would be flat for half a pixel at its own. Where some overlap the first that has data wins;
/// what none covers is nodata. The files must outlive it.
Dataset joined(std::span<const DemFile> files);

}  // namespace eyrie::import
