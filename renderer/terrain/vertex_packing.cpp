// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/vertex_packing.h"

#include <algorithm>
#include <bit>

namespace eyrie::terrain {

HeightPacking chooseHeightPacking(std::span<const TileVertex> vertices) {
    const std::int32_t first = vertices.front().q;
    std::int32_t lowest = first;
    std::int32_t highest = first;
    std::int32_t bits = 0;  // below the lowest one all heights are alike
    for (const TileVertex& vertex : vertices) {
        lowest = std::min(lowest, vertex.q);
        highest = std::max(highest, vertex.q);
        bits |= vertex.q ^ first;
    }
    HeightPacking packing;
    packing.base = lowest;
    packing.shift = bits == 0 ? 0 : std::countr_zero(static_cast<std::uint32_t>(bits));
    const auto steps = static_cast<std::uint32_t>(highest - packing.base) >> packing.shift;
    packing.wordsPerVertex = steps <= kMaxShortHeight ? 1 : 2;
    return packing;
}

void packVertices(std::span<const std::uint32_t> positions, std::span<const std::uint32_t> heights,
                  int wordsPerVertex, std::span<std::uint32_t> out) {
    if (wordsPerVertex == 1) {
        for (std::size_t k = 0; k < heights.size(); ++k) out[k] = positions[k] | heights[k] << 20;
        return;
    }
    for (std::size_t k = 0; k < heights.size(); ++k) {
        out[2 * k] = positions[k];
        out[2 * k + 1] = heights[k];
    }
}

}  // namespace eyrie::terrain
