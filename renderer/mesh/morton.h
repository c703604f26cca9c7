// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "renderer/mesh/lattice.h"

namespace eyrie::mesh {

/// Where a lattice point is along the Morton curve: neighbours on it are mostly close in space.
/// G. M. Morton, "A Computer Oriented Geodetic Data Base", 1966.
inline std::uint64_t mortonKey(const glm::uvec3& point) {
    // The 21 low bits of `value`, two zeros before each.
    const auto spread = [](std::uint64_t value) {
        value &= kMaxLatticeCoordinate;
        value = (value | value << 32) & 0x001F00000000FFFFULL;
        value = (value | value << 16) & 0x001F0000FF0000FFULL;
        value = (value | value << 8) & 0x100F00F00F00F00FULL;
        value = (value | value << 4) & 0x10C30C30C30C30C3ULL;
        return (value | value << 2) & 0x1249249249249249ULL;
    };
    return spread(point.x) | spread(point.y) << 1 | spread(point.z) << 2;
}

}  // namespace eyrie::mesh
