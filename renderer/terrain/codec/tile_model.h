// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "renderer/terrain/tile_triangulation.h"

/// What a page's bits say of a tile's geometry, and how each of them is foreseen. Encoder and
/// decoder share all of it and differ only in where the answers come from.
namespace eyrie::terrain {

/// Contexts of flags, adaptive.
inline constexpr int kSplitContexts = 6 * 3 * 9;
inline constexpr int kFinerContexts = 10;
inline constexpr int kPresenceContexts = 4;
inline constexpr int kFlagContexts = kSplitContexts + kFinerContexts + kPresenceContexts;
/// Contexts of heights, each with symbol shares of its own in every page.
inline constexpr int kHeightContexts = 8;
inline constexpr std::uint8_t kFinerHeightContext = kHeightContexts - 2;
inline constexpr std::uint8_t kCornerHeightContext = kHeightContexts - 1;

/// Of a point added with that many steps to go.
inline std::uint8_t middleContext(int steps) {
    return static_cast<std::uint8_t>(std::min<int>(steps, kFinerHeightContext - 1));
}

inline int splitContext(const SplitContext& c) {
    return (std::min(c.steps, 5) * 3 + c.legsUnsplit) * 9 + c.aroundSplit * 3 + c.aroundUnsplit;
}
inline int finerContext(int length) {
    return kSplitContexts + std::bit_width(static_cast<unsigned>(length));
}
inline int presenceContext(int absentNeighbours) {
    return kSplitContexts + kFinerContexts + absentNeighbours;
}

/// A height's difference from the foreseen one as a symbol and raw bits: small ones are symbols of
/// their own, of larger ones the symbol holds the two leading bits.
struct Residual {
    static constexpr std::uint32_t kDirect = 16;
    static constexpr std::uint32_t kSymbols = kDirect + 2 * 28;

    std::uint32_t symbol = 0;
    std::uint32_t rawBits = 0;
    std::uint32_t raw = 0;

    static Residual of(std::uint32_t height, std::uint32_t foreseen) {
        const std::uint32_t difference = height - foreseen;
        const std::uint32_t zigzag = difference << 1 ^ -(difference >> 31);
        if (zigzag < kDirect)
            return {zigzag, 0, 0};
        const auto shift = static_cast<std::uint32_t>(std::bit_width(zigzag)) - 2;
        return {kDirect + 2 * (shift - 3) + (zigzag >> shift & 1), shift,
                zigzag & ((1U << shift) - 1)};
    }
    static std::uint32_t rawBitsOf(std::uint32_t symbol) {
        return symbol < kDirect ? 0 : (symbol - kDirect) / 2 + 3;
    }
    std::uint32_t heightFrom(std::uint32_t foreseen) const {
        const std::uint32_t zigzag =
            symbol < kDirect ? symbol : (2 | (symbol & 1)) << rawBits | raw;
        return foreseen + (zigzag >> 1 ^ -(zigzag & 1));
    }
};

/// The walk's source on both sides. `Bits` is the page's encoder or decoder:
///   bool isVertex(int context), bool isPresent(int context)
///   uint32 height(int context, uint32 foreseen)      in units of the tile's height multiplier
///   void triangle(int part, a, b, c)                 of present points
template <typename Bits>
class TileModel {
public:
    /// `positions` and `heights` have room for kMaxTileVertices and are filled in.
    TileModel(Bits& bits, bool isSparse, std::uint32_t* positions, std::uint32_t* heights)
        : bits_(bits), isSparse_(isSparse), positions_(positions), heights_(heights) {}

    std::uint16_t vertices() const { return vertices_; }

    bool isVertex(TilePoint, const SplitContext& context) {
        return bits_.isVertex(splitContext(context));
    }
    bool isFinerVertex(TilePoint, int length) { return bits_.isVertex(finerContext(length)); }
    std::uint16_t addCorner(TilePoint p, TilePoint before) {
        before.number = vertices_ == 0 ? kAbsentPoint : static_cast<std::uint16_t>(vertices_ - 1);
        return add(p, before, before, before, kCornerHeightContext);
    }
    std::uint16_t addMiddle(TilePoint middle, TilePoint apex, TilePoint left, TilePoint right,
                            int steps) {
        return add(middle, apex, left, right, middleContext(steps));
    }
    std::uint16_t addFinerMiddle(TilePoint middle, TilePoint apex, TilePoint from, TilePoint to,
                                 int) {
        return add(middle, apex, from, to, kFinerHeightContext);
    }
    void triangle(int part, TilePoint a, TilePoint b, TilePoint c) {
        if (!isSparse_ || !(a.isAbsent() || b.isAbsent() || c.isAbsent()))
            bits_.triangle(part, a.number, b.number, c.number);
    }
    void finerTriangle(int part, TilePoint apex, TilePoint from, TilePoint to, bool) {
        triangle(part, apex, from, to);
    }

    /// What the three above come to.
    std::uint16_t add(TilePoint p, TilePoint apex, TilePoint left, TilePoint right, int context) {
        std::uint32_t foreseen;
        if (!isSparse_) [[likely]] {
            foreseen = vertices_ == 0 ? 0 : (heights_[left.number] + heights_[right.number]) / 2;
        } else {
            if (!bits_.isPresent(
                    presenceContext(apex.isAbsent() + left.isAbsent() + right.isAbsent())))
                return kAbsentPoint;
            foreseen = fromPresent(apex, left, right);
        }
        positions_[vertices_] = p.position;
        heights_[vertices_] = bits_.height(context, foreseen);
        return vertices_++;
    }

private:
    std::uint32_t fromPresent(TilePoint apex, TilePoint left, TilePoint right) const {
        if (!left.isAbsent() && !right.isAbsent())
            return (heights_[left.number] + heights_[right.number]) / 2;
        for (const TilePoint& p : {left, right, apex})
            if (!p.isAbsent())
                return heights_[p.number];
        return vertices_ == 0 ? 0 : heights_[vertices_ - 1];
    }

    Bits& bits_;
    bool isSparse_;
    std::uint32_t* positions_;
    std::uint32_t* heights_;
    std::uint16_t vertices_ = 0;
};

}  // namespace eyrie::terrain
