// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/imagery/texture_page.h"

#include <array>
#include <memory>

#include <fmt/format.h>
#include <zstd.h>

namespace eyrie::terrain {
namespace {

constexpr int kLevel = 9;  ///< of zstd
constexpr std::size_t kColours = 6;
constexpr std::size_t kPlanes = kColours + 4;

struct Colour {
    int red;
    int green;
    int blue;
};

Colour colourOf(std::uint16_t packed) { return {packed >> 11, packed >> 5 & 63, packed & 31}; }

std::uint16_t packed(const Colour& c) {
    return static_cast<std::uint16_t>((c.red & 31) << 11 | (c.green & 63) << 5 | (c.blue & 31));
}

Colour operator-(const Colour& a, const Colour& b) {
    return {a.red - b.red, a.green - b.green, a.blue - b.blue};
}
Colour operator+(const Colour& a, const Colour& b) {
    return {a.red + b.red, a.green + b.green, a.blue + b.blue};
}

Colour mean(const Colour& a, const Colour& b) {
    return {(a.red + b.red) / 2, (a.green + b.green) / 2, (a.blue + b.blue) / 2};
}

/// The first colour of block `k`, as those before it let expect.
Colour expected(const Bc1Block* blocks, std::size_t k, std::size_t blocksX) {
    const bool hasLeft = k % blocksX != 0;
    const bool hasUpper = k >= blocksX;
    if (hasLeft && hasUpper)
        return mean(colourOf(blocks[k - 1].first), colourOf(blocks[k - blocksX].first));
    if (hasLeft || hasUpper)
        return colourOf(blocks[hasLeft ? k - 1 : k - blocksX].first);
    return {0, 0, 0};
}

/// A difference modulo 2^bits, as a byte that is small where the difference is: 0, -1, 1, -2 ...
std::uint8_t folded(int difference, int bits) {
    const int half = 1 << (bits - 1);
    const int wrapped = ((difference + half) & (2 * half - 1)) - half;
    return static_cast<std::uint8_t>(wrapped < 0 ? -2 * wrapped - 1 : 2 * wrapped);
}

int unfolded(std::uint8_t value) { return (value & 1) != 0 ? -(value / 2) - 1 : value / 2; }

struct FreeContext {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

std::vector<std::byte> compressed(const std::vector<std::uint8_t>& planes) {
    thread_local const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
    ZSTD_CCtx_reset(context.get(), ZSTD_reset_session_and_parameters);
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kLevel);
    const std::size_t each = planes.size() / kPlanes;
    // Each plane is flushed, and so ends a block of at most its own size and a header.
    std::vector<std::byte> bytes(ZSTD_compressBound(planes.size()) + 64 * kPlanes);
    ZSTD_outBuffer out{bytes.data(), bytes.size(), 0};
    for (std::size_t plane = 0; plane < kPlanes; ++plane) {
        ZSTD_inBuffer in{planes.data() + plane * each, each, 0};
        const auto directive = plane + 1 == kPlanes ? ZSTD_e_end : ZSTD_e_flush;
        while (ZSTD_compressStream2(context.get(), &out, &in, directive) != 0) {
        }
    }
    bytes.resize(out.pos);
    return bytes;
}

}  // namespace

std::vector<std::byte> TexturePage::encode(std::span<const Bc1Block> blocks, std::int32_t blocksX) {
    const std::size_t count = blocks.size();
    std::vector<std::uint8_t> planes(count * kPlanes);
    const auto plane = [&](std::size_t number, std::size_t k) -> std::uint8_t& {
        return planes[number * count + k];
    };
    for (std::size_t k = 0; k < count; ++k) {
        const Colour first = colourOf(blocks[k].first);
        const std::array<Colour, 2> differences = {
            first - expected(blocks.data(), k, static_cast<std::size_t>(blocksX)),
            colourOf(blocks[k].second) - first};
        for (std::size_t c = 0; c < 2; ++c) {
            plane(3 * c, k) = folded(differences[c].red, 5);
            plane(3 * c + 1, k) = folded(differences[c].green, 6);
            plane(3 * c + 2, k) = folded(differences[c].blue, 5);
        }
        for (std::size_t row = 0; row < 4; ++row)
            plane(kColours + row, k) = static_cast<std::uint8_t>(blocks[k].choices >> (8 * row));
    }
    return compressed(planes);
}

absl::StatusOr<TexturePage> TexturePage::decode(std::span<const std::byte> bytes,
                                                std::int32_t blocksX, std::int32_t blocksY,
                                                const std::string& name) {
    const auto count = static_cast<std::size_t>(blocksX) * static_cast<std::size_t>(blocksY);
    std::vector<std::uint8_t> planes(count * kPlanes);
    const std::size_t got =
        ZSTD_decompress(planes.data(), planes.size(), bytes.data(), bytes.size());
    if (ZSTD_isError(got) != 0 || got != planes.size())
        return absl::DataLossError(fmt::format(
            "{}: its {} bytes do not hold {} x {} blocks ({}); import the terrain again", name,
            bytes.size(), blocksX, blocksY,
            ZSTD_isError(got) != 0 ? ZSTD_getErrorName(got) : "too short"));
    std::vector<Bc1Block> blocks(count);
    for (std::size_t k = 0; k < count; ++k) {
        const auto colour = [&](std::size_t first) -> Colour {
            return {unfolded(planes[first * count + k]), unfolded(planes[(first + 1) * count + k]),
                    unfolded(planes[(first + 2) * count + k])};
        };
        Bc1Block& block = blocks[k];
        block.first =
            packed(colour(0) + expected(blocks.data(), k, static_cast<std::size_t>(blocksX)));
        block.second = packed(colour(3) + colourOf(block.first));
        for (std::size_t row = 0; row < 4; ++row)
            block.choices |= std::uint32_t{planes[(kColours + row) * count + k]} << (8 * row);
    }
    return TexturePage(std::move(blocks), blocksX);
}

}  // namespace eyrie::terrain
