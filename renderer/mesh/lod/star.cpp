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
    measureWedges();
    isGraph_ = goesAroundOnce();
    for (std::size_t i = 0; i < count_ && isGraph_; ++i)
        isGraph_ = wedge(i, (i + 1) % count_) > least_;
}

void Star::measureWedges() {
    for (std::size_t i = 0; i < count_; ++i) {
        wedges_[i][i] = 0;
        for (std::size_t j = i + 1; j < count_; ++j) {
            wedges_[i][j] = ring_[i].x * ring_[j].y - ring_[j].x * ring_[i].y;
            wedges_[j][i] = -wedges_[i][j];
        }
    }
}

/// Twice the signed area of a triangle between points of the ring.
double Star::area(std::size_t i, std::size_t j, std::size_t k) const {
    return wedge(i, j) + wedge(j, k) + wedge(k, i);
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
    const auto bit = [&](std::size_t offset) { return 1U << at(target, offset); };
    std::size_t around = 0;  // the triangle that the centre lies in, or on the border of
    for (std::size_t i = 1; i + 1 < count_; ++i) {
        const std::size_t next = at(target, i + 1);
        if (!(area(target, at(target, i), next) > least_))
            return false;
        if (around == 0 && wedge(target, next) <= 0)
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
    const bool isLeft = wedge(target, at(target, diagonal)) > 0;
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
    const std::size_t b = at(target, triangle);
    const std::size_t c = at(target, triangle + 1);
    const double ofA = wedge(b, c);
    const double ofB = wedge(c, target);
    const double ofC = wedge(target, b);
    return std::abs(ofA * ring_[target].height + ofB * ring_[b].height + ofC * ring_[c].height) /
           (ofA + ofB + ofC);
}

/// Between the new edge from ring[target] to ring[diagonal] and the old one from the centre to
/// ring[spoke], where they cross; below 0 where they do not.
double Star::heightAtCrossing(std::size_t target, std::size_t diagonal, std::size_t spoke) const {
    const double centreSide = wedge(target, diagonal);
    const double ringSide = area(target, diagonal, spoke);
    if ((centreSide > 0) == (ringSide > 0))
        return -1;
    const double aSide = wedge(spoke, target);
    const double bSide = wedge(spoke, diagonal);
    if ((aSide > 0) == (bSide > 0))
        return -1;
    const double alongSpoke = centreSide / (centreSide - ringSide);
    const double alongDiagonal = aSide / (aSide - bSide);
    const double from = ring_[target].height;
    return std::abs(alongSpoke * ring_[spoke].height -
                    (from + alongDiagonal * (ring_[diagonal].height - from)));
}

}  // namespace eyrie::mesh
