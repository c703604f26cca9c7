// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/mesh_ray_caster.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <tuple>
#include <type_traits>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "renderer/truth/triangle.h"

namespace eyrie::truth {
namespace {

using fabric::Box;
using fabric::Vec3;

constexpr std::uint32_t kLeafTriangles = 4;
/// Of coordinates: of the longest side, to a lattice of 2^20 steps or so, and of themselves, in
/// single precision.
constexpr double kLatticeRounding = 1.0 / (1 << 20);
constexpr double kSingleRounding = 1.0 / (1 << 23);

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

bool isBefore(const Vec3& a, const Vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

using Edge = std::array<Vec3, 2>;

/// Whether `isThere` takes one of the edge's points within `reach` of `point`.
bool anyOfEdge(const Edge& edge, const Vec3& point, double reach,
               const std::function<bool(const Vec3&)>& isThere) {
    constexpr double kSteps = 16;  ///< of a length of `reach`
    const Vec3 along = edge[1] - edge[0];
    const double length = glm::length(along);
    const double nearest = glm::dot(point - edge[0], along) / length;
    const Vec3 beside = point - (edge[0] + nearest / length * along);
    const double square = reach * reach - glm::dot(beside, beside);
    if (!(square >= 0))
        return false;
    const double begin = std::max(0.0, nearest - std::sqrt(square));
    const double end = std::min(length, nearest + std::sqrt(square));
    const double steps = std::max(1.0, std::ceil((end - begin) / reach * kSteps));
    for (double i = 0; begin <= end && i <= steps; ++i)
        if (isThere(edge[0] + (begin + (end - begin) * i / steps) / length * along))
            return true;
    return false;
}

}  // namespace

MeshRayCaster::MeshRayCaster(TriangleMesh mesh) : mesh_(std::move(mesh)) {
    nodes_.reserve(mesh_.triangles.size());
    Order order(mesh_.triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    build(order, 0, static_cast<std::uint32_t>(order.size()));
    putInOrder(order);
}

Box MeshRayCaster::boundsOf(const Order& order, std::uint32_t begin, std::uint32_t end) const {
    Box box;
    for (std::uint32_t i = begin; i < end; ++i)
        for (const Vec3& corner : corners(mesh_, order[i])) box.grow(corner);
    return box;
}

std::uint32_t MeshRayCaster::build(Order& order, std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({boundsOf(order, begin, end), begin, end, 0});
    if (end - begin <= kLeafTriangles)
        return index;
    const Vec3 size = nodes_[index].bounds.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto centre = [&](std::uint32_t triangle) {
        const auto& [a, b, c] = mesh_.triangles[triangle];
        return mesh_.positions[a][axis] + mesh_.positions[b][axis] + mesh_.positions[c][axis];
    };
    const auto first = order.begin();
    std::nth_element(first + begin, first + middle, first + end,
                     [&](std::uint32_t a, std::uint32_t b) { return centre(a) < centre(b); });
    build(order, begin, middle);
    nodes_[index].right = build(order, middle, end);
    return index;
}

void MeshRayCaster::putInOrder(const Order& order) {
    const auto ordered = [&](const auto& values) {
        std::decay_t<decltype(values)> result;
        result.reserve(values.size());
        for (const std::uint32_t i : order) result.push_back(values[i]);
        return result;
    };
    mesh_.triangles = ordered(mesh_.triangles);
    if (!mesh_.sights.empty())
        mesh_.sights = ordered(mesh_.sights);
}

bool MeshRayCaster::isSure(std::size_t triangle, const Ray& ray) const {
    if (mesh_.sights.empty() || mesh_.sights[triangle] == Sight::Sure)
        return true;
    if (mesh_.sights[triangle] == Sight::Unsure)
        return false;
    const auto [a, b, c] = corners(mesh_, triangle);
    return glm::dot(glm::cross(b - a, c - a), ray.direction) < 0;
}

/// Whether it is no higher than what the rounding of coordinates may make of a line: nothing is
/// drawn of it that closes a seam.
bool MeshRayCaster::hasNoArea(const Triangle& triangle) const {
    const auto [a, b, c] = triangle;
    const double longest =
        std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    const Box& bounds = nodes_.front().bounds;
    const auto longestOf = [](const Vec3& v) { return std::max({v.x, v.y, v.z}); };
    const double rounding =
        kLatticeRounding * longestOf(bounds.size()) +
        kSingleRounding * longestOf(glm::max(glm::abs(bounds.min), glm::abs(bounds.max)));
    return glm::length(glm::cross(b - a, c - a)) <= longest * rounding;
}

/// Whether triangles that are sure to be seen go on from the edge between these places to both
/// sides, seen from `eye`.
bool MeshRayCaster::goesOn(const Vec3& a, const Vec3& b, const Vec3& eye) const {
    const Vec3 across = glm::cross(a - eye, b - eye);
    bool isLeft = false;
    bool isRight = false;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
        const Triangle triangle = corners(mesh_, i);
        if (std::ranges::find(triangle, a) == triangle.end() ||
            std::ranges::find(triangle, b) == triangle.end() || !isSure(i, {eye, a - eye}) ||
            hasNoArea(triangle))
            continue;
        for (const Vec3& corner : triangle) {
            const double side = corner == a || corner == b ? 0 : glm::dot(across, corner - eye);
            isLeft = isLeft || side > 0;
            isRight = isRight || side < 0;
        }
    }
    return isLeft && isRight;
}

bool MeshRayCaster::isAtSeam(std::size_t triangle, const Ray& ray, double hit, double reach) const {
    const Vec3 point = ray.at(hit);
    const Triangle at = corners(mesh_, triangle);
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& a = at[k];
        const Vec3& b = at[(k + 1) % 3];
        const double square = glm::dot(b - a, b - a);
        const double t =
            square > 0 ? std::clamp(glm::dot(point - a, b - a) / square, 0.0, 1.0) : 0.0;
        if (glm::distance(point, a + t * (b - a)) <= reach * hit && !goesOn(a, b, ray.origin))
            return true;
        if (glm::distance(point, a) <= reach * hit && !goesOnAround(a, ray.origin))
            return true;
    }
    return false;
}

/// The same for every edge that ends here: beside a corner a seam may open between two others.
bool MeshRayCaster::goesOnAround(const Vec3& corner, const Vec3& eye) const {
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
        const Triangle triangle = corners(mesh_, i);
        if (std::ranges::find(triangle, corner) == triangle.end())
            continue;
        for (const Vec3& other : triangle)
            if (other != corner && !goesOn(corner, other, eye))
                return false;
    }
    return true;
}

ReferenceSurface::HitRange MeshRayCaster::cast(const Ray& ray, double reach) const {
    const WatertightRay prepared(ray);
    HitRange range;
    std::array<std::uint32_t, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const std::uint32_t index = stack[--depth];
        const Node& node = nodes_[index];
        const double enters = entry(node.bounds, ray);
        if (enters == kNoHit || enters > range.last)
            continue;
        if (node.right == 0) {
            for (std::uint32_t i = node.begin; i < node.end; ++i) {
                const double hit = prepared.hit(corners(mesh_, i));
                range.first = std::min(range.first, hit);
                if (hit < range.last && isSure(i, ray) &&
                    !(reach > 0 && isAtSeam(i, ray, hit, reach)))
                    range.last = hit;
            }
            continue;
        }
        const bool rightFirst =
            entry(nodes_[node.right].bounds, ray) < entry(nodes_[index + 1].bounds, ray);
        stack[depth++] = rightFirst ? index + 1 : node.right;
        stack[depth++] = rightFirst ? node.right : index + 1;
    }
    return range;
}

/// Those of all triangles that come so near, each as often as triangles have it, and perhaps some
/// that lie farther off.
std::vector<Edge> MeshRayCaster::edgesWithin(const Vec3& point, double reach) const {
    std::vector<Edge> edges;
    std::vector<std::uint32_t> stack = {0};
    while (!stack.empty()) {
        const std::uint32_t index = stack.back();
        stack.pop_back();
        const Node& node = nodes_[index];
        if (distanceSquared(node.bounds, point) > reach * reach)
            continue;
        if (node.right != 0) {
            stack.push_back(index + 1);
            stack.push_back(node.right);
            continue;
        }
        for (std::uint32_t i = node.begin; i < node.end; ++i) {
            const Triangle at = corners(mesh_, i);
            for (std::size_t k = 0; k < 3; ++k)
                if (const Vec3& a = at[k], &b = at[(k + 1) % 3]; a != b)
                    edges.push_back(isBefore(a, b) ? Edge{a, b} : Edge{b, a});
        }
    }
    return edges;
}

bool MeshRayCaster::endsWithin(const Vec3& point, double reach,
                               const std::function<bool(const Vec3&)>& isThere) const {
    std::vector<Edge> edges = edgesWithin(point, reach);
    std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
        return a[0] == b[0] ? isBefore(a[1], b[1]) : isBefore(a[0], b[0]);
    });
    for (auto edge = edges.begin(); edge != edges.end();) {
        const auto next =
            std::find_if(edge, edges.end(), [&](const Edge& e) { return e != *edge; });
        if (next - edge == 1 && anyOfEdge(*edge, point, reach, isThere))
            return true;
        edge = next;
    }
    return false;
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
