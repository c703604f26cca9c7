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

inline constexpr std::uint32_t kMaxShortHeight = 4095;

/// How a tile's heights become whole numbers from 0 on: (q - base) >> shift.
struct HeightPacking {
    std::int32_t base = 0;
    int shift = 0;
    int wordsPerVertex = 1;

    bool operator==(const HeightPacking&) const = default;
};

/// From the lowest height on, in steps of the greatest power of two that divides all differences;
/// one word a vertex where 12 bits hold every height, two otherwise.
/// Precondition: not empty; |q| < 2^24.
HeightPacking chooseHeightPacking(std::span<const TileVertex> vertices);

/// Vertices as the GPU reads them, see TileGeometry for the bits; positions are x | y << 10.
/// Precondition: out.size() == heights.size() * wordsPerVertex; heights fit.
void packVertices(std::span<const std::uint32_t> positions, std::span<const std::uint32_t> heights,
                  int wordsPerVertex, std::span<std::uint32_t> out);

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
