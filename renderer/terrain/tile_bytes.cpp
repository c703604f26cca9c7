// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/tile_bytes.h"

#include <algorithm>

namespace eyrie::terrain {
namespace {

constexpr std::uint64_t kPageTableBytes = 4096;
constexpr double kStepsInOneWord = 4095;

struct Shape {
    std::uint64_t triangles;
    std::uint64_t cells;
    std::uint64_t wordBytes;    ///< of a vertex
    std::uint64_t normalBytes;  ///< where there are any
};

Shape shapeOf(const EytIndex& index, const TileId& tile) {
    const TileRecord& record = index.tile(tile);
    const auto cells = static_cast<std::uint64_t>(Quadtree::cells(tile.level));
    const double relief = record.maxHeightMetres - record.minHeightMetres;
    return {record.triangles, cells, relief > kStepsInOneWord * index.heightStepMetres() ? 8U : 4U,
            2 * (cells + 1) * (cells + 1)};
}

}  // namespace

/// Euler's formula gives half as many vertices as triangles and half the border's. The borders
/// that are drawn beside finer neighbours repeat the own ones with more triangles.
std::uint64_t estimatedTileBytes(const EytIndex& index, const TileId& tile) {
    const Shape shape = shapeOf(index, tile);
    const std::uint64_t normals = index.hasNormals(tile) ? shape.normalBytes : 0;
    if (shape.triangles == 0)
        return normals;
    const std::uint64_t border = std::min(shape.triangles, 4 * shape.cells);
    const std::uint64_t vertices = (shape.triangles + 2 * border) / 2 + 2;
    return shape.wordBytes * vertices + 6 * (shape.triangles + 2 * border) + normals;
}

/// All posts of the tile and the midpoints of its border, two words each; each triangle in the
/// interior or in both forms of a border, and one more for each of the midpoints. A page may have
/// normals that the index does not ask for: of posts that no triangle holds.
std::uint64_t greatestTileBytes(const EytIndex& index, const TileId& tile) {
    const Shape shape = shapeOf(index, tile);
    const std::uint64_t normals = tile.level < index.quadtree.normalLevel() ? 0 : shape.normalBytes;
    if (shape.triangles == 0)
        return normals;
    const std::uint64_t border = 8 * shape.cells;
    const std::uint64_t posts = (shape.cells + 1) * (shape.cells + 1);
    return 8 * (std::min(posts, 3 * shape.triangles) + border) +
           6 * (2 * shape.triangles + border) + normals;
}

std::uint64_t greatestPageBytes(const EytIndex& index, std::uint32_t page) {
    const TileId first = index.quadtree.firstTileOfPage(page);
    std::uint64_t bytes = kPageTableBytes;
    for (int place = 0; place < kPageTiles * kPageTiles; ++place)
        if (const TileId tile{first.level, first.x + place % kPageTiles,
                              first.y + place / kPageTiles};
            index.quadtree.contains(tile))
            bytes += greatestTileBytes(index, tile);
    return bytes;
}

}  // namespace eyrie::terrain
