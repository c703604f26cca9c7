// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>

#include <glm/common.hpp>

#include "fabric/vec.h"

namespace eyrie::fabric {

/// Axis-aligned box, closed, in whatever frame its owner says. Starts empty (min > max).
struct Box {
    Vec3 min{std::numeric_limits<double>::infinity()};
    Vec3 max{-std::numeric_limits<double>::infinity()};

    bool isEmpty() const { return min.x > max.x || min.y > max.y || min.z > max.z; }
    Vec3 centre() const { return (min + max) * 0.5; }
    Vec3 size() const { return max - min; }
    bool contains(const Vec3& p) const {
        return p.x >= min.x && p.x <= max.x && p.y >= min.y && p.y <= max.y && p.z >= min.z &&
               p.z <= max.z;
    }
    void grow(const Vec3& p) {
        min = glm::min(min, p);
        max = glm::max(max, p);
    }
    void grow(const Box& other) {
        min = glm::min(min, other.min);
        max = glm::max(max, other.max);
    }
    /// The box with every face moved outwards by `metres`.
    Box grownBy(double metres) const { return {min - Vec3(metres), max + Vec3(metres)}; }
    /// Corner i: bit 0 chooses x, bit 1 y, bit 2 z; a set bit takes `max`.
    Vec3 corner(int i) const {
        return {(i & 1) != 0 ? max.x : min.x, (i & 2) != 0 ? max.y : min.y,
                (i & 4) != 0 ? max.z : min.z};
    }
    bool operator==(const Box&) const = default;
};

/// The smallest box around `box` after an affine transform.
inline Box transformed(const Box& box, const Mat4& transform) {
    Box result;
    if (box.isEmpty())
        return result;
    for (int i = 0; i < 8; ++i) result.grow(Vec3(transform * Vec4(box.corner(i), 1.0)));
    return result;
}

}  // namespace eyrie::fabric
