// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "fabric/channel_task.h"
#include "wire/transport.h"

/// The bytes of a band, little-endian, for its encoder and decoder only.
///
///     u8 form, u8 0, u16 rows
///   Form::Raw: the rows' colour, then their depth where the picture has it.
///   Form::Runs:
///     u32 the colour that pixels outside of runs have; their depth is 0
///     u32 bytes of blocks
///     blocks: the pixels of all runs in order, sixteen by sixteen; the last is filled up with 0
///         u8 bits of green << 4 | bits of red,  u8 bits of alpha << 4 | bits of blue,
///         u8 bits of depth (where the picture has it)
///         colours, then depths: sixteen values each of as many bits as that, lowest first
///     for each row: u16 count of runs << 2 | colour's slopes << 1 | depth's slopes,
///         for each run: u16 first pixel, u16 pixels
///
/// A run's first pixel is predicted to be as the one below it, any other to be as the one left of
/// it or, where the row says "slopes", to differ from that by as much as those below do: reversed
/// depth is linear over a triangle's picture, and its bits as an integer are so up to an octave.
/// The row below is that of Neighbours: where it was not drawn the nearest pixel that was stands
/// in. Differences of colours are taken byte by byte, red's and blue's less green's; all are folded
/// so that small ones of either sign have few bits.
namespace eyrie::wire::active_run {

enum class Form : std::uint8_t { Raw = 0, Runs = 1 };

struct BandHeader {
    Form form = Form::Raw;
    std::uint8_t zero = 0;
    std::uint16_t rows = 0;
};

struct RunsHeader {
    std::uint32_t background = 0;
    std::uint32_t blockBytes = 0;
};

struct Run {
    std::uint16_t first = 0;
    std::uint16_t pixels = 0;
};

inline constexpr unsigned kDepthSlopes = 1;
inline constexpr unsigned kColourSlopes = 2;
inline constexpr unsigned kRunCountShift = 2;
static_assert(fabric::kMaxViewPixels / 2 < 1 << (16 - kRunCountShift));
static_assert(std::endian::native == std::endian::little, "bands are little-endian");

/// How many bits a block has of red, green, blue and alpha.
using ByteBits = std::array<unsigned, 4>;

/// Rows of a band, but for the last: as many as have one chunk of bytes, or one.
inline int rowsInBand(const fabric::PixelViewport& area, bool hasDepth) {
    const std::int64_t rowBytes = std::int64_t{area.width} * (hasDepth ? 8 : 4);
    return static_cast<int>(
        std::clamp<std::int64_t>(std::int64_t{kChunkBytes} / rowBytes, 1, area.height));
}

/// Of 32-bit integers: 0, -1, 1, -2 ... as 0, 1, 2, 3 ...
constexpr std::uint32_t fold(std::uint32_t difference) {
    return (difference << 1) ^ (0U - (difference >> 31));
}
constexpr std::uint32_t unfold(std::uint32_t folded) { return (folded >> 1) ^ (0U - (folded & 1)); }

/// The same of four bytes at once.
constexpr std::uint32_t foldBytes(std::uint32_t differences) {
    const std::uint32_t signs = (differences >> 7) & 0x01010101U;
    return ((differences & 0x7f7f7f7fU) << 1) ^ ((signs << 8) - signs);
}
constexpr std::uint32_t unfoldBytes(std::uint32_t folded) {
    const std::uint32_t signs = folded & 0x01010101U;
    return ((folded >> 1) & 0x7f7f7f7fU) ^ ((signs << 8) - signs);
}

/// Byte by byte, modulo 256.
constexpr std::uint32_t addBytes(std::uint32_t a, std::uint32_t b) {
    return ((a & 0x7f7f7f7fU) + (b & 0x7f7f7f7fU)) ^ ((a ^ b) & 0x80808080U);
}
constexpr std::uint32_t subtractBytes(std::uint32_t a, std::uint32_t b) {
    return ((a | 0x80808080U) - (b & 0x7f7f7f7fU)) ^ ((a ^ ~b) & 0x80808080U);
}

/// Green in the places of red and blue.
constexpr std::uint32_t greenTwice(std::uint32_t colour) {
    const std::uint32_t green = (colour >> 8) & 0xffU;
    return green | green << 16;
}

/// The row below the one at hand, all of its pixels: where it was not drawn the nearest one of it
/// that was, where none of it was what the row below that says, and 0 in the beginning.
class Neighbours {
public:
    explicit Neighbours(int width) : row_(static_cast<std::size_t>(width), 0) {}

    const std::uint32_t* at(int x) const { return row_.data() + x; }

    /// The next row is above `row`, which has `runs`.
    void advance(const std::uint32_t* row, const std::vector<Run>& runs) {
        int filled = 0;
        for (std::size_t i = 0; i < runs.size(); ++i) {
            const int first = runs[i].first;
            const int end = first + runs[i].pixels;
            const bool isLast = i + 1 == runs.size();
            const int half = isLast ? static_cast<int>(row_.size()) : (end + runs[i + 1].first) / 2;
            std::fill(row_.begin() + filled, row_.begin() + first, row[first]);
            std::copy(row + first, row + end, row_.begin() + first);
            std::fill(row_.begin() + end, row_.begin() + half, row[end - 1]);
            filled = half;
        }
    }

private:
    std::vector<std::uint32_t> row_;
};

}  // namespace eyrie::wire::active_run
