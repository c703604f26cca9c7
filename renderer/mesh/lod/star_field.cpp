// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/star_field.h"

#include <algorithm>
#include <bit>

namespace eyrie::mesh {
namespace {

FieldValue mix(const FieldValue& from, const FieldValue& to, double share) {
    return from + (to - from) * static_cast<float>(share);
}

}  // namespace

void StarField::add(const FieldValue& from, const FieldValue& to, const FieldChanges& changes) {
    if (count_ == 0)
        all_ = changes;
    else
        isSmooth_ = isSmooth_ && FieldRange{to_[count_ - 1], from}.isOne();
    all_.hold(changes);
    values_.hold(from);
    values_.hold(to);
    from_[count_] = from;
    to_[count_] = to;
    changes_[count_++] = changes;
}

/// Whether both triangles at a spoke have one value at its end.
bool StarField::isSmooth() const {
    return isSmooth_ && FieldRange{to_[count_ - 1], from_[0]}.isOne();
}

FieldRange StarField::shownBy(std::size_t triangle, std::size_t target) const {
    return rangeOf({from_[target], from_[triangle], to_[triangle]});
}

FieldRange StarField::changeAtCentre(const Star& star, std::size_t target,
                                     const Star::Landing& landing) const {
    const auto [ofA, ofB, ofC, b] = star.sharesAtCentre(target, landing.triangle);
    const double all = ofA + ofB + ofC;
    const FieldValue there = from_[target] * static_cast<float>(ofA / all) +
                             from_[b] * static_cast<float>(ofB / all) +
                             to_[b] * static_cast<float>(ofC / all);
    FieldRange change{};
    change.hold(there - centre_);
    return change;
}

/// By triangle: from the least to the most that its points have more than their partners had, 0
/// included. Where a point of the ring has several values the triangles' ends may change, too: then
/// it is as much as the values there are allow.
void StarField::steps(const Star& star, std::size_t target, const Star::Landing& landing,
                      Steps& steps) const {
    if (!isSmooth()) {
        std::fill_n(steps.begin(), count_,
                    FieldRange{values_.least - values_.most, values_.most - values_.least});
        return;
    }
    std::fill_n(steps.begin(), count_, FieldRange{});
    steps[star.at(target, landing.triangle)] = changeAtCentre(star, target, landing);
    for (std::size_t i = 2; i + 1 < count_; ++i)
        star.forCrossings(target, i, [&](std::size_t spoke, const Star::Crossing& crossing) {
            const FieldValue before =
                mix(centre_, from_[star.at(target, spoke)], crossing.alongSpoke);
            const FieldValue now =
                mix(from_[target], from_[star.at(target, i)], crossing.alongDiagonal);
            steps[star.at(target, i - 1)].hold(now - before);
            steps[star.at(target, i)].hold(now - before);
        });
}

/// Of those with a bit. Precondition: there is one.
FieldChanges StarField::changesOf(std::uint32_t triangles) const {
    FieldChanges all = changes_[static_cast<std::size_t>(std::countr_zero(triangles))];
    for (std::uint32_t left = triangles & (triangles - 1); left != 0; left &= left - 1)
        all.hold(changes_[static_cast<std::size_t>(std::countr_zero(left))]);
    return all;
}

}  // namespace eyrie::mesh
