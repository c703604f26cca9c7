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

double Star::distanceTo(std::size_t target, double limit) const {
    const Point& apex = ring_[target];
    for (std::size_t i = 1; i + 1 < count_; ++i)
        if (!(cross(apex, ring_[(target + i) % count_], ring_[(target + i + 1) % count_]) > least_))
            return kImpossible;
    double distance = heightOverCentre(target);
    for (std::size_t i = 2; i + 1 < count_ && distance <= limit; ++i)
        for (std::size_t j = 1; j < count_; ++j)
            if (j != i)
                distance = std::max(distance, heightAtCrossing(target, (target + i) % count_,
                                                               (target + j) % count_));
    return distance <= limit ? distance : kImpossible;
}

/// Of the new triangle that the centre lies in.
double Star::heightOverCentre(std::size_t target) const {
    const Point& a = ring_[target];
    for (std::size_t i = 1; i + 1 < count_; ++i) {
        const Point& b = ring_[(target + i) % count_];
        const Point& c = ring_[(target + i + 1) % count_];
        const double ofA = cross({}, b, c);
        const double ofB = cross({}, c, a);
        const double ofC = cross({}, a, b);
        if (ofA < 0 || ofB < 0 || ofC < 0)
            continue;
        return std::abs(ofA * a.height + ofB * b.height + ofC * c.height) / (ofA + ofB + ofC);
    }
    return kImpossible;  // by rounding between two
}

/// Between the new edge from ring[target] to ring[diagonal] and the old one from the centre to
/// ring[spoke], where they cross; 0 where they do not.
double Star::heightAtCrossing(std::size_t target, std::size_t diagonal, std::size_t spoke) const {
    const Point& a = ring_[target];
    const Point& b = ring_[diagonal];
    const Point& c = ring_[spoke];
    const double centreSide = cross(a, b, {});
    const double ringSide = cross(a, b, c);
    if ((centreSide > 0) == (ringSide > 0))
        return 0;
    const double aSide = cross({}, c, a);
    const double bSide = cross({}, c, b);
    if ((aSide > 0) == (bSide > 0))
        return 0;
    const double alongSpoke = centreSide / (centreSide - ringSide);
    const double alongDiagonal = aSide / (aSide - bSide);
    return std::abs(alongSpoke * c.height - (a.height + alongDiagonal * (b.height - a.height)));
}

}  // namespace eyrie::mesh
