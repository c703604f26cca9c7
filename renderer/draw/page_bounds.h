// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "renderer/draw/drawable.h"
#include "renderer/terrain/terrain_cut.h"

namespace eyrie::draw {

/// The boxes of the pages that the visible tiles of a cut lie in, as pieces: `index` is the page.
/// They depend on the view's cut alone, not on the channel. A box stands a little off those of its
/// tiles, so that no line of one has the depth of one of the other, and has the place in the range
/// of the page's first tile.
std::vector<Piece> pagePieces(const terrain::EytIndex& index, const terrain::TerrainCut& cut);

}  // namespace eyrie::draw
