// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <sys/types.h>

namespace eyrie::bench {

/// What a process holds at a moment.
struct ProcessFigures {
    double seconds = 0;  ///< when, by the caller's clock
    double residentMebibytes = 0;
    int descriptors = 0;  ///< open, but for memory files
    int memoryFiles = 0;  ///< open ones (memfd_create): pictures that come from renderers
    int threads = 0;
};

/// As /proc tells; nothing when there is no such process.
std::optional<ProcessFigures> figuresOf(pid_t process, double seconds);

/// How far the least of `of` in the last third of the samples lies above the most in the first:
/// what goes up and down does not count, what is left behind time and again does. 0 where it does
/// not, or with fewer than three samples.
int growthOf(int ProcessFigures::*of, std::span<const ProcessFigures> samples);

/// MiB an hour of resident memory, by least squares. 0 with fewer than two samples.
double residentSlope(std::span<const ProcessFigures> samples);

}  // namespace eyrie::bench
