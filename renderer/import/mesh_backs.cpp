// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/mesh_backs.h"

#include <algorithm>
#include <utility>

#include <glm/common.hpp>

#include "renderer/mesh/back_columns.h"
#include "renderer/mesh/lids.h"

namespace eyrie::import {
namespace {

/// Calls `visit` for each triangle.
template <typename Visit>
absl::Status forAll(const MeshSpool& spool, const ImportControl& control, const Visit& visit) {
    return spool.triangles.forBlocks(0, spool.triangleCount,
                                     [&](std::span<const SpooledTriangle> block) -> absl::Status {
                                         for (const SpooledTriangle& row : block)
                                             RETURN_IF_ERROR(visit(row));
                                         return control.check();
                                     });
}

/// The grid of a mesh that is closed.
absl::StatusOr<std::optional<mesh::ColumnGrid>> gridOf(const MeshSpool& spool,
                                                       const ImportControl& control) {
    std::uint64_t edges = 0;
    glm::ivec3 least(static_cast<int>(mesh::kMaxLatticeCoordinate));
    glm::ivec3 most(0);
    RETURN_IF_ERROR(forAll(spool, control, [&](const SpooledTriangle& row) {
        edges += mesh::edgeSum(row.positions);
        for (const glm::ivec3& corner : mesh::cornersOf(row.positions)) {
            least = glm::min(least, corner);
            most = glm::max(most, corner);
        }
        return absl::OkStatus();
    }));
    if (edges != 0)
        return std::nullopt;
    return mesh::ColumnGrid(least, most, spool.triangleCount);
}

/// A row of the grid is in one strip: those that memory holds at once. Empty where there are none
/// such.
using Strips = std::vector<mesh::RowRange>;

/// `entries`: of each row, the triangles in its columns.
Strips stripsOf(const mesh::ColumnGrid& grid, const std::vector<std::int64_t>& entries,
                std::uint64_t atOnce) {
    Strips strips;
    std::uint64_t held = 0;
    for (std::uint32_t row = 0; row < grid.rows; ++row) {
        const std::uint64_t own = static_cast<std::uint64_t>(entries[row]) + grid.columnsX;
        if (own > atOnce)
            return {};
        if (strips.empty() || held + own > atOnce) {
            strips.push_back({row, row});
            held = 0;
        }
        held += own;
        strips.back().end = row + 1;
    }
    return strips;
}

absl::StatusOr<Strips> makeStrips(const MeshSpool& spool, const mesh::ColumnGrid& grid,
                                  std::uint64_t atOnce, const ImportControl& control) {
    std::vector<std::int64_t> entries(grid.rows + 1, 0);  // at first: more than in the row before
    std::uint64_t total = 0;
    RETURN_IF_ERROR(forAll(spool, control, [&](const SpooledTriangle& row) {
        if (const auto reach = grid.reachOf(mesh::cornersOf(row.positions))) {
            entries[reach->firstY] += reach->lastX - reach->firstX + 1;
            entries[reach->lastY + 1] -= reach->lastX - reach->firstX + 1;
            total += reach->columns();
        }
        return absl::OkStatus();
    }));
    if (grid.isTooMuch(total, 0))
        return Strips();
    for (std::uint32_t row = 1; row < grid.rows; ++row) entries[row] += entries[row - 1];
    return stripsOf(grid, entries, atOnce);
}

/// Calls `visit(strip, triangle)` for each strip that a triangle reaches.
template <typename Visit>
absl::Status forStrips(const MeshSpool& spool, const mesh::ColumnGrid& grid, const Strips& strips,
                       const ImportControl& control, const Visit& visit) {
    std::vector<std::size_t> stripOf(grid.rows);
    for (std::size_t i = 0; i < strips.size(); ++i)
        std::fill(stripOf.begin() + strips[i].begin, stripOf.begin() + strips[i].end, i);
    return forAll(spool, control, [&](const SpooledTriangle& row) {
        const auto reach = grid.reachOf(mesh::cornersOf(row.positions));
        for (std::size_t i = reach ? stripOf[reach->firstY] : 1;
             i <= (reach ? stripOf[reach->lastY] : 0); ++i)
            RETURN_IF_ERROR(visit(i, row));
        return absl::OkStatus();
    });
}

absl::StatusOr<GroupedRows<SpooledTriangle>> byStrip(const MeshSpool& spool,
                                                     const mesh::ColumnGrid& grid,
                                                     const Strips& strips,
                                                     const std::string& outPath,
                                                     const ImportControl& control) {
    ASSIGN_OR_RETURN(auto file, RowFile<SpooledTriangle>::create(outPath));
    GroupedRows<SpooledTriangle> grouped{std::move(file),
                                         std::vector<std::uint64_t>(strips.size() + 1, 0)};
    const auto count = [&](std::size_t strip, const SpooledTriangle&) {
        ++grouped.begins[strip + 1];
        return absl::OkStatus();
    };
    RETURN_IF_ERROR(forStrips(spool, grid, strips, control, count));
    for (std::size_t i = 1; i <= strips.size(); ++i) grouped.begins[i] += grouped.begins[i - 1];
    RowGroups<SpooledTriangle> out(grouped.file, std::span(grouped.begins).first(strips.size()));
    const auto add = [&](std::size_t strip, const SpooledTriangle& row) {
        return out.add(strip, row);
    };
    RETURN_IF_ERROR(forStrips(spool, grid, strips, control, add));
    RETURN_IF_ERROR(out.finish());
    return grouped;
}

/// Each with vertices of its own.
mesh::PackedMesh meshOf(const std::vector<SpooledTriangle>& rows) {
    mesh::PackedMesh mesh;
    mesh.positions.reserve(3 * rows.size());
    mesh.triangles.reserve(rows.size());
    for (const SpooledTriangle& row : rows) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), row.positions.begin(), row.positions.end());
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

}  // namespace

absl::StatusOr<std::optional<std::vector<bool>>> findBacks(const MeshSpool& spool,
                                                           std::uint64_t atOnce,
                                                           const std::string& outPath,
                                                           const ImportControl& control) {
    control.report("backs", 0);
    ASSIGN_OR_RETURN(const std::optional<mesh::ColumnGrid> grid, gridOf(spool, control));
    if (!grid)
        return std::nullopt;
    ASSIGN_OR_RETURN(const Strips strips, makeStrips(spool, *grid, atOnce, control));
    if (strips.empty())
        return std::nullopt;
    ASSIGN_OR_RETURN(const auto grouped, byStrip(spool, *grid, strips, outPath, control));
    std::vector<bool> isBehind(spool.sourceTriangles, false);
    double comparisons = 0;
    for (std::size_t strip = 0; strip < strips.size(); ++strip) {
        RETURN_IF_ERROR(control.check());
        ASSIGN_OR_RETURN(const std::vector<SpooledTriangle> rows, grouped.read(strip));
        const mesh::PackedMesh part = meshOf(rows);
        const auto found = mesh::seenFromBehind({part.positions, part.triangles}, *grid,
                                                strips[strip], comparisons);
        if (!found)
            return std::nullopt;
        for (const std::uint32_t i : *found) isBehind[rows[i].number] = true;
        control.report("backs",
                       static_cast<double>(strip + 1) / static_cast<double>(strips.size()));
    }
    return isBehind;
}

}  // namespace eyrie::import
