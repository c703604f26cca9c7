// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "renderer/import/dem_file.h"

namespace eyrie::import {

/// Rasters as they count, best first: the finest, and of equally fine ones the last named. Numbers
/// of `files`.
std::vector<std::size_t> bestFirst(const std::vector<DemFile>& files);

/// What of `order` is resampled together, so that there is no rim between: rasters of one grid, but
/// those of which `isAlone`. One joins others before it only where it lies over nothing that is
/// passed over by that: of each two that have data for a place the better still wins.
std::vector<std::vector<std::size_t>> runsOf(const std::vector<DemFile>& files,
                                             const std::vector<std::size_t>& order,
                                             const std::function<bool(const DemFile&)>& isAlone);

}  // namespace eyrie::import
