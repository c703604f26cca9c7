// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

namespace eyrie::mesh {

/// A vertex of a piece of a mesh.
struct PiecePoint {
    glm::dvec3 position;
    std::uint32_t piece;
    std::uint32_t triangle;  ///< one that it is a corner of
};

/// Points of pieces, of which the nearest is looked for while pieces go: a kd-tree by the median of
/// the longest axis, in place (Bentley 1975), that counts what is left below each of its nodes. So
/// it is quick however unevenly points lie.
class PiecePoints {
public:
    explicit PiecePoints(std::vector<PiecePoint> points);

    /// The point nearest to `at` of a piece that is there and not `own`, of equally near ones the
    /// first of those given; null where none is within `reach`.
    const PiecePoint* nearest(const glm::dvec3& at, std::uint32_t own, double reach) const;
    void remove(std::uint32_t piece);

private:
    struct Node {
        std::uint32_t point = 0;  ///< the middle one of those below
        std::uint32_t left = 0;   ///< how many below are there, this one included
        std::uint8_t axis = 0;
        bool isThere = true;
    };
    /// What a search has found so far.
    struct Found {
        glm::dvec3 at;
        std::uint32_t own;
        double square;  ///< of the distance
        std::uint32_t point;
    };

    void build(std::size_t begin, std::size_t end);
    void search(std::size_t begin, std::size_t end, Found& found) const;

    std::vector<PiecePoint> points_;
    std::vector<Node> nodes_;  ///< that of points [begin, end) is in the middle
    std::vector<std::pair<std::uint32_t, std::uint32_t>> byPiece_;  ///< piece, node; sorted
};

}  // namespace eyrie::mesh
