// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/pack_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <absl/status/status.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "fabric/box.h"
#include "fabric/status.h"
#include "renderer/import/duplicate_faces.h"
#include "renderer/import/normals.h"
#include "renderer/import/orient.h"
#include "renderer/import/texture_files.h"
#include "renderer/import/weld.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::import {
namespace {

constexpr std::size_t kGrain = 16384;

/// Which draws nothing wherever it lies, and so must not reach where nothing else does.
bool isCollapsed(const TriangleMesh& mesh, const mesh::Triangle& corners) {
    const fabric::Vec3& a = mesh.positions[corners[0]];
    const fabric::Vec3& b = mesh.positions[corners[1]];
    const fabric::Vec3& c = mesh.positions[corners[2]];
    return a == b || b == c || c == a;
}

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

/// The source's triangles between points: vertices that are equal in position.
std::vector<mesh::Triangle> surfaceOf(const TriangleMesh& source, const Weld& byPosition) {
    std::vector<mesh::Triangle> surface = source.triangles;
    renumber(surface, byPosition.vertexOf);
    return surface;
}

std::vector<std::uint32_t> packNormals(std::span<const glm::vec3> normals) {
    std::vector<std::uint32_t> packed(normals.size());
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, normals.size(), kGrain),
                              [&](const auto& part) {
                                  for (std::size_t i = part.begin(); i != part.end(); ++i)
                                      packed[i] = mesh::packNormal(normals[i]);
                              });
    return packed;
}

/// A vertex's material, and its texture coordinates as they are stored.
struct TexturePlace {
    std::uint16_t material = 0;
    glm::ivec2 coordinates{0};

    std::tuple<std::uint16_t, int, int> order() const {
        return {material, coordinates.x, coordinates.y};
    }
};

/// A source on its way to the lattice.
struct Packing {
    TriangleMesh source;
    std::vector<VertexKey> keys;         ///< of the source's vertices
    Weld byPosition;                     ///< points of the surface
    std::vector<fabric::Vec3> exact;     ///< by VertexKey::exact, where they are kept
    std::vector<TexturePlace> textures;  ///< by VertexKey::texture, where there are materials
};

/// Nearest to `part` images' sides; 0 where that is no number.
std::int32_t textureSteps(float part) {
    constexpr double kMost = kMostImageSides;
    return std::isfinite(part) ? static_cast<std::int32_t>(std::lround(
                                     std::clamp(double{part}, -kMost, kMost) * mesh::kTextureSteps))
                               : 0;
}

/// What has no image has no seams but where the material changes.
TexturePlace texturePlaceOf(const TriangleMesh& source, std::uint32_t i) {
    TexturePlace place{source.materialOf[i]};
    if (source.materials[place.material].hasImage())
        place.coordinates = {textureSteps(source.textureCoordinates[i].x),
                             textureSteps(source.textureCoordinates[i].y)};
    return place;
}

/// Numbers materials with texture coordinates; those that are equal have equal numbers.
void numberTextures(Packing& packing) {
    std::vector<std::uint32_t> order(packing.keys.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto placeOf = [&](std::uint32_t i) { return texturePlaceOf(packing.source, i); };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return placeOf(a).order() < placeOf(b).order();
    });
    for (const std::uint32_t i : order) {
        const TexturePlace place = placeOf(i);
        if (packing.textures.empty() || packing.textures.back().order() != place.order())
            packing.textures.push_back(place);
        packing.keys[i].texture = static_cast<std::uint32_t>(packing.textures.size() - 1);
    }
}

void gatherTextures(const Weld& welded, Packing& packing, mesh::PackedMesh& packed) {
    const bool hasImages = std::ranges::any_of(packing.source.materials, &mesh::Material::hasImage);
    for (const std::uint32_t key : welded.firstKey) {
        const TexturePlace& place = packing.textures[packing.keys[key].texture];
        packed.materialOf.push_back(place.material);
        if (hasImages)
            packed.textureCoordinates.push_back(place.coordinates);
    }
    packed.materials = std::move(packing.source.materials);
    packed.images = std::move(packing.source.images);
}

/// Numbers the source's positions; those that are equal, to the bit, have equal numbers.
void numberPositions(Packing& packing) {
    const std::vector<fabric::Vec3>& positions = packing.source.positions;
    using Bits = std::array<std::uint64_t, 3>;
    const auto bitsOf = [&](std::uint32_t i) {
        return std::bit_cast<Bits>(std::array{positions[i].x, positions[i].y, positions[i].z});
    };
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return bitsOf(a) < bitsOf(b); });
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i == 0 || bitsOf(order[i]) != bitsOf(order[i - 1]))
            packing.exact.push_back(positions[order[i]]);
        packing.keys[order[i]].exact = static_cast<std::uint32_t>(packing.exact.size() - 1);
    }
}

/// Fills the keys' normals: the source's where they are asked for and usable, smooth ones
/// elsewhere. By position they are smooth across a change of colour too.
void fillNormals(Packing& packing, NormalSource from, PackCounts& counts) {
    const TriangleMesh& source = packing.source;
    const bool takesOwn = from == NormalSource::File && !source.normals.empty();
    std::vector<std::uint32_t> computed;
    for (std::size_t i = 0; i < packing.keys.size(); ++i) {
        const std::uint32_t point = packing.byPosition.vertexOf[i];
        if (point == kNoVertex)
            continue;
        if (takesOwn && isUsable(source.normals[i])) {
            packing.keys[i].normal = mesh::packNormal(source.normals[i]);
            continue;
        }
        if (computed.empty())
            computed = packNormals(smoothNormals(positionsOf(packing.byPosition, packing.keys),
                                                 surfaceOf(source, packing.byPosition)));
        packing.keys[i].normal = computed[point];
        counts.normalsComputed = true;
    }
}

/// Gives each corner of each triangle a key of its own, with its own normal.
void splitAtCreases(Packing& packing, double creaseDegrees, PackCounts& counts) {
    const std::vector<std::uint32_t> normals = packNormals(
        creasedNormals(positionsOf(packing.byPosition, packing.keys),
                       surfaceOf(packing.source, packing.byPosition), glm::radians(creaseDegrees)));
    std::vector<VertexKey> keys;
    keys.reserve(normals.size());
    for (mesh::Triangle& triangle : packing.source.triangles)
        for (std::uint32_t& corner : triangle) {
            keys.push_back(packing.keys[corner]);
            keys.back().normal = normals[keys.size() - 1];
            corner = static_cast<std::uint32_t>(keys.size() - 1);
        }
    packing.keys = std::move(keys);
    counts.normalsComputed = true;
}

/// Whether corners that lie in the same places have the same colours and texture coordinates.
bool looksAlike(const Packing& packing, const mesh::Triangle& a, const mesh::Triangle& b) {
    const TriangleMesh& source = packing.source;
    const std::vector<std::uint32_t>& pointOf = packing.byPosition.vertexOf;
    return std::ranges::all_of(a, [&](std::uint32_t corner) {
        const std::uint32_t other = *std::ranges::find_if(
            b, [&](std::uint32_t each) { return pointOf[each] == pointOf[corner]; });
        return (source.colours.empty() || source.colours[corner] == source.colours[other]) &&
               texturePlaceOf(source, corner).coordinates ==
                   texturePlaceOf(source, other).coordinates;
    });
}

/// Whether nothing is seen of `after` where `before` is drawn first, in the same place and turn.
/// What lets through what is behind hides only what could be itself.
bool hides(const Packing& packing, const mesh::Triangle& before, const mesh::Triangle& after) {
    const TriangleMesh& source = packing.source;
    if (source.materials.empty())
        return true;
    const mesh::Material& over = source.materials[source.materialOf[before[0]]];
    const mesh::Material& under = source.materials[source.materialOf[after[0]]];
    const bool isFromBothSides =
        (!over.isOneSided() || under.isOneSided()) && (over.isTwoSided() || !under.isTwoSided());
    if (!over.isSeeThrough() && !under.isBlended() && isFromBothSides)
        return true;
    return over == under && looksAlike(packing, before, after);
}

void dropDuplicates(Packing& packing, PackCounts& counts) {
    auto& triangles = packing.source.triangles;
    const std::vector<bool> isDuplicate = findDuplicates(
        surfaceOf(packing.source, packing.byPosition), packing.byPosition.vertexCount(),
        [&](std::uint32_t before, std::uint32_t after) {
            return hides(packing, triangles[before], triangles[after]);
        });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i)
        if (!isDuplicate[i])
            triangles[kept++] = triangles[i];
    counts.duplicateTriangles = triangles.size() - kept;
    triangles.resize(kept);
}

void orient(Packing& packing, PackCounts& counts) {
    const std::vector<bool> turned =
        findTurned(positionsOf(packing.byPosition, packing.keys),
                   surfaceOf(packing.source, packing.byPosition), counts.orient);
    for (std::size_t i = 0; i < turned.size(); ++i)
        if (turned[i])
            std::swap(packing.source.triangles[i][1], packing.source.triangles[i][2]);
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

}  // namespace

bool isEmpty(const std::array<fabric::Vec3, 3>& corners) {
    return glm::cross(corners[1] - corners[0], corners[2] - corners[0]) == fabric::Vec3(0);
}

absl::Status nothingHasArea(std::uint64_t triangles, double stepMetres) {
    if (stepMetres == 0)
        return absl::InvalidArgumentError(
            fmt::format("faces: found {} triangles, none with any area, expected at least one; "
                        "export the mesh again with its faces",
                        triangles));
    return absl::InvalidArgumentError(fmt::format(
        "faces: found {} triangles, none with any area where corners are rounded to {:.3g} m, as "
        "they are in a mesh of this extent; export it again with its faces, without vertices far "
        "from all others",
        triangles, stepMetres));
}

absl::StatusOr<mesh::PackedMesh> packMesh(TriangleMesh source, PackCounts& counts,
                                          const PackOptions& options,
                                          const ImportControl& control) {
    counts = {};
    control.report("welding", 0);
    const std::size_t total = source.triangles.size();
    std::erase_if(source.triangles, [&source](const mesh::Triangle& triangle) {
        return isCollapsed(source, triangle);
    });
    counts.emptyTriangles = total - source.triangles.size();
    if (source.triangles.empty())
        return nothingHasArea(total);
    const std::vector<std::uint8_t> used = findUsed(source);
    ASSIGN_OR_RETURN(const mesh::Lattice lattice,
                     options.lattice
                         ? *options.lattice
                         : mesh::fitLattice(boundsOf(source, used), options.latticeBits));
    Packing packing{std::move(source), {}, {}, {}, {}};
    packing.keys = latticeKeys(packing.source, used, lattice);
    std::erase_if(packing.source.triangles, [&](const mesh::Triangle& triangle) {
        if (hasArea(packing.keys, triangle))
            return false;
        const auto& at = packing.source.positions;
        if (isEmpty({at[triangle[0]], at[triangle[1]], at[triangle[2]]}))
            ++counts.emptyTriangles;
        return true;
    });
    if (packing.source.triangles.empty())
        return nothingHasArea(total, counts.emptyTriangles == total ? 0 : lattice.stepMetres);
    counts.degenerateTriangles = total - packing.source.triangles.size();
    RETURN_IF_ERROR(control.check());
    packing.byPosition = weld(packing.keys, packing.source.triangles);
    const std::size_t vertices = packing.keys.size();
    counts.isolatedVertices = static_cast<std::uint64_t>(std::count(
        packing.byPosition.vertexOf.begin(), packing.byPosition.vertexOf.end(), kNoVertex));
    dropDuplicates(packing, counts);
    if (options.orients)
        orient(packing, counts);
    control.report("welding", 1);

    RETURN_IF_ERROR(control.check());
    control.report("normals", 0);
    if (options.keepsExact)
        numberPositions(packing);
    const bool hasMaterials = !packing.source.materials.empty();
    if (hasMaterials)
        numberTextures(packing);
    const bool hasColours = !packing.source.colours.empty();
    const bool hasOpacity =
        std::ranges::any_of(packing.source.materials, &mesh::Material::isSeeThrough);
    for (std::size_t i = 0; i < packing.source.colours.size(); ++i) {
        fabric::Rgba colour = packing.source.colours[i];
        if (!hasOpacity)
            colour.a = 255;  // as it is drawn
        packing.keys[i].colour = mesh::packColour(colour);
    }
    if (options.normals == NormalSource::Crease)
        splitAtCreases(packing, options.creaseDegrees, counts);
    else
        fillNormals(packing, options.normals, counts);
    control.report("normals", 1);
    const bool isSplit = hasColours || hasMaterials || options.keepsExact ||
                         options.normals == NormalSource::Crease ||
                         (options.normals == NormalSource::File && !packing.source.normals.empty());
    const Weld welded =
        isSplit ? weld(packing.keys, packing.source.triangles) : std::move(packing.byPosition);
    const std::size_t left = counts.isolatedVertices + welded.vertexCount();
    counts.weldedVertices = vertices > left ? vertices - left : 0;  // creases make more
    mesh::PackedMesh packed =
        gather(welded, packing.keys, hasColours, lattice, std::move(packing.source.triangles));
    packed.lights = std::move(packing.source.lights);
    packed.roundingMetres = packing.source.roundingMetres;
    if (hasMaterials)
        gatherTextures(welded, packing, packed);
    if (options.keepsExact)
        for (const std::uint32_t key : welded.firstKey)
            packed.exact.push_back(packing.exact[packing.keys[key].exact]);
    return packed;
}

}  // namespace eyrie::import
