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
    if (record.mixesNodata)
        return {index.bounds(tile)};
    const int down = std::min(kLevelsDown, tile.level);
    const int side = 1 << down;
    const int count = kTilePartsPerSide / side;
    std::vector<fabric::Box> boxes;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const TileId part{tile.level - down, (tile.x << down) + x, (tile.y << down) + y};
            if (!index.quadtree.contains(part))
                continue;
            const fabric::Vec3 error(0, 0, record.errorMetresOf(x * count, y * count, count));
            const fabric::Box source = index.bounds(part);
            boxes.push_back({source.min - error, source.max + error});
        }
    return boxes;
}

}  // namespace eyrie::terrain
