// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace eyrie::terrain {

/// A tile's vertex before packing: x and y in half sample spacings from the tile's first post
/// (0 to twice the tile's cells, 256 at most), q in height steps of the lattice.
struct TileVertex {
    std::int32_t x = 0;
    std::int32_t y = 0;
    std::int32_t q = 0;

    bool operator==(const TileVertex&) const = default;
};

/// Vertices as the GPU reads them; see TileGeometry for the bits.
struct PackedVertices {
    std::int32_t baseHeight = 0;
    std::int32_t heightMultiplier = 1;
    int wordsPerVertex = 1;
    std::vector<std::uint32_t> words;
};

inline constexpr std::uint32_t kMaxShortHeight = 4095;

/// One word a vertex where 12 bits hold every height above the lowest, two otherwise. The
/// multiplier is the greatest power of two that divides all differences of height.
/// Precondition: not empty; x and y from 0 to twice the tile's cells, 256 at most; |q| < 2^24.
PackedVertices packVertices(std::span<const TileVertex> vertices);

inline TileVertex unpackVertex(std::span<const std::uint32_t> words, int wordsPerVertex,
                               std::size_t vertex, std::int32_t baseHeight,
                               std::int32_t heightMultiplier) {
    const std::size_t first = vertex * static_cast<std::size_t>(wordsPerVertex);
    const std::uint32_t word = words[first];
    const std::uint32_t height = (word >> 20) + (wordsPerVertex == 2 ? words[first + 1] : 0);
    return {static_cast<std::int32_t>(word & 1023), static_cast<std::int32_t>(word >> 10 & 1023),
            baseHeight + static_cast<std::int32_t>(height) * heightMultiplier};
}

}  // namespace eyrie::terrain
