// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Memory of this process and its children, as Linux counts it (proc(5), VmHWM).
namespace eyrie::cli::bench {

/// The most that each was resident with, added up: not less than what they took together.
std::uint64_t peakResidentBytes();

/// Peaks count from now on.
void resetPeakResidentBytes();

}  // namespace eyrie::cli::bench
