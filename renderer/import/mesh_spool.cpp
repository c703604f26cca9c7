// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/mesh_spool.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include <absl/status/status.h>
#include <fmt/format.h>
#include <oneapi/tbb/parallel_sort.h>

#include "renderer/import/mesh_reader.h"
#include "renderer/import/pack_mesh.h"
#include "renderer/import/ply_reader.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::import {
namespace {

/// Reports one file's progress as a share of that of all, which are read one by one.
ImportControl shareOf(const ImportControl& control, std::size_t file, std::size_t count) {
    return {[&control, file, count](std::string_view stage, double fraction) {
                control.report(stage,
                               (static_cast<double>(file) + fraction) / static_cast<double>(count));
            },
            control.stop};
}

absl::StatusOr<MeshSpool> emptySpool(const std::string& outPath) {
    ASSIGN_OR_RETURN(auto positions, RowFile<fabric::Vec3>::create(outPath));
    ASSIGN_OR_RETURN(auto normals, RowFile<glm::vec3>::create(outPath));
    ASSIGN_OR_RETURN(auto colours, RowFile<fabric::Rgba>::create(outPath));
    ASSIGN_OR_RETURN(auto source, RowFile<mesh::Triangle>::create(outPath));
    ASSIGN_OR_RETURN(auto triangles, RowFile<SpooledTriangle>::create(outPath));
    return MeshSpool{.positions = std::move(positions),
                     .normals = std::move(normals),
                     .colours = std::move(colours),
                     .source = std::move(source),
                     .notes = {},
                     .isUsed = {},
                     .lattice = {},
                     .triangles = std::move(triangles)};
}

/// Adds a piece of a file whose vertices begin with `first`.
absl::Status addPiece(MeshSpool& spool, std::uint64_t first, TriangleMesh& piece) {
    RETURN_IF_ERROR(spool.positions.write(spool.vertexCount, piece.positions));
    RETURN_IF_ERROR(spool.normals.write(spool.vertexCount, piece.normals));
    for (fabric::Rgba& colour : piece.colours) colour = againstPlain(colour);
    RETURN_IF_ERROR(spool.colours.write(spool.vertexCount, piece.colours));
    spool.hasNormals = spool.hasNormals || !piece.normals.empty();
    spool.hasColours = spool.hasColours || !piece.colours.empty();
    spool.vertexCount += piece.positions.size();
    for (mesh::Triangle& triangle : piece.triangles)
        for (std::uint32_t& corner : triangle) corner += static_cast<std::uint32_t>(first);
    RETURN_IF_ERROR(spool.source.write(spool.sourceTriangles, piece.triangles));
    spool.sourceTriangles += piece.triangles.size();
    return absl::OkStatus();
}

/// Those that draw nothing wherever they lie, and so must not reach where nothing else does. Rows
/// move forward only, behind those that are read.
absl::Status removeCollapsed(MeshSpool& spool, const ImportControl& control) {
    RowCache<fabric::Vec3> positions(spool.positions);
    spool.isUsed.assign(spool.vertexCount, false);
    const std::uint64_t total = std::exchange(spool.sourceTriangles, 0);
    std::vector<mesh::Triangle> rows;
    return spool.source.forBlocks(
        0, total, [&](std::span<const mesh::Triangle> block) -> absl::Status {
            RETURN_IF_ERROR(control.check());
            control.report(
                "welding",
                0.4 * static_cast<double>(spool.sourceTriangles + spool.collapsedTriangles) /
                    static_cast<double>(total));
            rows.clear();
            for (const mesh::Triangle& triangle : block) {
                std::array<fabric::Vec3, 3> at;
                for (std::size_t i = 0; i < 3; ++i) {
                    ASSIGN_OR_RETURN(const fabric::Vec3* const corner, positions.at(triangle[i]));
                    at[i] = *corner;
                }
                if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0])
                    continue;
                rows.push_back(triangle);
                for (const std::uint32_t corner : triangle) spool.isUsed[corner] = true;
            }
            spool.collapsedTriangles += block.size() - rows.size();
            return spool.source.write(
                std::exchange(spool.sourceTriangles, spool.sourceTriangles + rows.size()), rows);
        });
}

absl::StatusOr<mesh::Lattice> latticeOf(const MeshSpool& spool, int bits) {
    fabric::Box bounds;
    std::uint64_t vertex = 0;
    RETURN_IF_ERROR(
        spool.positions.forBlocks(0, spool.vertexCount, [&](std::span<const fabric::Vec3> block) {
            for (const fabric::Vec3& position : block)
                if (spool.isUsed[vertex++])
                    bounds.grow(position);
            return absl::OkStatus();
        }));
    return mesh::fitLattice(bounds, bits);
}

/// Exact: differences of 21-bit numbers, products of 22-bit ones.
bool hasArea(const std::array<std::uint64_t, 3>& positions) {
    const glm::i64vec3 a(mesh::unpackPosition(positions[0]));
    const glm::i64vec3 ab = glm::i64vec3(mesh::unpackPosition(positions[1])) - a;
    const glm::i64vec3 ac = glm::i64vec3(mesh::unpackPosition(positions[2])) - a;
    return ab.y * ac.z != ab.z * ac.y || ab.z * ac.x != ab.x * ac.z || ab.x * ac.y != ab.y * ac.x;
}

/// Writes those with an area; isUsed then is that of these.
absl::Status writeTriangles(MeshSpool& spool, PackCounts& counts, const ImportControl& control) {
    RowCache<fabric::Vec3> positions(spool.positions);
    std::fill(spool.isUsed.begin(), spool.isUsed.end(), false);
    std::vector<SpooledTriangle> rows;
    std::uint32_t number = 0;
    return spool.source.forBlocks(
        0, spool.sourceTriangles, [&](std::span<const mesh::Triangle> block) -> absl::Status {
            RETURN_IF_ERROR(control.check());
            control.report("welding",
                           0.4 + 0.4 * number / static_cast<double>(spool.sourceTriangles));
            rows.clear();
            for (const mesh::Triangle& triangle : block) {
                SpooledTriangle row{{}, triangle, number++};
                std::array<fabric::Vec3, 3> corners;
                for (std::size_t i = 0; i < 3; ++i) {
                    ASSIGN_OR_RETURN(const fabric::Vec3* const at, positions.at(triangle[i]));
                    corners[i] = *at;
                    row.positions[i] = mesh::packPosition(spool.lattice.nearest(*at));
                }
                if (!hasArea(row.positions)) {
                    counts.emptyTriangles += isEmpty(corners) ? 1 : 0;
                    continue;
                }
                rows.push_back(row);
                for (const std::uint32_t corner : triangle) spool.isUsed[corner] = true;
            }
            const std::uint64_t first =
                std::exchange(spool.triangleCount, spool.triangleCount + rows.size());
            return spool.triangles.write(first, rows);
        });
}

using Corners = std::array<std::uint64_t, 3>;

/// The least corner first.
Corners turned(Corners corners) {
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    return corners;
}

std::uint64_t hashOf(const SpooledTriangle& triangle) {
    std::uint64_t hash = 0;
    for (const std::uint64_t corner : turned(triangle.positions)) {
        hash = (hash ^ corner) * 0x9E3779B97F4A7C15ULL;
        hash ^= hash >> 29;
    }
    return hash;
}

/// The numbers of those that are equal to one before them.
std::vector<std::uint32_t> duplicatesAmong(std::span<const SpooledTriangle> triangles) {
    struct Entry {
        std::uint64_t hash;
        std::uint32_t index;
    };
    std::vector<Entry> entries;
    entries.reserve(triangles.size());
    for (const SpooledTriangle& triangle : triangles)
        entries.push_back({hashOf(triangle), static_cast<std::uint32_t>(entries.size())});
    const auto cornersOf = [&](const Entry& entry) {
        return turned(triangles[entry.index].positions);
    };
    oneapi::tbb::parallel_sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) {
        if (a.hash != b.hash)
            return a.hash < b.hash;
        const Corners first = cornersOf(a);
        const Corners second = cornersOf(b);
        return first != second ? first < second : a.index < b.index;
    });
    std::vector<std::uint32_t> found;
    for (std::size_t i = 1; i < entries.size(); ++i)
        if (entries[i].hash == entries[i - 1].hash &&
            cornersOf(entries[i]) == cornersOf(entries[i - 1]))
            found.push_back(triangles[entries[i].index].number);
    return found;
}

/// Closes the gaps that `numbers` leave. Rows move forward only, behind those that are read.
absl::Status removeTriangles(MeshSpool& spool, const std::vector<bool>& isGone) {
    std::fill(spool.isUsed.begin(), spool.isUsed.end(), false);
    std::uint64_t kept = 0;
    std::vector<SpooledTriangle> rows;
    RETURN_IF_ERROR(spool.triangles.forBlocks(
        0, spool.triangleCount, [&](std::span<const SpooledTriangle> block) {
            rows.clear();
            for (const SpooledTriangle& row : block) {
                if (isGone[row.number])
                    continue;
                rows.push_back(row);
                for (const std::uint32_t corner : row.vertices) spool.isUsed[corner] = true;
            }
            return spool.triangles.write(std::exchange(kept, kept + rows.size()), rows);
        }));
    spool.triangleCount = kept;
    return absl::OkStatus();
}

/// Equal triangles have equal hashes: they come into one group.
absl::Status dropDuplicates(MeshSpool& spool, std::uint64_t atOnce, const std::string& outPath,
                            PackCounts& counts, const ImportControl& control) {
    const std::size_t groups = static_cast<std::size_t>(2 * spool.triangleCount / atOnce) + 1;
    ASSIGN_OR_RETURN(
        const auto grouped,
        groupRows(
            spool.triangles, spool.triangleCount, groups,
            [groups](const SpooledTriangle& row) { return hashOf(row) % groups; }, outPath));
    std::vector<bool> isGone(spool.sourceTriangles, false);
    for (std::size_t group = 0; group < groups; ++group) {
        RETURN_IF_ERROR(control.check());
        ASSIGN_OR_RETURN(const std::vector<SpooledTriangle> rows, grouped.read(group));
        for (const std::uint32_t number : duplicatesAmong(rows)) {
            isGone[number] = true;
            ++counts.duplicateTriangles;
        }
    }
    return counts.duplicateTriangles == 0 ? absl::OkStatus() : removeTriangles(spool, isGone);
}

}  // namespace

fabric::Rgba againstPlain(fabric::Rgba colour) {
    return std::bit_cast<fabric::Rgba>(std::bit_cast<std::uint32_t>(colour) ^
                                       std::bit_cast<std::uint32_t>(kPlainColour));
}

absl::StatusOr<MeshSpool> spoolMeshes(std::span<const std::string> paths,
                                      const std::string& outPath, const ImportControl& control) {
    ASSIGN_OR_RETURN(MeshSpool spool, emptySpool(outPath));
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const std::uint64_t first = spool.vertexCount;
        ASSIGN_OR_RETURN(const PlySize size, measurePly(paths[i]));
        if (first + size.vertices >= std::numeric_limits<std::uint32_t>::max())
            return absl::InvalidArgumentError(fmt::format(
                "{}: with it the mesh has more than 2^32 vertices; import the files in parts",
                paths[i]));
        std::uint64_t dropped = 0;
        std::vector<std::string> notes;
        const auto take = [&](TriangleMesh& piece) {
            dropped = piece.droppedFaces;
            notes = piece.notes;
            return addPiece(spool, first, piece);
        };
        RETURN_IF_ERROR(readPlyPieces(paths[i], take, shareOf(control, i, paths.size())));
        spool.droppedFaces += dropped;
        for (const std::string& note : notes)
            spool.notes.push_back(paths.size() == 1 ? note : fmt::format("{}: {}", paths[i], note));
        if (spool.sourceTriangles > mesh::kMaxTriangles)
            return absl::ResourceExhaustedError(fmt::format(
                "{}: with it the mesh has {} triangles; at most {} fit one .eym file; split the "
                "mesh",
                paths[i], spool.sourceTriangles, mesh::kMaxTriangles));
    }
    return spool;
}

absl::Status placeOnLattice(MeshSpool& spool, int latticeBits, std::uint64_t atOnce,
                            const std::string& outPath, PackCounts& counts,
                            const ImportControl& control) {
    control.report("welding", 0);
    RETURN_IF_ERROR(removeCollapsed(spool, control));
    if (spool.sourceTriangles == 0)
        return nothingHasArea(spool.collapsedTriangles);
    ASSIGN_OR_RETURN(spool.lattice, latticeOf(spool, latticeBits));
    counts.emptyTriangles = spool.collapsedTriangles;
    RETURN_IF_ERROR(writeTriangles(spool, counts, control));
    counts.degenerateTriangles =
        spool.collapsedTriangles + spool.sourceTriangles - spool.triangleCount;
    counts.isolatedVertices =
        static_cast<std::uint64_t>(std::count(spool.isUsed.begin(), spool.isUsed.end(), false));
    if (spool.triangleCount == 0)
        return nothingHasArea(
            counts.degenerateTriangles,
            counts.emptyTriangles == counts.degenerateTriangles ? 0 : spool.lattice.stepMetres);
    ASSIGN_OR_RETURN(spool.source, RowFile<mesh::Triangle>::create(outPath));  // done with
    RETURN_IF_ERROR(dropDuplicates(spool, atOnce, outPath, counts, control));
    control.report("welding", 1);
    return absl::OkStatus();
}

}  // namespace eyrie::import
