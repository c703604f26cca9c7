// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/terrain/height_layers.h"
#include "renderer/terrain/quadtree.h"
#include "renderer/terrain/vertex_levels.h"

namespace eyrie::terrain {

/// Heights and vertex levels of one tile after the other, at the tile's own and the next finer
/// sample spacing. One object per thread; keeps references to what it is made from.
class TileSamples {
public:
    TileSamples(const HeightLayers& heights, const VertexLevels& levels)
        : heights_(heights), levels_(levels) {}

    void load(const TileId& tile);

    /// Of post (i, j) of the tile loaded, which is a multiple of half a sample spacing from its
    /// first, or the grid's last column or row instead.
    float height(std::int32_t i, std::int32_t j) const { return heightsRead_[index(i, j)]; }
    /// Whether the error of vertex (i, j) of the padded grid exceeds the level's threshold.
    bool isNeeded(std::int32_t i, std::int32_t j, int level) const {
        return levelsRead_[index(i, j)] > level;
    }
    /// Posts of the tile, those past the grid standing on its edge; without any left out only up to
    /// level 2.
    const std::vector<float>& heights() const { return heightsRead_; }
    /// Whether any of heights() is data.
    bool hasData() const;

private:
    std::size_t index(std::int32_t i, std::int32_t j) const {
        // Rounded up: the grid's last column may stand for a multiple past it.
        const std::int32_t up = (1 << layer_) - 1;
        return static_cast<std::size_t>(((j - firstRow_ + up) >> layer_) * posts_ +
                                        ((i - firstColumn_ + up) >> layer_));
    }

    const HeightLayers& heights_;
    const VertexLevels& levels_;
    int layer_ = 0;
    std::int32_t posts_ = 0;  ///< a side
    std::int32_t firstColumn_ = 0;
    std::int32_t firstRow_ = 0;
    std::vector<float> heightsRead_;
    std::vector<std::uint8_t> levelsRead_;
};

}  // namespace eyrie::terrain
