// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/star.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace eyrie::mesh {
namespace {

/// Of the largest extent squared: well above what rounding does to the sign of an area.
constexpr double kLeastArea = 1e-10;

}  // namespace

/// The centre is at the origin, at height 0.
Star::Star(const glm::dvec3& centre, std::span<const glm::dvec3> ring) : count_(ring.size()) {
    glm::dvec3 normal(0.0);
    double extent = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const glm::dvec3 spoke = ring[i] - centre;
        normal += glm::cross(spoke, ring[(i + 1) % count_] - centre);
        extent = std::max(extent, glm::dot(spoke, spoke));
    }
    const double length = glm::length(normal);
    if (!(length > 0))
        return;
    normal /= length;
    const glm::dvec3 aside = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(aside, normal));
    const glm::dvec3 y = glm::cross(normal, x);
    for (std::size_t i = 0; i < count_; ++i) {
        const glm::dvec3 spoke = ring[i] - centre;
        ring_[i] = {glm::dot(spoke, x), glm::dot(spoke, y), glm::dot(spoke, normal)};
    }
    least_ = kLeastArea * extent;
    isGraph_ = goesAroundOnce();
    for (std::size_t i = 0; i < count_ && isGraph_; ++i)
        isGraph_ = cross({}, ring_[i], ring_[(i + 1) % count_]) > least_;
}

/// Twice the signed area.
double Star::cross(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// With triangles that all face the viewer, the ring could still go around twice.
bool Star::goesAroundOnce() const {
    int upwards = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const Point& a = ring_[i];
        const Point& b = ring_[(i + 1) % count_];
        if (a.y < 0 && b.y >= 0)
            ++upwards;
    }
    return upwards == 1;
}

/// In the ring, counted from the target.
std::size_t Star::at(std::size_t target, std::size_t offset) const {
    const std::size_t index = target + offset;
    return index < count_ ? index : index - count_;
}

bool Star::movedTo(std::size_t target, double limit, Outcome& outcome) const {
    const Point& apex = ring_[target];
    const auto bit = [&](std::size_t offset) { return 1U << at(target, offset); };
    std::size_t around = 0;  // the triangle that the centre lies in, or on the border of
    for (std::size_t i = 1; i + 1 < count_; ++i) {
        const Point& next = ring_[at(target, i + 1)];
        if (!(cross(apex, ring_[at(target, i)], next) > least_))
            return false;
        if (around == 0 && cross(apex, next, {}) <= 0)
            around = i;
    }
    const double moved = around == 0 ? limit : heightAtCentre(target, around);
    if (!(moved < limit))
        return false;
    // What meets at the ring's edge, and at the target on either side of the centre.
    for (std::size_t i = 1; i + 1 < count_; ++i)
        outcome[at(target, i)] = {
            0, bit(i) | (i <= around ? bit(0) : 0) | (i >= around ? bit(count_ - 1) : 0)};
    outcome[target] = outcome[at(target, count_ - 1)] = {0, 0};
    outcome[at(target, 1)].triangles |= bit(0);
    outcome[at(target, count_ - 2)].triangles |= bit(count_ - 1);
    outcome[at(target, around)] = {moved, (1U << count_) - 1};
    for (std::size_t i = 2; i + 1 < count_; ++i) addDiagonal(target, i, outcome);
    return true;
}

/// What the new edge from the target to another point of the ring crosses.
void Star::addDiagonal(std::size_t target, std::size_t diagonal, Outcome& outcome) const {
    const auto bit = [&](std::size_t offset) { return 1U << at(target, offset); };
    Replaced& right = outcome[at(target, diagonal - 1)];
    Replaced& left = outcome[at(target, diagonal)];
    // The old edge to the same point lies on the centre's side.
    const bool isLeft = cross(ring_[target], ring_[at(target, diagonal)], {}) > 0;
    (isLeft ? left : right).triangles |= bit(diagonal - 1) | bit(diagonal);
    for (std::size_t spoke = 1; spoke < count_; ++spoke) {
        if (spoke == diagonal)
            continue;
        const double height = heightAtCrossing(target, at(target, diagonal), at(target, spoke));
        if (height < 0)
            continue;
        for (Replaced* side : {&left, &right}) {
            side->distance = std::max(side->distance, height);
            side->triangles |= bit(spoke - 1) | bit(spoke);
        }
    }
}

/// Of the new triangle that the centre lies in.
double Star::heightAtCentre(std::size_t target, std::size_t triangle) const {
    const Point& a = ring_[target];
    const Point& b = ring_[at(target, triangle)];
    const Point& c = ring_[at(target, triangle + 1)];
    const double ofA = cross({}, b, c);
    const double ofB = cross({}, c, a);
    const double ofC = cross({}, a, b);
    return std::abs(ofA * a.height + ofB * b.height + ofC * c.height) / (ofA + ofB + ofC);
}

/// Between the new edge from ring[target] to ring[diagonal] and the old one from the centre to
/// ring[spoke], where they cross; below 0 where they do not.
double Star::heightAtCrossing(std::size_t target, std::size_t diagonal, std::size_t spoke) const {
    const Point& a = ring_[target];
    const Point& b = ring_[diagonal];
    const Point& c = ring_[spoke];
    const double centreSide = cross(a, b, {});
    const double ringSide = cross(a, b, c);
    if ((centreSide > 0) == (ringSide > 0))
        return -1;
    const double aSide = cross({}, c, a);
    const double bSide = cross({}, c, b);
    if ((aSide > 0) == (bSide > 0))
        return -1;
    const double alongSpoke = centreSide / (centreSide - ringSide);
    const double alongDiagonal = aSide / (aSide - bSide);
    return std::abs(alongSpoke * c.height - (a.height + alongDiagonal * (b.height - a.height)));
}

}  // namespace eyrie::mesh
