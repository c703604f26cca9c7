// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

namespace eyrie::mesh {

/// Triangles around a vertex that may have any.
inline constexpr std::size_t kMaxStar = 24;

/// The triangles around an inner vertex of a surface, and what becomes of them when the vertex is
/// moved onto one of its neighbours.
///
/// Laid flat, what is around the vertex before and after covers the same polygon: a point of the
/// one surface has its partner where the other has the same place. Seen along their mean normal the
/// triangles lie flat if all of them face the viewer: partners are then right above or below each
/// other. If not, they are turned about the vertex into a plane, their angles scaled to go around
/// once. Either way the shift from a point to its partner is linear in the pieces that old and new
/// edges cut the polygon into, so it is extreme at the vertex, or where an old and a new edge
/// cross.
///
/// Triangle i lies between the centre and ring[i], ring[i + 1]; after the move onto ring[t] all but
/// t - 1 and t are left, between ring[t] and the same two.
/// J. Cohen, D. Manocha, M. Olano, "Simplifying Polygonal Models Using Successive Mappings", 1997;
/// the second way to lay it flat: W. Welch, A. Witkin, "Free-Form Shape Design Using Triangulated
/// Surfaces", 1994.
class Star {
public:
    /// `ring`: the vertex's neighbours in turn, counter-clockwise seen from outside; 3 to kMaxStar.
    Star(const glm::dvec3& centre, std::span<const glm::dvec3> ring);

    /// Whether it lies flat, one way or the other.
    bool isFlat() const { return isFlat_; }
    /// Whether it does seen along normal().
    bool isGraph() const { return isGraph_; }
    const glm::dvec3& normal() const { return normal_; }

    /// Of points to their partners after a move. Of a graph: along normal(), between the two;
    /// otherwise any way no longer than `most`.
    struct Shift {
        double least = 0;
        double most = 0;
    };
    struct Landing {
        Shift shift;           ///< of the centre
        std::size_t triangle;  ///< in which its partner is, counted from the target
    };
    /// Nothing when what the move onto ring[target] makes does not lie flat. Precondition:
    /// isFlat().
    std::optional<Landing> landing(std::size_t target) const;

    /// What a triangle that is left replaces.
    struct Replaced {
        Shift shift;              ///< of its points' partners to them
        std::uint32_t triangles;  ///< those of before that hold partners: a bit each; 0: it is gone
    };
    using Outcome = std::array<Replaced, kMaxStar>;  ///< by triangle; as many as there are count

    /// The centre goes to ring[target]. `landing`: that of the same target.
    void moveTo(std::size_t target, const Landing& landing, Outcome& outcome) const;

    /// Of the target, ring[b] and ring[b + 1] in the place where the centre lands; times anything.
    struct Shares {
        double ofTarget;
        double ofB;
        double ofC;
        std::size_t b;
    };
    Shares sharesAtCentre(std::size_t target, std::size_t triangle) const;

    /// Where an old edge, from the centre, and a new one, from the target, cross.
    struct Crossing {
        double alongSpoke;
        double alongDiagonal;
    };
    /// Visits the crossings of the new edge to the `diagonal`-th after the target with old ones,
    /// each with that of its spoke.
    template <typename Visit>
    void forCrossings(std::size_t target, std::size_t diagonal, const Visit& visit) const;

    /// Of a triangle that is left.
    double longestSide(std::size_t triangle, std::size_t target) const;

    /// In the ring, counted from the target.
    std::size_t at(std::size_t target, std::size_t offset) const {
        const std::size_t index = target + offset;
        return index < count_ ? index : index - count_;
    }

private:
    struct Point {
        double x;
        double y;
        double height;
    };

    std::size_t after(std::size_t i) const { return i + 1 < count_ ? i + 1 : 0; }
    double wedge(std::size_t i, std::size_t j) const { return wedges_[i][j]; }
    double area(std::size_t i, std::size_t j, std::size_t k) const;
    bool project();
    bool unfold();
    bool liesFlat();
    bool goesAroundOnce() const;
    bool isOnLeft(std::size_t target, std::size_t diagonal) const {
        return wedge(target, at(target, diagonal)) > 0;
    }
    std::optional<Crossing> crossing(std::size_t target, std::size_t diagonal,
                                     std::size_t spoke) const;
    Shift shiftBy(double height) const;
    Shift shiftAtCentre(std::size_t target, std::size_t triangle) const;
    Shift shiftAtCrossing(std::size_t target, std::size_t diagonal, std::size_t spoke,
                          const Crossing& crossing) const;
    void addDiagonal(std::size_t target, std::size_t diagonal, Outcome& outcome) const;

    std::array<glm::dvec3, kMaxStar> spokes_;  ///< from the centre to the ring
    std::array<Point, kMaxStar> ring_;         ///< laid flat, the centre at the origin
    /// Twice the signed area of the triangle from the centre to two points of the ring.
    std::array<std::array<double, kMaxStar>, kMaxStar> wedges_;
    std::size_t count_;
    glm::dvec3 normal_{0.0};
    double least_;  ///< twice the area below which a triangle does not count as lying flat
    bool isGraph_ = false;
    bool isFlat_ = false;
};

template <typename Visit>
void Star::forCrossings(std::size_t target, std::size_t diagonal, const Visit& visit) const {
    // The old edge to the same point lies on the centre's side; nor does the new one cross any on
    // the other side.
    const bool isLeft = isOnLeft(target, diagonal);
    const std::size_t end = isLeft ? diagonal : count_;
    for (std::size_t spoke = isLeft ? 1 : diagonal + 1; spoke < end; ++spoke)
        if (const auto found = crossing(target, at(target, diagonal), at(target, spoke)))
            visit(spoke, *found);
}

}  // namespace eyrie::mesh
