// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "fabric/image.h"
#include "renderer/mesh/lod/field.h"

namespace eyrie::mesh {

/// What is linear on a triangle between its corners (effects/object.block): red, green and blue as
/// light, the square of what is displayed, and the opacity as it is.
inline FieldValue lightOf(const fabric::Rgba& colour) {
    const FieldValue shown = {static_cast<float>(colour.r), static_cast<float>(colour.g),
                              static_cast<float>(colour.b), static_cast<float>(colour.a)};
    const FieldValue times = {shown[0], shown[1], shown[2], 255.0F};
    return shown * times * (1.0F / (255.0F * 255.0F));
}

/// As displayed, of 1.
inline FieldValue roots(const FieldValue& light) {
    FieldValue shown;
    for (int k = 0; k < 4; ++k) shown[k] = std::sqrt(light[k]);
    return shown;
}

/// How much a light of `high` may be displayed above one of `low` that it exceeds by `by` at most;
/// less than 0 where there is none. Roots grow the slower the higher: so the darkest pair is the
/// farthest apart.
inline FieldValue mostAbove(const FieldRange& low, const FieldRange& high, const FieldValue& by) {
    const FieldValue from = larger(larger(low.least, high.least - by), FieldValue{});
    return roots(smaller(high.most, from + by)) - roots(from);
}

/// The most that a triangle which shows `shown` is off in a channel, as displayed, or in opacity,
/// of 1.
inline float mostTint(const FieldChanges& tints, const FieldRange& shown) {
    const FieldValue off = larger(mostAbove(tints.source(), shown, tints.up()),
                                  mostAbove(shown, tints.source(), tints.down()));
    return std::max({off[0], off[1], off[2], tints.up()[3], tints.down()[3]});
}

}  // namespace eyrie::mesh
