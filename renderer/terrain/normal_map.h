// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <absl/status/status.h>

#include "renderer/import/progress.h"
#include "renderer/terrain/deviation.h"
#include "renderer/terrain/quadtree.h"
#include "renderer/terrain/tiled_raster.h"

namespace eyrie::terrain {

inline std::size_t normalMapBytes(int level) {
    const auto side = static_cast<std::size_t>(Quadtree::cells(level) + 1);
    return 2 * side * side;
}

/// Shading normals of all levels that store them (Quadtree::normalLevel()): central differences of
/// the heights, which are smoothed (1-2-1) and thinned by two from one spacing to the next. Made
/// from the whole grid, so neighbours agree on their border samples. Nodata neighbours are left out
/// of a difference; with none left a normal points up. The smoothed heights lie on scratch.
class NormalMaps {
public:
    /// Reserves its room; keeps a reference to `model`.
    NormalMaps(const ElevationModel& model, Scratch& scratch, int levels);

    /// Parallel; stage "smoothing". Errors: Cancelled, the scratch's.
    absl::Status make(const import::ImportControl& control);

    /// x and y of the unit normals of a tile's samples, as TileGeometry::normals describes.
    /// Precondition: out.size() == normalMapBytes(tile.level). Any thread, once made.
    void fill(const TileId& tile, std::span<std::int8_t> out) const;

private:
    const TiledRaster<float>& layer(int shift) const {
        return shift == 0 ? model_.heights : smoothed_[static_cast<std::size_t>(shift - 1)];
    }

    const ElevationModel& model_;
    Scratch& scratch_;
    std::vector<TiledRaster<float>> smoothed_;  // by Quadtree::spacingShift - 1
};

}  // namespace eyrie::terrain
