// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/pack_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <absl/status/status.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "fabric/box.h"
#include "fabric/status.h"
#include "renderer/import/normals.h"
#include "renderer/import/weld.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::import {
namespace {

constexpr std::size_t kGrain = 16384;

std::vector<std::uint8_t> findUsed(const TriangleMesh& mesh) {
    std::vector<std::uint8_t> used(mesh.positions.size());
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) used[corner] = 1;
    return used;
}

/// Isolated vertices do not count: a stray point far away must not coarsen the lattice.
fabric::Box boundsOf(const TriangleMesh& mesh, const std::vector<std::uint8_t>& used) {
    fabric::Box bounds;
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i] != 0)
            bounds.grow(mesh.positions[i]);
    return bounds;
}

std::vector<VertexKey> latticeKeys(const TriangleMesh& mesh, const std::vector<std::uint8_t>& used,
                                   const mesh::Lattice& lattice) {
    std::vector<VertexKey> keys(used.size());
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<std::size_t>(0, used.size(), kGrain), [&](const auto& part) {
            for (std::size_t i = part.begin(); i != part.end(); ++i)
                if (used[i] != 0)
                    keys[i].position = mesh::packPosition(lattice.nearest(mesh.positions[i]));
        });
    return keys;
}

/// Exact: differences of 21-bit numbers, products of 22-bit ones.
bool hasArea(const std::vector<VertexKey>& keys, const mesh::Triangle& corners) {
    const glm::i64vec3 a(mesh::unpackPosition(keys[corners[0]].position));
    const glm::i64vec3 ab = glm::i64vec3(mesh::unpackPosition(keys[corners[1]].position)) - a;
    const glm::i64vec3 ac = glm::i64vec3(mesh::unpackPosition(keys[corners[2]].position)) - a;
    return ab.y * ac.z != ab.z * ac.y || ab.z * ac.x != ab.x * ac.z || ab.x * ac.y != ab.y * ac.x;
}

bool isUsable(const glm::vec3& normal) {
    const double length = glm::length(glm::dvec3(normal));
    return std::isfinite(length) && length > 0;
}

void renumber(std::vector<mesh::Triangle>& triangles, const std::vector<std::uint32_t>& vertexOf) {
    for (mesh::Triangle& triangle : triangles)
        for (std::uint32_t& corner : triangle) corner = vertexOf[corner];
}

std::vector<std::uint64_t> positionsOf(const Weld& welded, const std::vector<VertexKey>& keys) {
    std::vector<std::uint64_t> positions;
    positions.reserve(welded.vertexCount());
    for (const std::uint32_t key : welded.firstKey) positions.push_back(keys[key].position);
    return positions;
}

/// Packed normals of vertices that are equal in position: by position they are smooth across a
/// change of colour too.
std::vector<std::uint32_t> computeNormals(const std::vector<VertexKey>& keys,
                                          const Weld& byPosition,
                                          const std::vector<mesh::Triangle>& triangles) {
    std::vector<mesh::Triangle> renumbered = triangles;
    renumber(renumbered, byPosition.vertexOf);
    const std::vector<glm::vec3> normals = smoothNormals(positionsOf(byPosition, keys), renumbered);
    std::vector<std::uint32_t> packed(normals.size());
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, normals.size(), kGrain),
                              [&](const auto& part) {
                                  for (std::size_t i = part.begin(); i != part.end(); ++i)
                                      packed[i] = mesh::packNormal(normals[i]);
                              });
    return packed;
}

/// Fills the keys' normals: the source's where usable, computed ones elsewhere.
void fillNormals(const TriangleMesh& source, const Weld& byPosition, std::vector<VertexKey>& keys,
                 PackCounts& counts) {
    const auto needsOne = [&](std::size_t i) {
        return byPosition.vertexOf[i] != kNoVertex &&
               (source.normals.empty() || !isUsable(source.normals[i]));
    };
    std::vector<std::uint32_t> computed;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (byPosition.vertexOf[i] == kNoVertex)
            continue;
        if (!needsOne(i)) {
            keys[i].normal = mesh::packNormal(source.normals[i]);
            continue;
        }
        if (computed.empty())
            computed = computeNormals(keys, byPosition, source.triangles);
        keys[i].normal = computed[byPosition.vertexOf[i]];
        counts.normalsComputed = true;
    }
}

mesh::PackedMesh gather(const Weld& welded, const std::vector<VertexKey>& keys, bool hasColours,
                        const mesh::Lattice& lattice, std::vector<mesh::Triangle> triangles) {
    mesh::PackedMesh packed;
    packed.lattice = lattice;
    packed.positions = positionsOf(welded, keys);
    packed.normals.reserve(welded.vertexCount());
    for (const std::uint32_t key : welded.firstKey) {
        packed.normals.push_back(keys[key].normal);
        if (hasColours)
            packed.colours.push_back(keys[key].colour);
    }
    packed.triangles = std::move(triangles);
    renumber(packed.triangles, welded.vertexOf);
    return packed;
}

/// Equal positions, to the bit, have equal numbers.
void numberPositions(const std::vector<fabric::Vec3>& positions, std::vector<VertexKey>& keys) {
    using Bits = std::array<std::uint64_t, 3>;
    const auto bitsOf = [&](std::uint32_t i) {
        return std::bit_cast<Bits>(std::array{positions[i].x, positions[i].y, positions[i].z});
    };
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return bitsOf(a) < bitsOf(b); });
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i > 0 && bitsOf(order[i]) != bitsOf(order[i - 1]))
            ++number;
        keys[order[i]].exact = number;
    }
}

absl::Status dropDegenerate(TriangleMesh& source, const std::vector<VertexKey>& keys,
                            PackCounts& counts) {
    const auto total = source.triangles.size();
    std::erase_if(source.triangles,
                  [&keys](const mesh::Triangle& triangle) { return !hasArea(keys, triangle); });
    counts.degenerateTriangles = total - source.triangles.size();
    if (source.triangles.empty())
        return absl::InvalidArgumentError(
            fmt::format("faces: found {} triangles, none with any area, expected at least one; "
                        "export the mesh again with its faces",
                        total));
    return absl::OkStatus();
}

}  // namespace

absl::StatusOr<mesh::PackedMesh> packMesh(TriangleMesh source, PackCounts& counts,
                                          const ImportControl& control,
                                          const PackOptions& options) {
    counts = {};
    control.report("welding", 0);
    const std::vector<std::uint8_t> used = findUsed(source);
    ASSIGN_OR_RETURN(const mesh::Lattice lattice,
                     mesh::fitLattice(boundsOf(source, used), options.latticeBits));
    std::vector<VertexKey> keys = latticeKeys(source, used, lattice);
    RETURN_IF_ERROR(dropDegenerate(source, keys, counts));
    RETURN_IF_ERROR(control.check());
    Weld welded = weld(keys, source.triangles);
    counts.isolatedVertices = static_cast<std::uint64_t>(
        std::count(welded.vertexOf.begin(), welded.vertexOf.end(), kNoVertex));
    control.report("welding", 1);

    RETURN_IF_ERROR(control.check());
    control.report("normals", 0);
    fillNormals(source, welded, keys, counts);
    control.report("normals", 1);
    if (options.keepsExact)
        numberPositions(source.positions, keys);
    if (!source.normals.empty() || !source.colours.empty() || options.keepsExact) {
        for (std::size_t i = 0; i < source.colours.size(); ++i)
            keys[i].colour = mesh::packColour(source.colours[i]);
        welded = weld(keys, source.triangles);
    }
    counts.weldedVertices = keys.size() - counts.isolatedVertices - welded.vertexCount();
    mesh::PackedMesh packed =
        gather(welded, keys, !source.colours.empty(), lattice, std::move(source.triangles));
    if (options.keepsExact)
        for (const std::uint32_t key : welded.firstKey)
            packed.exact.push_back(source.positions[key]);
    return packed;
}

}  // namespace eyrie::import
