// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "renderer/terrain/height_grid.h"

namespace eyrie::import {

/// Whether x and y of all posts could be degrees: -360 to 360 and -90 to 90.
bool mayBeDegrees(const terrain::GridFrame& frame);

/// For people, of posts without a CRS of the earth which may be degrees, where they rise or fall
/// by several times as much, in metres, as the grid is wide in its own unit; otherwise empty.
std::string degreesCaveat(const terrain::GridFrame& frame,
                          const terrain::HeightStatistics& heights);

}  // namespace eyrie::import
