// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/triangle_blocks.h"

#include <algorithm>

namespace eyrie::terrain {
namespace {

/// About a 36th of what a tile has that is drawn as coarsely as it may be.
constexpr std::uint32_t kIndices = 3 * 64;

void grow(TriangleBlock& block, const TileVertex& vertex) {
    block.low = {std::min(block.low.x, vertex.x), std::min(block.low.y, vertex.y),
                 std::min(block.low.q, vertex.q)};
    block.high = {std::max(block.high.x, vertex.x), std::max(block.high.y, vertex.y),
                  std::max(block.high.q, vertex.q)};
}

}  // namespace

std::vector<TriangleBlock> triangleBlocks(const TileGeometry& geometry) {
    if (geometry.indices.empty())
        return {};
    std::vector<TileVertex> vertices;
    vertices.reserve(geometry.vertexCount());
    for (std::size_t i = 0; i < geometry.vertexCount(); ++i)
        vertices.push_back(unpackVertex(geometry.words, geometry.wordsPerVertex, i,
                                        geometry.baseHeight, geometry.heightMultiplier));
    std::vector<TriangleBlock> blocks;
    for (const IndexRange& part : geometry.parts)
        for (std::uint32_t first = part.first; first < part.first + part.count; first += kIndices) {
            const std::uint32_t count = std::min(kIndices, part.first + part.count - first);
            const TileVertex& any = vertices[geometry.indices[first]];
            TriangleBlock& block = blocks.emplace_back(TriangleBlock{first, count, any, any});
            for (const std::uint16_t corner : geometry.indices.subspan(first, count))
                grow(block, vertices[corner]);
        }
    return blocks;
}

fabric::Box bounds(const EytIndex& index, const TileId& tile, const TriangleBlock& block) {
    const auto post = [&](std::int32_t number, std::int32_t halves, std::int32_t posts) {
        return std::min(number * Quadtree::side(tile.level) +
                            (halves << Quadtree::spacingShift(tile.level)) / 2,
                        posts - 1);
    };
    const auto inLattice = [&](const TileVertex& vertex) {
        return fabric::Vec3(post(tile.x, vertex.x, index.quadtree.columns()),
                            post(tile.y, vertex.y, index.quadtree.rows()), vertex.q);
    };
    return fabric::transformed({inLattice(block.low), inLattice(block.high)},
                               index.objectFromLattice);
}

}  // namespace eyrie::terrain
