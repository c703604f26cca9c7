// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/imagery/bc1.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <utility>

#define STB_DXT_STATIC
#define STB_DXT_IMPLEMENTATION
#include <stb/stb_dxt.h>

namespace eyrie::terrain {
namespace {

static_assert(std::endian::native == std::endian::little);

using Palette = std::array<fabric::Rgba, 4>;

fabric::Rgba expanded(std::uint16_t colour) {
    const auto wider = [](unsigned value, int bits) {
        return static_cast<std::uint8_t>(value << (8 - bits) | value >> (2 * bits - 8));
    };
    return {wider(colour >> 11, 5), wider(colour >> 5 & 63U, 6), wider(colour & 31U, 5), 255};
}

fabric::Rgba between(const fabric::Rgba& a, const fabric::Rgba& b, unsigned ofA, unsigned all) {
    const auto mix = [&](std::uint8_t x, std::uint8_t y) {
        return static_cast<std::uint8_t>((ofA * x + (all - ofA) * y + all / 2) / all);
    };
    return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b), 255};
}

Palette paletteOf(const Bc1Block& block) {
    const fabric::Rgba a = expanded(block.first);
    const fabric::Rgba b = expanded(block.second);
    if (block.first > block.second)
        return {a, b, between(a, b, 2, 3), between(a, b, 1, 3)};
    return {a, b, between(a, b, 1, 2), fabric::Rgba{0, 0, 0, 0}};
}

bool isHole(const fabric::Rgba& texel) { return texel.a < 128; }

Bc1Block withoutHoles(const BlockTexels& texels) {
    Bc1Block block;
    stb_compress_dxt_block(reinterpret_cast<unsigned char*>(&block),
                           reinterpret_cast<const unsigned char*>(texels.data()), 0,
                           STB_DXT_HIGHQUAL);
    return block;
}

int distance(const fabric::Rgba& a, const fabric::Rgba& b) {
    const int red = a.r - b.r;
    const int green = a.g - b.g;
    const int blue = a.b - b.b;
    return red * red + green * green + blue * blue;
}

/// With the end colours of a block whose holes are filled with one of its texels.
Bc1Block withHoles(const BlockTexels& texels) {
    BlockTexels filled = texels;
    std::replace_if(filled.begin(), filled.end(), isHole,
                    *std::find_if_not(texels.begin(), texels.end(), isHole));
    Bc1Block block = withoutHoles(filled);
    if (block.first > block.second)
        std::swap(block.first, block.second);
    const Palette palette = paletteOf(block);
    block.choices = 0;
    for (std::size_t k = texels.size(); k-- > 0;) {
        std::uint32_t best = isHole(texels[k]) ? 3 : 0;
        for (std::uint32_t choice = 1; choice < 3 && best != 3; ++choice)
            if (distance(texels[k], palette[choice]) < distance(texels[k], palette[best]))
                best = choice;
        block.choices = block.choices << 2 | best;
    }
    return block;
}

}  // namespace

Bc1Block encodeBc1(const BlockTexels& texels) {
    if (std::all_of(texels.begin(), texels.end(), isHole))
        return kBc1Hole;
    if (std::any_of(texels.begin(), texels.end(), isHole))
        return withHoles(texels);
    return withoutHoles(texels);
}

BlockTexels decodeBc1(const Bc1Block& block) {
    const Palette palette = paletteOf(block);
    BlockTexels texels;
    for (unsigned k = 0; k < 16; ++k) texels[k] = palette[block.choices >> (2 * k) & 3U];
    return texels;
}

void decodeBc1(std::span<const Bc1Block> blocks, std::int32_t blocksX,
               std::span<fabric::Rgba> out) {
    const auto across = static_cast<std::size_t>(blocksX);
    for (std::size_t k = 0; k < blocks.size(); ++k) {
        const Palette palette = paletteOf(blocks[k]);
        fabric::Rgba* to = out.data() + (k / across * 4 * across + k % across) * 4;
        std::uint32_t choices = blocks[k].choices;
        for (int row = 0; row < 4; ++row, to += 4 * across)
            for (int column = 0; column < 4; ++column, choices >>= 2)
                to[column] = palette[choices & 3U];
    }
}

}  // namespace eyrie::terrain
