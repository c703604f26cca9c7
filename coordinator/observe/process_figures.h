// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace eyrie::observe {

/// What the system says of this process.
struct ProcessFigures {
    double cpuSeconds = 0;  ///< user and system
    std::uint64_t residentBytes = 0;
    std::uint64_t virtualBytes = 0;
    std::uint64_t openFiles = 0;
    std::uint64_t threads = 0;
};

/// From /proc; zeros where that cannot be read.
ProcessFigures processFigures();

}  // namespace eyrie::observe
