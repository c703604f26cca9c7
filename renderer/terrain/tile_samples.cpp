// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/tile_samples.h"

#include <algorithm>

namespace eyrie::terrain {

void TileSamples::load(const TileId& tile) {
    const std::int32_t side = Quadtree::side(tile.level);
    layer_ = std::max(0, Quadtree::spacingShift(tile.level) - 1);
    halves_ = Quadtree::spacingShift(tile.level) == 0 ? 1 : 0;
    posts_ = (side >> layer_) + 1;
    firstColumn_ = tile.x * side;
    firstRow_ = tile.y * side;
    const PostRect rect{firstColumn_ >> layer_, firstRow_ >> layer_, posts_, posts_};
    const auto count = static_cast<std::size_t>(posts_) * static_cast<std::size_t>(posts_);
    heightsRead_.resize(count);
    levelsRead_.resize(count);
    readClamped(heights_.layer(layer_), rect, heightsRead_.data());
    levels_.read(layer_, rect, levelsRead_.data());
}

bool TileSamples::hasData() const {
    return std::any_of(heightsRead_.begin(), heightsRead_.end(), [](float h) { return h == h; });
}

}  // namespace eyrie::terrain
