// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "fabric/image.h"

namespace eyrie::mesh {

/// Red, green and blue as light: the square of what is displayed, which is linear on a triangle
/// between its corners (effects/object.block). The fourth means nothing.
using Light3 [[gnu::vector_size(16)]] = float;

inline Light3 lightOf(const fabric::Rgba& colour) {
    const Light3 shown = {static_cast<float>(colour.r), static_cast<float>(colour.g),
                          static_cast<float>(colour.b), 0};
    return shown * shown * (1.0F / (255.0F * 255.0F));
}

inline Light3 larger(const Light3& a, const Light3& b) { return a > b ? a : b; }
inline Light3 smaller(const Light3& a, const Light3& b) { return a < b ? a : b; }

/// As displayed, of 1.
inline Light3 roots(const Light3& light) {
    Light3 shown;
    for (int k = 0; k < 4; ++k) shown[k] = std::sqrt(light[k]);
    return shown;
}

/// The least and the most of some colours, channel by channel.
struct LightRange {
    Light3 least;
    Light3 most;

    static LightRange of(const Light3& one) { return {one, one}; }
    void hold(const Light3& one) {
        least = smaller(least, one);
        most = larger(most, one);
    }
    void hold(const LightRange& other) {
        hold(other.least);
        hold(other.most);
    }
    /// Whether the two are the same in all channels.
    bool isOne() const { return least[0] == most[0] && least[1] == most[1] && least[2] == most[2]; }
};

inline LightRange rangeOf(const std::array<Light3, 3>& corners) {
    LightRange range = LightRange::of(corners[0]);
    range.hold(corners[1]);
    range.hold(corners[2]);
    return range;
}

/// What a triangle of a patch may have done to the colours of the source's points that have
/// partners on it: how much brighter and darker it shows them, and what colours they have there.
///
/// Like the ways that points go (shifts.h), changes add up from step to step, brighter and darker
/// apart. They cannot be more than what is shown is above or below what the source has: of noise,
/// where steps never cancel, that is the lesser.
class Tints {
public:
    Tints() = default;  ///< as it comes: arrays of them are filled, and often
    /// Of a triangle of the source.
    explicit Tints(const LightRange& corners) : brighter_{}, darker_{}, source_(corners) {}

    void hold(const Tints& other) {
        brighter_ = larger(brighter_, other.brighter_);
        darker_ = larger(darker_, other.darker_);
        source_.hold(other.source_);
    }

    /// Each change, and then one of `step`, on a triangle that shows `shown`. Precondition: `step`
    /// holds 0.
    Tints andThen(const LightRange& step, const LightRange& shown) const {
        Tints sum = *this;
        sum.brighter_ = withinReason(brighter_ + step.most + kRounding, shown.most - source_.least);
        sum.darker_ = withinReason(darker_ - step.least + kRounding, source_.most - shown.least);
        return sum;
    }

    /// The most that a triangle which shows `shown` is off in a channel, as displayed, of 1.
    float most(const LightRange& shown) const {
        const Light3 off =
            larger(mostAbove(source_, shown, brighter_), mostAbove(shown, source_, darker_));
        return std::max({off[0], off[1], off[2]});
    }

private:
    /// More than rounding adds in a step.
    static constexpr float kRounding = 1e-6F;

    static Light3 withinReason(const Light3& sum, const Light3& most) {
        return larger(smaller(sum, most), Light3{});
    }

    /// How much a light of `high` may be displayed above one of `low` that it exceeds by `by` at
    /// most; less than 0 where there is none. Roots grow the slower the higher: so the darkest pair
    /// is the farthest apart.
    static Light3 mostAbove(const LightRange& low, const LightRange& high, const Light3& by) {
        const Light3 from = larger(larger(low.least, high.least - by), Light3{});
        return roots(smaller(high.most, from + by)) - roots(from);
    }

    Light3 brighter_;
    Light3 darker_;
    LightRange source_;
};

}  // namespace eyrie::mesh
