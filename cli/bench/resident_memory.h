// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Memory of this process and its children, and of the machine, as Linux counts it (proc(5): VmHWM,
/// MemAvailable).
namespace eyrie::cli::bench {

/// The most that each was resident with, added up: not less than what they took together.
std::uint64_t peakResidentBytes();

/// Peaks count from now on, and from what is in use: what was freed goes back to the system first.
void resetPeakResidentBytes();

/// What may still be taken without swapping, here or in this control group.
std::uint64_t availableBytes();

}  // namespace eyrie::cli::bench
