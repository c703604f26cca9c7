// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/terrain/height_grid.h"
#include "renderer/terrain/quadtree.h"

namespace eyrie::terrain {

inline std::size_t normalMapBytes(int level) {
    const auto side = static_cast<std::size_t>(Quadtree::cells(level) + 1);
    return 2 * side * side;
}

/// Shading normals of all levels: central differences of the heights, which are smoothed (1-2-1)
/// and thinned by two from one spacing to the next. Made from the whole grid, so neighbours agree
/// on their border samples. Nodata neighbours are left out of a difference; with none left a normal
/// points up.
class NormalMaps {
public:
    /// Keeps a reference to `grid`. Parallel.
    NormalMaps(const HeightGrid& grid, int levels);

    /// x and y of the unit normals of a tile's samples, as TileGeometry::normals describes.
    /// Precondition: out.size() == normalMapBytes(tile.level).
    void fill(const TileId& tile, std::span<std::int8_t> out) const;

private:
    struct Thinned {
        std::int32_t columns = 0;
        std::int32_t rows = 0;
        std::vector<float> heights;  ///< empty at shift 0, which is the grid
    };

    const float* row(int shift, std::int32_t j) const;
    void smoothRow(int shift, std::int32_t j);

    const HeightGrid& grid_;
    std::vector<Thinned> thinned_;  // by Quadtree::spacingShift
};

}  // namespace eyrie::terrain
