// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "renderer/mesh/packed_mesh.h"

/// How often triangles are wound around the points before them, counted along z in the columns of a
/// grid: what back_faces.h stands on, a part of the grid at a time.
namespace eyrie::mesh {

/// A mesh's triangles, and its lids after them.
struct Surface {
    std::span<const std::uint64_t> positions;  ///< packed
    std::span<const Triangle> triangles;
};

/// Of a triangle, on the lattice.
using Corners = std::array<glm::ivec3, 3>;
Corners cornersOf(const std::array<std::uint64_t, 3>& positions);

/// Columns of a grid across z that have few triangles each, were they spread evenly.
struct ColumnGrid {
    /// Of as many triangles between these two corners.
    ColumnGrid(const glm::ivec3& least, const glm::ivec3& most, std::uint64_t triangles);

    /// The columns over which a triangle stands.
    struct Reach {
        std::uint32_t firstX, lastX, firstY, lastY;

        std::uint64_t columns() const {
            return std::uint64_t{lastX - firstX + 1} * (lastY - firstY + 1);
        }
    };
    /// Nothing where it lies along z.
    std::optional<Reach> reachOf(const Corners& corners) const;

    /// Whether it would take too long, with so many triangles in all columns, each counted, and so
    /// many to be compared.
    bool isTooMuch(std::uint64_t entries, double comparisons) const;

    glm::ivec3 low;
    std::uint32_t side = 1;  ///< of a column, in steps
    std::uint32_t columnsX = 1;
    std::uint32_t rows = 1;
    std::uint64_t triangleCount;
};

/// From `begin` to before `end`.
struct RowRange {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
};

/// The triangles, ascending, whose middle is in the columns of `rows` and which somebody outside
/// may see from behind (back_faces.h). Adds to `comparisons` what had to be compared; nothing where
/// that is too much. Precondition: the mesh has all triangles over these columns.
std::optional<std::vector<std::uint32_t>> seenFromBehind(const Surface& mesh,
                                                         const ColumnGrid& grid,
                                                         const RowRange& rows, double& comparisons);

}  // namespace eyrie::mesh
