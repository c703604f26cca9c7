// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/patch_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

constexpr double kHalfTurn = 180;
/// Of degrees: so that files do not depend on the last bit of a library's arc sine.
constexpr double kParts = 64;
/// More than packing a normal turns it (vertex_packing.h), degrees.
constexpr double kPacked = 1.0 / kParts;
/// More than the length of a blend in whose place samples take the triangle's own normal.
constexpr double kLeastBlend = 2e-3;

std::array<FieldValue, 3> normalsOf(const PackedMesh& mesh, const Triangle& triangle) {
    return {normalOf(mesh, triangle[0]), normalOf(mesh, triangle[1]), normalOf(mesh, triangle[2])};
}

glm::dvec3 vectorOf(const FieldValue& value) { return {value[0], value[1], value[2]}; }

/// No blend of the corners is shorter than the least that they have along their mean.
double leastLength(const std::array<FieldValue, 3>& corners) {
    const glm::dvec3 sum = vectorOf(corners[0] + corners[1] + corners[2]);
    double least = glm::length(sum);
    for (const FieldValue& corner : corners)
        least = std::min(least, glm::dot(vectorOf(corner), sum) / glm::length(sum));
    return least;
}

/// Shown is a vector of some length, the source's is off its tip by some way: so between the two is
/// at most the angle whose sine is that way over that length.
double mostDegrees(const FieldChanges& changes, const std::array<FieldValue, 3>& shown) {
    const double way = glm::length(vectorOf(larger(changes.up(), changes.down())));
    if (way == 0)
        return 0;
    const double length = leastLength(shown);
    if (!(way < length))
        return kHalfTurn;
    return std::ceil(std::asin(way / length) * kHalfTurn / std::numbers::pi * kParts) / kParts;
}

/// Its length is twice the triangle's area.
glm::dvec3 acrossOf(const PackedMesh& mesh, const Triangle& triangle) {
    const auto at = [&](std::size_t corner) {
        return glm::dvec3(unpackPosition(mesh.positions[triangle[corner]]));
    };
    return glm::cross(at(1) - at(0), at(2) - at(0));
}

/// Of the triangle's own normal from blends of its corners'.
double mostFromOwn(const glm::dvec3& across, const std::array<FieldValue, 3>& shown) {
    double most = 0;
    for (const FieldValue& corner : shown) {
        const glm::dvec3 normal = vectorOf(corner);
        most = std::max(
            most, std::atan2(glm::length(glm::cross(across, normal)), glm::dot(across, normal)));
    }
    return most < std::numbers::pi / 2 ? most * kHalfTurn / std::numbers::pi : kHalfTurn;
}

/// `mostOf(i)`: of a triangle.
template <typename MostOf>
NormalError errorOf(const PackedMesh& mesh, const Patch& patch, const MostOf& mostOf) {
    NormalError error;
    double area = 0;
    for (std::size_t i = 0; i < patch.triangles.size(); ++i) {
        const double degrees = mostOf(i);
        const double weight = glm::length(acrossOf(mesh, patch.triangles[i]));
        error.most = std::max(error.most, degrees);
        error.mean += weight * degrees;
        area += weight;
    }
    error.mean = area > 0 ? std::min(error.mean / area, error.most) : error.most;
    return error;
}

}  // namespace

FieldValue normalOf(const PackedMesh& mesh, std::uint32_t vertex) {
    const glm::vec3 normal = unpackNormal(mesh.normals[vertex]);
    return FieldValue{normal.x, normal.y, normal.z, 0};
}

std::vector<FieldChanges> normalChangesOf(const PackedMesh& mesh, const Patch& patch) {
    if (!patch.normals.empty())
        return patch.normals;
    std::vector<FieldChanges> changes;
    changes.reserve(patch.triangles.size());
    for (const Triangle& triangle : patch.triangles)
        changes.emplace_back(rangeOf(normalsOf(mesh, triangle)));
    return changes;
}

NormalError normalError(const PackedMesh& mesh, const Patch& patch) {
    if (patch.normals.empty())
        return {};
    return errorOf(mesh, patch, [&](std::size_t i) {
        return mostDegrees(patch.normals[i], normalsOf(mesh, patch.triangles[i]));
    });
}

NormalError sampledNormalError(const PackedMesh& mesh, const Patch& patch) {
    return errorOf(mesh, patch, [&](std::size_t i) {
        const Triangle& triangle = patch.triangles[i];
        const std::array<FieldValue, 3> shown = normalsOf(mesh, triangle);
        double most = kPacked;
        if (!patch.normals.empty())
            most += mostDegrees(patch.normals[i], shown);
        const bool isOneSided =
            !mesh.materials.empty() && mesh.materials[mesh.materialOf[triangle[0]]].isOneSided();
        if (isOneSided || leastLength(shown) < kLeastBlend)
            most += mostFromOwn(acrossOf(mesh, triangle), shown);
        return std::min(most, kHalfTurn);
    });
}

}  // namespace eyrie::mesh
