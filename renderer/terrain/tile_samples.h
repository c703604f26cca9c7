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

    /// Where the values lie of the tile's point x, y half sample spacings from its first.
    std::size_t at(std::int32_t x, std::int32_t y) const {
        return static_cast<std::size_t>((y >> halves_) * posts_ + (x >> halves_));
    }
    /// The same of post (i, j), which is such a point, or the grid's last column or row instead.
    std::size_t atPost(std::int32_t i, std::int32_t j) const {
        // Rounded up: the grid's last column may stand for a multiple past it.
        const std::int32_t up = (1 << layer_) - 1;
        return static_cast<std::size_t>(((j - firstRow_ + up) >> layer_) * posts_ +
                                        ((i - firstColumn_ + up) >> layer_));
    }
    float height(std::size_t at) const { return heightsRead_[at]; }
    /// Whether the error of a vertex of the padded grid exceeds the level's threshold.
    bool isNeeded(std::size_t at, int level) const {
        return DeviationScale::exceeded(levelsRead_[at]) > level;
    }
    /// What the triangles that a vertex splits deviate from the source at most.
    double greatestDeviationMetres(std::size_t at) const {
        return levels_.scale().greatestMetres(levelsRead_[at]);
    }
    /// Posts of the tile, those past the grid standing on its edge; without any left out only up to
    /// level 2.
    const std::vector<float>& heights() const { return heightsRead_; }
    /// Whether any of heights() is data.
    bool hasData() const;

private:
    const HeightLayers& heights_;
    const VertexLevels& levels_;
    int layer_ = 0;
    int halves_ = 0;          ///< 1 where half a spacing is no post
    std::int32_t posts_ = 0;  ///< a side
    std::int32_t firstColumn_ = 0;
    std::int32_t firstRow_ = 0;
    std::vector<float> heightsRead_;
    std::vector<std::uint8_t> levelsRead_;
};

}  // namespace eyrie::terrain
