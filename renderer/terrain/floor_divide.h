// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace eyrie::terrain {

/// Quotients rounded down and up, of whatever signs. Precondition: b is not 0.
inline std::int64_t floorDivide(std::int64_t a, std::int64_t b) {
    return a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0);
}

inline std::int64_t ceilDivide(std::int64_t a, std::int64_t b) { return -floorDivide(-a, b); }

}  // namespace eyrie::terrain
