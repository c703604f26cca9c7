// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace eyrie::mesh {

/// An edge of a triangle that no other triangle has met yet, in the direction in which a neighbour
/// that is wound alike goes along it.
struct OpenEdge {
    std::uint16_t from = 0;
    std::uint16_t to = 0;
    std::uint16_t opposite = 0;  ///< the third corner of the triangle it is of
};

/// What the third corner of a triangle that meets an edge is: new, or the far end of the open edge
/// next to that one, going from its end or to its beginning, or none of these.
enum class ThirdCorner : std::uint8_t { IsNew, ClosesNext, ClosesLast, IsElsewhere };

/// The edges that were left open last, known by age: 0 is the youngest. Whoever walks over the
/// same triangles in the same order has the same edges.
class OpenEdges {
public:
    static constexpr std::uint32_t kReach = 84;      ///< ages that can be named
    static constexpr std::uint32_t kNone = kReach;   ///< as an age
    static constexpr std::uint32_t kNearReach = 32;  ///< ages looked at by youngestFrom and To

    std::uint32_t count() const {
        return static_cast<std::uint32_t>(size_ < kReach ? size_ : kReach);
    }
    /// Precondition: age < count().
    const OpenEdge& at(std::uint32_t age) const { return edges_[size_ - 1 - age]; }

    /// Youngest edge that one of a triangle's goes along, or kNone; `turn` is the corner it goes
    /// from.
    std::uint32_t find(std::span<const std::uint16_t, 3> corners, std::uint32_t& turn) const {
        const std::array sides{sideOf(corners[0], corners[1]), sideOf(corners[1], corners[2]),
                               sideOf(corners[2], corners[0])};
        for (std::uint32_t age = 0; age < count(); ++age) {
            const std::uint32_t side = sideOf(at(age).from, at(age).to);
            if (side != sides[0] && side != sides[1] && side != sides[2])
                continue;
            turn = side == sides[0] ? 0 : side == sides[1] ? 1 : 2;
            return age;
        }
        turn = 0;
        return kNone;
    }

    /// Youngest that goes from `vertex`, but not to `notTo`; kNone where there is none.
    std::uint32_t youngestFrom(std::uint16_t vertex, std::uint16_t notTo) const {
        for (std::uint32_t age = 0; age < near(); ++age)
            if (at(age).from == vertex && at(age).to != notTo)
                return age;
        return kNone;
    }
    /// Youngest that goes to `vertex`, but not from `notFrom`.
    std::uint32_t youngestTo(std::uint16_t vertex, std::uint16_t notFrom) const {
        for (std::uint32_t age = 0; age < near(); ++age)
            if (at(age).to == vertex && at(age).from != notFrom)
                return age;
        return kNone;
    }

    /// Precondition: age < count().
    void close(std::uint32_t age) {
        OpenEdge* const edge = &edges_[size_ - 1 - age];
        std::memmove(edge, edge + 1, age * sizeof(OpenEdge));
        --size_;
    }
    void open(const OpenEdge& edge) {
        if (size_ == edges_.size()) {  // the old ones are out of reach
            std::memcpy(edges_.data(), &edges_[size_ - kReach], kReach * sizeof(OpenEdge));
            size_ = kReach;
        }
        edges_[size_++] = edge;
    }
    /// The other sides of a triangle that has met `edge`, but for those that have met one, too.
    void openSides(const OpenEdge& edge, std::uint16_t corner, ThirdCorner third) {
        if (third != ThirdCorner::ClosesLast)
            open({edge.from, corner, edge.to});
        if (third != ThirdCorner::ClosesNext)
            open({corner, edge.to, edge.from});
    }
    /// Takes in the triangle that has met `edge`, which was closed. `isNew`: no triangle before
    /// has had the corner.
    ThirdCorner join(const OpenEdge& edge, std::uint16_t corner, bool isNew) {
        ThirdCorner third = isNew ? ThirdCorner::IsNew : ThirdCorner::IsElsewhere;
        if (const std::uint32_t next = youngestFrom(edge.to, edge.from);
            !isNew && next != kNone && at(next).to == corner) {
            third = ThirdCorner::ClosesNext;
            close(next);
        } else if (const std::uint32_t last = youngestTo(edge.from, edge.to);
                   !isNew && last != kNone && at(last).from == corner) {
            third = ThirdCorner::ClosesLast;
            close(last);
        }
        openSides(edge, corner, third);
        return third;
    }
    /// All three of a triangle that meets none.
    void openAll(std::span<const std::uint16_t, 3> corners) {
        open({corners[1], corners[0], corners[2]});
        open({corners[2], corners[1], corners[0]});
        open({corners[0], corners[2], corners[1]});
    }

private:
    static std::uint32_t sideOf(std::uint16_t from, std::uint16_t to) {
        return std::bit_cast<std::uint32_t>(std::array{from, to});
    }
    std::uint32_t near() const { return count() < kNearReach ? count() : kNearReach; }

    std::array<OpenEdge, 1024> edges_;
    std::size_t size_ = 0;
};

}  // namespace eyrie::mesh
