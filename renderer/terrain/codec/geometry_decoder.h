// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "renderer/codec/symbol_shares.h"
#include "renderer/terrain/codec/tile_model.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/eyt_layout.h"

namespace eyrie::terrain {

/// Reads what GeometryEncoder wrote. Whatever the bits are, what a tile takes in time and memory is
/// bounded by its shape, and nothing is read or written out of bounds.
class GeometryDecoder {
public:
    GeometryDecoder(std::span<const std::uint16_t> words, std::span<const std::uint8_t> raw)
        : rans_(words), raw_(raw) {}

    /// Reads what the tiles share, first of all. What is wrong, or null.
    const char* begin();

    /// Decodes the next tile into `vertices` and `indices`, whose sizes are those that `header`
    /// names, and sets the counts of `parts`. What is wrong, or null.
    /// Precondition: `header` and `shape` are possible (see Page::decode).
    const char* decode(const TileHeader& header, const TileShape& shape,
                       std::span<std::uint32_t> vertices, std::span<std::uint16_t> indices,
                       std::array<IndexRange, kTileParts>& parts);

    /// The same as `outline`, outlineWords(header, shape.cells) words of codec/tile_outline.h.
    /// Finds the same wrong.
    const char* decodeOutline(const TileHeader& header, const TileShape& shape,
                              std::span<std::uint32_t> outline,
                              std::array<IndexRange, kTileParts>& parts);

    /// Checks that all bits were used, after the last tile. What is wrong, or null.
    const char* finish() const;

private:
    friend class TileModel<GeometryDecoder>;

    /// One tile while it is decoded, with room for any.
    struct Scratch {
        std::array<std::uint32_t, kMaxTileVertices> positions;
        std::array<std::uint32_t, kMaxTileVertices> heights;
        std::array<std::uint16_t, 3 * kMaxOwnTriangles> interior;
        std::array<std::array<std::uint16_t, 3 * kMaxBorderTriangles>, kTileParts> borders;
    };

    /// Counts triangles in place of writing them down.
    struct Outlining {
        GeometryDecoder& decoder;
        std::array<std::uint32_t, kTileParts> triangles{};

        bool isVertex(int context) { return decoder.flag(context); }
        bool isPresent(int context) { return decoder.flag(context); }
        std::uint32_t height(int context, std::uint32_t foreseen) {
            return decoder.height(context, foreseen);
        }
        void triangle(int part, std::uint16_t, std::uint16_t, std::uint16_t) {
            ++triangles[static_cast<std::size_t>(part)];
        }
    };

    bool isVertex(int context) { return flag(context); }
    bool isPresent(int context) { return flag(context); }
    bool flag(int context);
    std::uint32_t height(int context, std::uint32_t foreseen);
    void triangle(int part, std::uint16_t a, std::uint16_t b, std::uint16_t c);

    const char* checkWalk(const TileHeader& header, std::uint16_t vertices) const;
    const char* checkHeights(const TileHeader& header) const;
    void copyHeights(const TileHeader& header, std::span<std::uint32_t> out) const;
    const char* copyIndices(std::span<std::uint16_t> out,
                            std::array<IndexRange, kTileParts>& parts) const;

    codec::RansDecoder<2> rans_;
    codec::BitReader raw_;
    std::array<codec::AdaptiveFlag, kFlagContexts> flags_;
    std::array<std::array<std::uint32_t, codec::kAllShares>, kHeightContexts> symbols_;
    std::vector<std::uint16_t> slots_;
    std::unique_ptr<Scratch> scratch_ = std::make_unique_for_overwrite<Scratch>();
    std::array<std::uint16_t*, kTileParts> ends_{};  ///< of the parts in `scratch_`
};

}  // namespace eyrie::terrain
