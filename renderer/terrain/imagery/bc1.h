// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "fabric/image.h"

namespace eyrie::terrain {

/// A block of 4 x 4 texels in 8 bytes (BC1, or S3TC's DXT1), as OpenGL reads it: two colours of
/// 5:6:5 bits, and for each texel, row by row from the least significant bits, which of four it
/// shows: those two and two between them where first > second, and otherwise those two, the one in
/// the middle and a hole.
struct Bc1Block {
    std::uint16_t first = 0;
    std::uint16_t second = 0;
    std::uint32_t choices = 0;

    bool operator==(const Bc1Block&) const = default;
};
static_assert(sizeof(Bc1Block) == 8);

inline constexpr Bc1Block kBc1Hole{0, 0, 0xffffffff};

using BlockTexels = std::array<fabric::Rgba, 16>;

/// Texels whose alpha is below 128 become holes.
Bc1Block encodeBc1(const BlockTexels& texels);

/// Holes are 0, 0, 0, 0: black with an alpha of none, as if premultiplied.
BlockTexels decodeBc1(const Bc1Block& block);

/// Decodes rows of blocks to rows of texels, 4 * blocksX a row.
/// Precondition: blocks.size() is a multiple of blocksX, out.size() == 16 * blocks.size().
void decodeBc1(std::span<const Bc1Block> blocks, std::int32_t blocksX, std::span<fabric::Rgba> out);

}  // namespace eyrie::terrain
