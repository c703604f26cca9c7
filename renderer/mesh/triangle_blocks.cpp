// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/triangle_blocks.h"

#include <algorithm>

#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

constexpr std::size_t kIndices = 3 * 128;  // of a block: a 128th of a node

}  // namespace

std::vector<TriangleBlock> triangleBlocks(const NodeGeometry& geometry) {
    std::vector<TriangleBlock> blocks;
    blocks.reserve(geometry.indices.size() / kIndices + 1);
    for (std::size_t first = 0; first < geometry.indices.size(); first += kIndices) {
        const std::size_t count = std::min(kIndices, geometry.indices.size() - first);
        TriangleBlock& block = blocks.emplace_back(TriangleBlock{
            static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count), {}});
        for (const std::uint16_t corner : geometry.indices.subspan(first, count))
            block.bounds.grow(unpackPosition(geometry.positions[corner]));
    }
    return blocks;
}

}  // namespace eyrie::mesh
