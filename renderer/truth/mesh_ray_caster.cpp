// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/mesh_ray_caster.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "renderer/truth/triangle.h"

namespace eyrie::truth {
namespace {

using fabric::Box;
using fabric::Vec3;

constexpr std::uint32_t kLeafTriangles = 4;

Triangle corners(const TriangleMesh& mesh, std::size_t index) {
    const auto& [a, b, c] = mesh.triangles[index];
    return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
}

/// The parameter at which the ray enters the box, or kNoHit. Grown by a few ulps, so that no
/// rounding loses a triangle that lies in a face of its box.
double entry(const Box& box, const Ray& ray) {
    double begin = 0;
    double end = kNoHit;
    for (int axis = 0; axis < 3; ++axis) {
        const double slack = 1e-14 * (std::abs(ray.origin[axis]) + std::abs(box.min[axis]) +
                                      std::abs(box.max[axis]));
        const double low = box.min[axis] - slack - ray.origin[axis];
        const double high = box.max[axis] + slack - ray.origin[axis];
        const double direction = ray.direction[axis];
        if (direction == 0) {
            if (low > 0 || high < 0)
                return kNoHit;
            continue;
        }
        const double a = low / direction;
        const double b = high / direction;
        begin = std::max(begin, std::min(a, b) * (1 - 1e-14));
        end = std::min(end, std::max(a, b) * (1 + 1e-14));
    }
    return begin <= end ? begin : kNoHit;
}

double distanceSquared(const Box& box, const Vec3& point) {
    const Vec3 nearest = glm::clamp(point, box.min, box.max);
    return glm::dot(point - nearest, point - nearest);
}

}  // namespace

MeshRayCaster::MeshRayCaster(TriangleMesh mesh) : mesh_(std::move(mesh)) {
    nodes_.reserve(mesh_.triangles.size());
    build(0, static_cast<std::uint32_t>(mesh_.triangles.size()));
}

Box MeshRayCaster::boundsOf(std::uint32_t begin, std::uint32_t end) const {
    Box box;
    for (std::uint32_t i = begin; i < end; ++i)
        for (const Vec3& corner : corners(mesh_, i)) box.grow(corner);
    return box;
}

std::uint32_t MeshRayCaster::build(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({boundsOf(begin, end), begin, end, 0});
    if (end - begin <= kLeafTriangles)
        return index;
    const Vec3 size = nodes_[index].bounds.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto centre = [&](const std::array<std::uint32_t, 3>& t) {
        return mesh_.positions[t[0]][axis] + mesh_.positions[t[1]][axis] +
               mesh_.positions[t[2]][axis];
    };
    const auto first = mesh_.triangles.begin();
    std::nth_element(first + begin, first + middle, first + end,
                     [&](const auto& a, const auto& b) { return centre(a) < centre(b); });
    build(begin, middle);
    nodes_[index].right = build(middle, end);
    return index;
}

double MeshRayCaster::firstHit(const Ray& ray) const {
    const WatertightRay prepared(ray);
    double first = kNoHit;
    std::array<std::uint32_t, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const std::uint32_t index = stack[--depth];
        const Node& node = nodes_[index];
        const double enters = entry(node.bounds, ray);
        if (enters == kNoHit || enters > first)
            continue;
        if (node.right == 0) {
            for (std::uint32_t i = node.begin; i < node.end; ++i)
                first = std::min(first, prepared.hit(corners(mesh_, i)));
            continue;
        }
        const bool rightFirst =
            entry(nodes_[node.right].bounds, ray) < entry(nodes_[index + 1].bounds, ray);
        stack[depth++] = rightFirst ? index + 1 : node.right;
        stack[depth++] = rightFirst ? node.right : index + 1;
    }
    return first;
}

std::optional<Vec3> MeshRayCaster::counterpart(const Vec3& point) const {
    // Who asks goes on next to where it was: what was found there bounds the distance at once.
    // Any triangle will do, so it does not matter whose mesh it was of.
    thread_local std::uint32_t last = 0;
    last = std::min(last, static_cast<std::uint32_t>(mesh_.triangles.size() - 1));
    Vec3 best = closestPoint(corners(mesh_, last), point);
    double bestSquared = glm::dot(best - point, best - point);
    if (std::isnan(bestSquared))  // a triangle without area
        bestSquared = kNoHit;
    std::array<std::uint32_t, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const std::uint32_t index = stack[--depth];
        const Node& node = nodes_[index];
        if (distanceSquared(node.bounds, point) >= bestSquared)
            continue;
        if (node.right != 0) {
            const bool rightFirst = distanceSquared(nodes_[node.right].bounds, point) <
                                    distanceSquared(nodes_[index + 1].bounds, point);
            stack[depth++] = rightFirst ? index + 1 : node.right;
            stack[depth++] = rightFirst ? node.right : index + 1;
            continue;
        }
        for (std::uint32_t i = node.begin; i < node.end; ++i) {
            const Vec3 candidate = closestPoint(corners(mesh_, i), point);
            const double squared = glm::dot(candidate - point, candidate - point);
            if (squared < bestSquared) {
                bestSquared = squared;
                best = candidate;
                last = i;
            }
        }
    }
    return best;
}

}  // namespace eyrie::truth
