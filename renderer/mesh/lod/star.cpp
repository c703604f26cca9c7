// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/star.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace eyrie::mesh {
namespace {

/// Of the largest extent squared: well above what rounding does to the sign of an area.
constexpr double kLeastArea = 1e-10;

void hold(Star::Shift& all, const Star::Shift& one) {
    all.least = std::min(all.least, one.least);
    all.most = std::max(all.most, one.most);
}

}  // namespace

Star::Star(const glm::dvec3& centre, std::span<const glm::dvec3> ring) : count_(ring.size()) {
    double extent = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        spokes_[i] = ring[i] - centre;
        extent = std::max(extent, glm::dot(spokes_[i], spokes_[i]));
    }
    least_ = kLeastArea * extent;
    isGraph_ = project();
    isFlat_ = isGraph_ || unfold();
}

/// Along the mean normal.
bool Star::project() {
    for (std::size_t i = 0; i < count_; ++i) normal_ += glm::cross(spokes_[i], spokes_[after(i)]);
    const double length = glm::length(normal_);
    if (!(length > 0))
        return false;
    normal_ /= length;
    const glm::dvec3 aside = std::abs(normal_.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(aside, normal_));
    const glm::dvec3 y = glm::cross(normal_, x);
    for (std::size_t i = 0; i < count_; ++i)
        ring_[i] = {glm::dot(spokes_[i], x), glm::dot(spokes_[i], y),
                    glm::dot(spokes_[i], normal_)};
    return liesFlat();
}

bool Star::unfold() {
    std::array<double, kMaxStar> angles;
    double sum = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const glm::dvec3& next = spokes_[after(i)];
        angles[i] =
            std::atan2(glm::length(glm::cross(spokes_[i], next)), glm::dot(spokes_[i], next));
        sum += angles[i];
    }
    if (!(sum > 0))
        return false;
    double angle = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const double radius = glm::length(spokes_[i]);
        ring_[i] = {radius * std::cos(angle), radius * std::sin(angle), 0};
        angle += angles[i] / sum * 2 * std::numbers::pi;
    }
    return liesFlat();
}

/// With triangles that all face the viewer, the ring could still go around twice.
bool Star::liesFlat() {
    for (std::size_t i = 0; i < count_; ++i) {
        wedges_[i][i] = 0;
        for (std::size_t j = i + 1; j < count_; ++j) {
            wedges_[i][j] = ring_[i].x * ring_[j].y - ring_[j].x * ring_[i].y;
            wedges_[j][i] = -wedges_[i][j];
        }
    }
    bool doAllFace = true;
    for (std::size_t i = 0; i < count_ && doAllFace; ++i) doAllFace = wedge(i, after(i)) > least_;
    return doAllFace && goesAroundOnce();
}

bool Star::goesAroundOnce() const {
    int upwards = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const Point& a = ring_[i];
        const Point& b = ring_[after(i)];
        if (a.y < 0 && b.y >= 0)
            ++upwards;
    }
    return upwards == 1;
}

/// Twice the signed area of a triangle between points of the ring.
double Star::area(std::size_t i, std::size_t j, std::size_t k) const {
    return wedge(i, j) + wedge(j, k) + wedge(k, i);
}

std::optional<Star::Landing> Star::landing(std::size_t target) const {
    std::size_t around = 0;  // the triangle that the centre lies in, or on the border of
    for (std::size_t i = 1; i + 1 < count_; ++i) {
        const std::size_t next = at(target, i + 1);
        if (!(area(target, at(target, i), next) > least_))
            return std::nullopt;
        if (around == 0 && wedge(target, next) <= 0)
            around = i;
    }
    if (around == 0)
        return std::nullopt;
    return Landing{shiftAtCentre(target, around), around};
}

void Star::moveTo(std::size_t target, const Landing& landing, Outcome& outcome) const {
    const auto bit = [&](std::size_t offset) { return 1U << at(target, offset); };
    const std::size_t around = landing.triangle;
    // What meets at the ring's edge, and at the target on either side of the centre.
    for (std::size_t i = 1; i + 1 < count_; ++i)
        outcome[at(target, i)] = {
            {}, bit(i) | (i <= around ? bit(0) : 0) | (i >= around ? bit(count_ - 1) : 0)};
    outcome[target] = outcome[at(target, count_ - 1)] = {{}, 0};
    outcome[at(target, 1)].triangles |= bit(0);
    outcome[at(target, count_ - 2)].triangles |= bit(count_ - 1);
    outcome[at(target, around)].triangles = (1U << count_) - 1;
    hold(outcome[at(target, around)].shift, landing.shift);
    for (std::size_t i = 2; i + 1 < count_; ++i) addDiagonal(target, i, outcome);
}

/// What the new edge from the target to another point of the ring crosses.
void Star::addDiagonal(std::size_t target, std::size_t diagonal, Outcome& outcome) const {
    const auto bit = [&](std::size_t offset) { return 1U << at(target, offset); };
    Replaced& right = outcome[at(target, diagonal - 1)];
    Replaced& left = outcome[at(target, diagonal)];
    (isOnLeft(target, diagonal) ? left : right).triangles |= bit(diagonal - 1) | bit(diagonal);
    forCrossings(target, diagonal, [&](std::size_t spoke, const Crossing& crossing) {
        const Shift shift =
            shiftAtCrossing(target, at(target, diagonal), at(target, spoke), crossing);
        for (Replaced* side : {&left, &right}) {
            hold(side->shift, shift);
            side->triangles |= bit(spoke - 1) | bit(spoke);
        }
    });
}

Star::Shift Star::shiftBy(double height) const {
    return {std::min(height, 0.0), std::max(height, 0.0)};
}

Star::Shares Star::sharesAtCentre(std::size_t target, std::size_t triangle) const {
    const std::size_t b = at(target, triangle);
    const std::size_t c = at(target, triangle + 1);
    return {wedge(b, c), wedge(c, target), wedge(target, b), b};
}

double Star::longestSide(std::size_t triangle, std::size_t target) const {
    const glm::dvec3& a = spokes_[target];
    const glm::dvec3& b = spokes_[triangle];
    const glm::dvec3& c = spokes_[after(triangle)];
    return std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
}

/// From it to the new triangle that it lies in.
Star::Shift Star::shiftAtCentre(std::size_t target, std::size_t triangle) const {
    const auto [ofA, ofB, ofC, b] = sharesAtCentre(target, triangle);
    const std::size_t c = after(b);
    const double all = ofA + ofB + ofC;
    if (!isGraph_)
        return shiftBy(glm::length(ofA * spokes_[target] + ofB * spokes_[b] + ofC * spokes_[c]) /
                       all);
    return shiftBy((ofA * ring_[target].height + ofB * ring_[b].height + ofC * ring_[c].height) /
                   all);
}

/// Nothing where they do not cross.
std::optional<Star::Crossing> Star::crossing(std::size_t target, std::size_t diagonal,
                                             std::size_t spoke) const {
    const double centreSide = wedge(target, diagonal);
    const double ringSide = area(target, diagonal, spoke);
    if ((centreSide > 0) == (ringSide > 0))
        return std::nullopt;
    const double aSide = wedge(spoke, target);
    const double bSide = wedge(spoke, diagonal);
    if ((aSide > 0) == (bSide > 0))
        return std::nullopt;
    return Crossing{centreSide / (centreSide - ringSide), aSide / (aSide - bSide)};
}

/// From the old edge from the centre to ring[spoke] to the new one from ring[target] to
/// ring[diagonal].
Star::Shift Star::shiftAtCrossing(std::size_t target, std::size_t diagonal, std::size_t spoke,
                                  const Crossing& crossing) const {
    const auto [alongSpoke, alongDiagonal] = crossing;
    if (!isGraph_)
        return shiftBy(glm::length(glm::mix(spokes_[target], spokes_[diagonal], alongDiagonal) -
                                   alongSpoke * spokes_[spoke]));
    return shiftBy(glm::mix(ring_[target].height, ring_[diagonal].height, alongDiagonal) -
                   alongSpoke * ring_[spoke].height);
}

}  // namespace eyrie::mesh
