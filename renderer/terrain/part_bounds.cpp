// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/part_bounds.h"

#include <algorithm>

namespace eyrie::terrain {
namespace {

constexpr int kLevelsDown = 2;
static_assert(1 << kLevelsDown == kTilePartsPerSide);

}  // namespace

std::vector<fabric::Box> partBounds(const EytIndex& index, const TileId& tile) {
    const TileRecord& record = index.tile(tile);
    const int down = std::min(kLevelsDown, tile.level);
    const int side = 1 << down;
    const int count = kTilePartsPerSide / side;
    std::vector<fabric::Box> boxes;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const TileId part{tile.level - down, (tile.x << down) + x, (tile.y << down) + y};
            if (!index.quadtree.contains(part))
                continue;
            fabric::Box box = index.bounds(part);
            if (record.blursOutlineIn(x * count, y * count, count)) {
                box.min.z = record.minHeightMetres;
                box.max.z = record.maxHeightMetres;
            }
            const fabric::Vec3 error(0, 0, record.errorMetresOf(x * count, y * count, count));
            boxes.push_back({box.min - error, box.max + error});
        }
    return boxes;
}

}  // namespace eyrie::terrain
