// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace eyrie::mesh {

/// A closed box of lattice points; none (min > max) until it has grown.
struct LatticeBox {
    glm::uvec3 min{std::numeric_limits<std::uint32_t>::max()};
    glm::uvec3 max{0U};

    void grow(const glm::uvec3& point) {
        min = glm::min(min, point);
        max = glm::max(max, point);
    }
    void grow(const LatticeBox& other) {
        min = glm::min(min, other.min);
        max = glm::max(max, other.max);
    }
    /// 0, 1 or 2; of equal ones the first. Precondition: it has grown.
    int longestAxis() const {
        const glm::uvec3 size = max - min;
        if (size.x >= size.y && size.x >= size.z)
            return 0;
        return size.y >= size.z ? 1 : 2;
    }
};

}  // namespace eyrie::mesh
