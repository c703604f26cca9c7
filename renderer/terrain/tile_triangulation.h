// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/quadtree.h"

/// How a tile's right-triangulated irregular network is walked: the one description that the
/// mesher, which asks the source, and the codec, which asks a page's bits, share. Vertices are
/// numbered and triangles listed in the order of this walk.
namespace eyrie::terrain {

/// What besides the choice of its vertices decides about a tile's triangles.
struct TileShape {
    std::int32_t cells = kFinestTileCells;  ///< Quadtree::cells of its level
    std::int32_t finerStep = 2;  ///< half spacings between samples of the next finer level: 1 or 2
    /// The first column and row, in half spacings, that lies on the grid's last one or beyond it;
    /// 2 * cells where none does. Triangles from there on are squeezed to nothing and left out.
    std::int32_t limitX = 2 * kFinestTileCells;
    std::int32_t limitY = 2 * kFinestTileCells;
    std::uint8_t finerEdges = 0;  ///< bit by Edge: borders that may have to meet a finer level

    bool operator==(const TileShape&) const = default;
};

/// Bounds on what any walk makes.
inline constexpr std::size_t kMaxTileVertices =
    (kMaxTileCells + 1) * (kMaxTileCells + 1) + 4 * 2 * kMaxTileCells;
inline constexpr std::size_t kMaxOwnTriangles = 2 * kMaxTileCells * kMaxTileCells;
inline constexpr std::size_t kMaxBorderTriangles = 2 * kMaxTileCells;  ///< of one part of one edge

/// A point of the walk. `position` is x | y << 10 in half spacings, as TileGeometry packs it.
struct TilePoint {
    std::uint32_t position = 0;
    std::uint16_t slot = 0;  ///< sample, row by row; of no use for a finer level's points
    std::uint16_t number = 0;

    std::int32_t x() const { return static_cast<std::int32_t>(position & 1023); }
    std::int32_t y() const { return static_cast<std::int32_t>(position >> 10); }
    bool isAbsent() const;
};

/// What a slot holds in place of a number.
inline constexpr std::uint16_t kAbsentPoint = 0xfffd;  ///< a vertex without a height: nodata
inline constexpr std::uint16_t kUnsplit = 0xfffe;      ///< known to be no vertex
inline constexpr std::uint16_t kUnknown = 0xffff;
static_assert(kMaxTileVertices <= kAbsentPoint);

inline bool TilePoint::isAbsent() const { return number == kAbsentPoint; }

/// What is known around a sample when it has to be told whether it is a vertex.
struct SplitContext {
    int steps = 0;        ///< times its triangle can still be split, this one not counted
    int legsUnsplit = 0;  ///< of the triangle's two legs
    int aroundSplit = 0;  ///< of two samples as fine, a quarter turn about the apex either way
    int aroundUnsplit = 0;
};

/// Walks one tile. `Source` answers and listens:
///   bool isVertex(TilePoint middle, SplitContext)      asked once a sample
///   bool isFinerVertex(TilePoint middle, int length)   of a border's stretch of `length` steps
///   uint16 addCorner(TilePoint, TilePoint before)      numbers; kAbsentPoint for nodata
///   uint16 addMiddle(TilePoint middle, apex, left, right, int steps)
///   uint16 addFinerMiddle(TilePoint middle, apex, from, to, int length)
///   void triangle(int part, a, b, c)                   of interior or own borders
///   void finerTriangle(int part, apex, from, to, bool isWhole)  isWhole: it is the own border's
/// Triangles are counter-clockwise, absent points among them.
///
/// A triangle's halves are visited so that each begins where the one before ended (Sierpinski's
/// curve): neighbours in the list share vertices.
template <typename Source>
class TileTriangulation {
public:
    /// `slots` is scratch. Keeps references.
    TileTriangulation(const TileShape& shape, std::vector<std::uint16_t>& slots, Source& source)
        : shape_(shape), slots_(slots), source_(source), side_(2 * shape.cells) {}

    void walk() {
        const auto samples = static_cast<std::size_t>(shape_.cells + 1);
        slots_.assign(samples * samples, kUnknown);
        isCut_ = shape_.limitX < side_ || shape_.limitY < side_;
        std::array<TilePoint, 5> corners = {pointAt(0, 0), pointAt(side_, 0), pointAt(side_, side_),
                                            pointAt(0, side_), pointAt(0, 0)};
        for (std::size_t k = 0; k < 4; ++k)
            corners[k].number = source_.addCorner(corners[k], corners[k == 0 ? 0 : k - 1]);
        corners[4] = corners[0];
        TilePoint centre = pointAt(side_ / 2, side_ / 2);
        int steps = 0;
        while (shape_.cells >> (steps / 2 + 2) != 0) steps += 2;
        centre.number = source_.addMiddle(centre, corners[1], corners[0], corners[2], steps + 1);
        constexpr std::array<int, 4> kEdgeOf = {kEdgeMinY, kEdgeMaxX, kEdgeMaxY, kEdgeMinX};
        for (std::size_t k = 0; k < 4; ++k) {
            edge_ = kEdgeOf[k];
            refine<Border::Hypotenuse>(centre, corners[k], corners[k + 1], steps);
        }
    }

private:
    /// Which side of a triangle lies on the tile's border.
    enum class Border { None, Hypotenuse, LeftLeg, RightLeg };

    TilePoint pointAt(std::int32_t x, std::int32_t y) const {
        return {static_cast<std::uint32_t>(x | y << 10),
                static_cast<std::uint16_t>(y / 2 * (shape_.cells + 1) + x / 2), 0};
    }

    static TilePoint middleOf(TilePoint a, TilePoint b) {
        return {(a.position + b.position) / 2, static_cast<std::uint16_t>((a.slot + b.slot) / 2),
                0};
    }

    /// All of it on the grid's last column or row or past them.
    bool isPast(TilePoint a, TilePoint b, TilePoint c) const {
        return std::min({a.x(), b.x(), c.x()}) >= shape_.limitX ||
               std::min({a.y(), b.y(), c.y()}) >= shape_.limitY;
    }

    static bool isVertex(std::uint16_t slot) { return slot <= kAbsentPoint; }

    /// Splits the triangle of right angle `apex` and hypotenuse left-right as far as told.
    template <Border border>
    void refine(TilePoint apex, TilePoint left, TilePoint right, int steps) {
        if (isCut_ && isPast(apex, left, right))
            return;
        if (steps >= 0) {
            TilePoint middle = middleOf(left, right);
            std::uint16_t& slot = slots_[middle.slot];
            if (slot == kUnknown)
                slot = decide(apex, left, right, middle, steps);
            if (slot != kUnsplit) {
                middle.number = slot;
                split<border>(apex, left, right, middle, steps - 1);
                return;
            }
        }
        leaf<border>(apex, left, right);
    }

    template <Border border>
    void split(TilePoint apex, TilePoint left, TilePoint right, TilePoint middle, int steps) {
        constexpr Border kOfLeft = border == Border::Hypotenuse ? Border::RightLeg
                                   : border == Border::LeftLeg  ? Border::Hypotenuse
                                                                : Border::None;
        constexpr Border kOfRight = border == Border::Hypotenuse ? Border::LeftLeg
                                    : border == Border::RightLeg ? Border::Hypotenuse
                                                                 : Border::None;
        if ((steps & 1) != 0) {
            refine<kOfLeft>(middle, apex, left, steps);
            refine<kOfRight>(middle, right, apex, steps);
        } else {
            refine<kOfRight>(middle, right, apex, steps);
            refine<kOfLeft>(middle, apex, left, steps);
        }
    }

    /// Asks, unless a vertex on a leg already needs the split.
    std::uint16_t decide(TilePoint apex, TilePoint left, TilePoint right, TilePoint middle,
                         int steps) {
        SplitContext context;
        context.steps = steps;
        bool isNeeded = false;
        if (steps > 0) {
            const std::uint16_t a = slots_[static_cast<std::size_t>(apex.slot + left.slot) / 2];
            const std::uint16_t b = slots_[static_cast<std::size_t>(apex.slot + right.slot) / 2];
            isNeeded = isVertex(a) || isVertex(b);
            context.legsUnsplit = (a == kUnsplit) + (b == kUnsplit);
        }
        const int turn = (left.slot - right.slot) / 2;
        for (const int at : {apex.slot + turn, apex.slot - turn}) {
            if (static_cast<std::size_t>(at) >= slots_.size())
                continue;  // beyond the tile; beyond its left and right, any sample will do
            const std::uint16_t slot = slots_[static_cast<std::size_t>(at)];
            context.aroundSplit += isVertex(slot);
            context.aroundUnsplit += slot == kUnsplit;
        }
        if (!isNeeded && !source_.isVertex(middle, context))
            return kUnsplit;
        return source_.addMiddle(middle, apex, left, right, steps);
    }

    template <Border border>
    void leaf(TilePoint apex, TilePoint left, TilePoint right) {
        source_.triangle(border == Border::None ? kInteriorPart : kOwnPart + edge_, apex, left,
                         right);
        if constexpr (border != Border::None) {
            if ((shape_.finerEdges >> edge_ & 1) == 0)
                return;
            if constexpr (border == Border::Hypotenuse)
                fan(apex, left, right, true);
            else if constexpr (border == Border::LeftLeg)
                fan(right, apex, left, true);
            else
                fan(left, right, apex, true);
        }
    }

    /// The border triangle apex, from, to, split at the finer level's vertices between from and to.
    void fan(TilePoint apex, TilePoint from, TilePoint to, bool isWhole) {
        const bool isAlongX = edge_ == kEdgeMinY || edge_ == kEdgeMaxY;
        const std::int32_t length =
            isAlongX ? std::abs(to.x() - from.x()) : std::abs(to.y() - from.y());
        TilePoint middle = middleOf(from, to);
        if (length > shape_.finerStep &&
            (isFinerCorner(middle) || source_.isFinerVertex(middle, length))) {
            middle.number = source_.addFinerMiddle(middle, apex, from, to, length);
            fan(apex, from, middle, false);
            fan(apex, middle, to, false);
        } else if (isAlongX ? std::min(from.x(), to.x()) < shape_.limitX
                            : std::min(from.y(), to.y()) < shape_.limitY) {
            source_.finerTriangle(kFinerPart + edge_, apex, from, to, isWhole);
        }
    }

    /// Where two finer tiles meet on the border.
    bool isFinerCorner(TilePoint p) const {
        return p.x() + p.y() == side_ / 2 || p.x() + p.y() == side_ + side_ / 2;
    }

    const TileShape& shape_;
    std::vector<std::uint16_t>& slots_;
    Source& source_;
    std::int32_t side_;  ///< in half spacings
    bool isCut_ = false;
    int edge_ = 0;  ///< the border that the quarter being walked lies on
};

}  // namespace eyrie::terrain
