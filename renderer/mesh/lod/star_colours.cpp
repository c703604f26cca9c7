// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/star_colours.h"

#include <algorithm>
#include <bit>

#include "renderer/mesh/lod/patch_colours.h"

namespace eyrie::mesh {
namespace {

Light3 mix(const Light3& from, const Light3& to, double share) {
    return from + (to - from) * static_cast<float>(share);
}

double reachOf(const Star& star, std::size_t triangle, std::size_t target,
               const LightRange& shown) {
    return double{reachShare(shown)} * star.longestSide(triangle, target);
}

}  // namespace

void StarColours::add(const Light3& from, const Light3& to, const Tints& tints) {
    if (count_ == 0)
        allTints_ = tints;
    else
        isSmooth_ = isSmooth_ && LightRange{to_[count_ - 1], from}.isOne();
    allTints_.hold(tints);
    colours_.hold(from);
    colours_.hold(to);
    from_[count_] = from;
    to_[count_] = to;
    tints_[count_++] = tints;
}

/// Whether both triangles at a spoke have one colour at its end.
bool StarColours::isSmooth() const {
    return isSmooth_ && LightRange{to_[count_ - 1], from_[0]}.isOne();
}

LightRange StarColours::shownBy(std::size_t triangle, std::size_t target) const {
    return rangeOf({from_[target], from_[triangle], to_[triangle]});
}

/// From 0 to that at the centre's partner.
LightRange StarColours::changeAtCentre(const Star& star, std::size_t target,
                                       const Star::Landing& landing) const {
    const auto [ofA, ofB, ofC, b] = star.sharesAtCentre(target, landing.triangle);
    const double all = ofA + ofB + ofC;
    const Light3 there = from_[target] * static_cast<float>(ofA / all) +
                         from_[b] * static_cast<float>(ofB / all) +
                         to_[b] * static_cast<float>(ofC / all);
    LightRange change{};
    change.hold(there - centre_);
    return change;
}

/// By triangle: from the least to the most that its points are brighter than their partners were, 0
/// included. Where a point of the ring has several colours the triangles' ends may change, too:
/// then it is as much as the colours there are allow.
void StarColours::changes(const Star& star, std::size_t target, const Star::Landing& landing,
                          Changes& changes) const {
    if (!isSmooth()) {
        std::fill_n(changes.begin(), count_,
                    LightRange{colours_.least - colours_.most, colours_.most - colours_.least});
        return;
    }
    std::fill_n(changes.begin(), count_, LightRange{});
    changes[star.at(target, landing.triangle)] = changeAtCentre(star, target, landing);
    for (std::size_t i = 2; i + 1 < count_; ++i)
        star.forCrossings(target, i, [&](std::size_t spoke, const Star::Crossing& crossing) {
            const Light3 before = mix(centre_, from_[star.at(target, spoke)], crossing.alongSpoke);
            const Light3 now =
                mix(from_[target], from_[star.at(target, i)], crossing.alongDiagonal);
            changes[star.at(target, i - 1)].hold(now - before);
            changes[star.at(target, i)].hold(now - before);
        });
}

/// Of those with a bit. Precondition: there is one.
Tints StarColours::tintsOf(std::uint32_t triangles) const {
    Tints all = tints_[static_cast<std::size_t>(std::countr_zero(triangles))];
    for (std::uint32_t left = triangles & (triangles - 1); left != 0; left &= left - 1)
        all.hold(tints_[static_cast<std::size_t>(std::countr_zero(left))]);
    return all;
}

StarColours::AtCentre StarColours::landing(const Star& star, std::size_t target,
                                           const Star::Landing& landing) const {
    const std::size_t triangle = star.at(target, landing.triangle);
    const LightRange shown = shownBy(triangle, target);
    const Tints tints = allTints_.andThen(changeAtCentre(star, target, landing), shown);
    return {tints.most(shown), isOff(tints, shown) ? reachOf(star, triangle, target, shown) : 0};
}

/// Visits the triangles that are left, with their tints and what they show.
template <typename Visit>
void StarColours::forLeft(const Star& star, std::size_t target, const Star::Landing& landing,
                          const Star::Outcome& replaced, const Visit& visit) const {
    Changes changes;
    this->changes(star, target, landing, changes);
    for (std::size_t i = 0; i < count_; ++i) {
        if (replaced[i].triangles == 0)
            continue;
        const LightRange shown = shownBy(i, target);
        visit(i, tintsOf(replaced[i].triangles).andThen(changes[i], shown), shown);
    }
}

double StarColours::reach(const Star& star, std::size_t target, const Star::Landing& landing,
                          const Star::Outcome& replaced) const {
    double reach = 0;
    forLeft(star, target, landing, replaced,
            [&](std::size_t i, const Tints& tints, const LightRange& shown) {
                if (isOff(tints, shown))
                    reach = std::max(reach, reachOf(star, i, target, shown));
            });
    return reach;
}

void StarColours::moveTo(const Star& star, std::size_t target, const Star::Landing& landing,
                         const Star::Outcome& replaced, Outcome& outcome) const {
    forLeft(star, target, landing, replaced,
            [&](std::size_t i, const Tints& tints, const LightRange&) { outcome[i] = tints; });
}

}  // namespace eyrie::mesh
