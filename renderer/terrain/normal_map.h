// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/terrain/height_grid.h"
#include "renderer/terrain/quadtree.h"

#include <cstdint>
#include <span>
#include <vector>

namespace eyrie::terrain {

inline constexpr std::size_t kNormalMapBytes =
    2 * static_cast<std::size_t>(kTileSamples) * kTileSamples;

/// Shading normals of all levels: central differences of the heights, which each coarser level
/// smooths (1-2-1) and thins by two. Made from the whole grid, so neighbours agree on their border
/// samples. Nodata neighbours are left out of a difference; with none left a normal points up.
class NormalMaps {
public:
    /// Keeps a reference to `grid`. Parallel.
    NormalMaps(const HeightGrid& grid, int levels);

    /// x and y of the unit normals of a tile's samples, as TileGeometry::normals describes.
    /// Precondition: out.size() == kNormalMapBytes.
    void fill(const TileId& tile, std::span<std::int8_t> out) const;

private:
    struct Level {
        std::int32_t columns = 0;
        std::int32_t rows = 0;
        std::vector<float> smoothed;  ///< empty at level 0, which is the grid
    };

    const float* row(int level, std::int32_t j) const;
    void smoothRow(int level, std::int32_t j);

    const HeightGrid& grid_;
    std::vector<Level> levels_;
};

}  // namespace eyrie::terrain
