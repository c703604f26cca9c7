// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

namespace eyrie::mesh {

/// Triangles around a vertex that may have any.
inline constexpr std::size_t kMaxStar = 24;

/// The triangles around an inner vertex of a surface, seen along their mean normal, and what
/// becomes of them when the vertex is moved onto one of its neighbours.
///
/// If all of them, before and after, face the viewer, both surfaces are graphs over the same
/// polygon: each point of the one has its partner right above or below it on the other. The
/// distance of partners is piecewise linear, so in a triangle it is largest at the vertex, or where
/// an old and a new edge cross.
///
/// Triangle i lies between the centre and ring[i], ring[i + 1]; after the move onto ring[t] all but
/// t - 1 and t are left, between ring[t] and the same two.
/// J. Cohen, D. Manocha, M. Olano, "Simplifying Polygonal Models Using Successive Mappings", 1997.
class Star {
public:
    /// `ring`: the vertex's neighbours in turn, counter-clockwise seen from outside; 3 to kMaxStar.
    Star(const glm::dvec3& centre, std::span<const glm::dvec3> ring);

    /// Whether it is a graph.
    bool isGraph() const { return isGraph_; }

    /// What a triangle that is left replaces.
    struct Replaced {
        double distance;          ///< the largest of its points to their partners
        std::uint32_t triangles;  ///< those of before that hold partners: a bit each; 0: it is gone
    };
    using Outcome = std::array<Replaced, kMaxStar>;  ///< by triangle; as many as there are count

    /// The centre goes to ring[target]: fills `outcome`. False when what becomes of the star is no
    /// graph, or the centre is farther than `limit` from its partner. Precondition: isGraph().
    bool movedTo(std::size_t target, double limit, Outcome& outcome) const;

private:
    struct Point {
        double x;
        double y;
        double height;
    };

    double wedge(std::size_t i, std::size_t j) const { return wedges_[i][j]; }
    double area(std::size_t i, std::size_t j, std::size_t k) const;
    void measureWedges();
    bool goesAroundOnce() const;
    std::size_t at(std::size_t target, std::size_t offset) const;
    double heightAtCentre(std::size_t target, std::size_t triangle) const;
    double heightAtCrossing(std::size_t target, std::size_t diagonal, std::size_t spoke) const;
    void addDiagonal(std::size_t target, std::size_t diagonal, Outcome& outcome) const;

    std::array<Point, kMaxStar> ring_;
    /// Twice the signed area of the triangle from the centre to two points of the ring.
    std::array<std::array<double, kMaxStar>, kMaxStar> wedges_;
    std::size_t count_;
    double least_;  ///< twice the area below which a triangle does not count as facing the viewer
    bool isGraph_ = false;
};

}  // namespace eyrie::mesh
