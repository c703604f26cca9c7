// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <vector>

#include "renderer/draw/prefetch.h"
#include "renderer/draw/terrain_items.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::draw {

/// Tiles and texture tiles that the coming frames may need, less the top ones: large ones on the
/// ground first, the ground before its pictures. `tauPixels` and `texelPixels` are what they are
/// drawn at, `latency` how far ahead to look.
std::vector<TerrainItem> itemsAhead(const Prefetch& prefetch, const terrain::EytIndex& index,
                                    const TerrainItems& items, double tauPixels, double texelPixels,
                                    std::chrono::duration<double> latency);

}  // namespace eyrie::draw
