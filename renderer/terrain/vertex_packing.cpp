// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/vertex_packing.h"

#include <algorithm>
#include <bit>

namespace eyrie::terrain {

PackedVertices packVertices(std::span<const TileVertex> vertices) {
    PackedVertices packed;
    const auto byHeight = [](const TileVertex& a, const TileVertex& b) { return a.q < b.q; };
    const auto [lowest, highest] = std::minmax_element(vertices.begin(), vertices.end(), byHeight);
    packed.baseHeight = lowest->q;

    std::uint32_t bits = 0;  // set in any height above the lowest
    for (const TileVertex& vertex : vertices)
        bits |= static_cast<std::uint32_t>(vertex.q - packed.baseHeight);
    const int shift = bits == 0 ? 0 : std::countr_zero(bits);
    packed.heightMultiplier = 1 << shift;

    const auto steps = [&](const TileVertex& vertex) {
        return static_cast<std::uint32_t>(vertex.q - packed.baseHeight) >> shift;
    };
    packed.wordsPerVertex = steps(*highest) <= kMaxShortHeight ? 1 : 2;
    packed.words.reserve(vertices.size() * static_cast<std::size_t>(packed.wordsPerVertex));
    for (const TileVertex& vertex : vertices) {
        const std::uint32_t word =
            static_cast<std::uint32_t>(vertex.x) | static_cast<std::uint32_t>(vertex.y) << 10;
        if (packed.wordsPerVertex == 1) {
            packed.words.push_back(word | steps(vertex) << 20);
        } else {
            packed.words.push_back(word);
            packed.words.push_back(steps(vertex));
        }
    }
    return packed;
}

}  // namespace eyrie::terrain
