// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "renderer/terrain/codec/tile_model.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/eyt_layout.h"

/// What is left of a tile once its bits are read, and before vertices and indices are written down:
/// which points are vertices, and their heights in the order of the walk. A quarter of the decoded
/// tile. renderer/effects/tile_decode.effect walks it again, many pieces at once.
///
/// In 32-bit words, bit k of a set in word k / 32:
///   OutlineHeader
///   samples that are split points, by slot, row by row; corners and centre not among them
///   points between samples or on the border that a finer level adds, edge by edge, each edge's
///     by half spacings along it
///   if isSparse, the same two sets of those of them that are absent, corners and centre included
///   heights: 16 bits each where a vertex takes one word, else 32
namespace eyrie::terrain {

struct OutlineHeader {
    std::uint32_t cells = 0;
    std::uint32_t limitX = 0;  ///< of TileShape, as are the next two
    std::uint32_t limitY = 0;
    std::uint32_t finerEdges = 0;
    std::uint32_t isSparse = 0;
    std::uint32_t vertices = 0;
    std::uint32_t wordsPerVertex = 0;
    std::array<std::uint32_t, kTileParts> firstTriangles{};  ///< of each part
};
inline constexpr std::size_t kOutlineHeaderWords = sizeof(OutlineHeader) / sizeof(std::uint32_t);

/// Words of the set of samples, and of one edge's finer points.
constexpr std::size_t sampleSetWords(std::size_t cells) {
    return ((cells + 1) * (cells + 1) + 31) / 32;
}
constexpr std::size_t edgeSetWords(std::size_t cells) { return 2 * cells / 32 + 1; }

/// Words of both, of split or of absent points.
constexpr std::size_t pointSetWords(std::size_t cells) {
    return sampleSetWords(cells) + kEdges * edgeSetWords(cells);
}

/// Words of a whole outline.
inline std::size_t outlineWords(const TileHeader& tile, std::size_t cells) {
    const std::size_t heights =
        tile.wordsPerVertex == 1 ? (std::size_t{tile.vertices} + 1) / 2 : tile.vertices;
    return kOutlineHeaderWords + (tile.isSparse != 0 ? 2 : 1) * pointSetWords(cells) + heights;
}

/// A walk's source that passes on to TileModel and notes, in the zeroed sets of an outline, what
/// the walk's slots do not keep: finer points and absent ones.
template <typename Bits>
class OutlineModel {
public:
    /// `absent` is empty where no point can be.
    OutlineModel(TileModel<Bits>& model, std::size_t cells, std::span<std::uint32_t> split,
                 std::span<std::uint32_t> absent)
        : model_(model),
          side_(static_cast<std::int32_t>(2 * cells)),
          samplesEnd_(32 * sampleSetWords(cells)),
          edgeBits_(32 * edgeSetWords(cells)),
          split_(split),
          absent_(absent) {}

    bool isVertex(TilePoint middle, const SplitContext& context) {
        return model_.isVertex(middle, context);
    }
    bool isFinerVertex(TilePoint middle, int length) {
        return model_.isFinerVertex(middle, length);
    }
    std::uint16_t addCorner(TilePoint p, TilePoint before) {
        return noted(p.slot, model_.addCorner(p, before));
    }
    std::uint16_t addMiddle(TilePoint middle, TilePoint apex, TilePoint left, TilePoint right,
                            int steps) {
        return noted(middle.slot, model_.addMiddle(middle, apex, left, right, steps));
    }
    std::uint16_t addFinerMiddle(TilePoint middle, TilePoint apex, TilePoint from, TilePoint to,
                                 int length) {
        const std::size_t bit = finerBit(middle);
        split_[bit / 32] |= 1U << bit % 32;
        return noted(bit, model_.addFinerMiddle(middle, apex, from, to, length));
    }
    void triangle(int part, TilePoint a, TilePoint b, TilePoint c) {
        model_.triangle(part, a, b, c);
    }
    void finerTriangle(int part, TilePoint apex, TilePoint from, TilePoint to, bool isWhole) {
        model_.finerTriangle(part, apex, from, to, isWhole);
    }

private:
    std::size_t finerBit(TilePoint p) const {
        const bool isAlongX = p.y() == 0 || p.y() == side_;
        const int edge =
            isAlongX ? (p.y() == 0 ? kEdgeMinY : kEdgeMaxY) : (p.x() == 0 ? kEdgeMinX : kEdgeMaxX);
        return samplesEnd_ + static_cast<std::size_t>(edge) * edgeBits_ +
               static_cast<std::size_t>(isAlongX ? p.x() : p.y());
    }
    std::uint16_t noted(std::size_t bit, std::uint16_t number) {
        if (number == kAbsentPoint)
            absent_[bit / 32] |= 1U << bit % 32;
        return number;
    }

    TileModel<Bits>& model_;
    std::int32_t side_;
    std::size_t samplesEnd_;
    std::size_t edgeBits_;
    std::span<std::uint32_t> split_;
    std::span<std::uint32_t> absent_;
};

}  // namespace eyrie::terrain
