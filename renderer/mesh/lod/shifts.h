// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/vec3.hpp>

namespace eyrie::mesh {

/// A set of ways that points of a surface have gone, in lattice steps, by a bound on their lengths
/// and a box that they end in when they start at the origin.
///
/// Lengths alone would count a way up and one down as twice a way; the box knows that they cancel.
/// The box alone would count what goes along a diagonal by its corners.
class Shifts {
public:
    /// No way that is held is longer.
    float longest() const {
        const Row most = larger(up_, down_);
        return std::min(up_[3],
                        std::sqrt(most[0] * most[0] + most[1] * most[1] + most[2] * most[2]));
    }

    void hold(const Shifts& other) {
        up_ = larger(up_, other.up_);
        down_ = larger(down_, other.down_);
    }

    /// Each way, and then one of `least` to `most` times the unit vector `along`. Preconditions:
    /// least <= 0 <= most.
    Shifts andThen(const glm::vec3& along, float least, float most) const {
        const Row there = Row{along.x, along.y, along.z, 1} * most;
        const Row back = Row{along.x, along.y, along.z, -1} * least;
        return plus(larger(there, back), larger(-there, -back));
    }

    /// Each way, and then any that is not longer than `way`.
    Shifts andThen(float way) const { return plus(Row{way, way, way, way}, Row{way, way, way, 0}); }

private:
    /// What a processor handles at once: with arrays, levels take a fifth longer.
    using Row [[gnu::vector_size(16)]] = float;

    /// More than rounding adds in a step and in longest(), relative and in lattice steps.
    static constexpr float kRounding = 2e-6F;

    static Row larger(const Row& a, const Row& b) { return a > b ? a : b; }

    Shifts plus(const Row& up, const Row& down) const {
        Shifts sum;
        sum.up_ = (up_ + up) * (1 + kRounding) + kRounding;
        sum.down_ = (down_ + down) * (1 + kRounding) + kRounding;
        return sum;
    }

    Row up_{};    ///< how far the ways go towards +x, +y and +z, and how long they are
    Row down_{};  ///< towards -x, -y and -z; the fourth means nothing
};

}  // namespace eyrie::mesh
