// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

/// Memory of this process and its children, and of the machine, as Linux counts it (proc(5): VmHWM,
/// MemAvailable).
namespace eyrie::cli::bench {

/// The most that each was resident with, added up: not less than what they took together.
std::uint64_t peakResidentBytes();

/// Peaks count from now on, and from what is in use: what was freed goes back to the system first.
void resetPeakResidentBytes();

/// What may still be taken without swapping, here or in this control group.
std::uint64_t availableBytes();

/// What is left of the limit of a control group of either version, whose files are in `folder`,
/// which ends with a slash; what it holds of files that may be dropped is left, too. The largest
/// number where there is no limit.
std::uint64_t leftInControlGroup(const std::string& folder);

}  // namespace eyrie::cli::bench
