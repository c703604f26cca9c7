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
    int descriptors = 0;
    int threads = 0;
};

/// As /proc tells; nothing when there is no such process.
std::optional<ProcessFigures> figuresOf(pid_t process, double seconds);

/// How much `of` grew from the lowest of the first half of the samples to the lowest of the second:
/// what is held for a while only does not count. 0 with fewer than two samples.
int growthOf(int ProcessFigures::*of, std::span<const ProcessFigures> samples);

/// MiB an hour of resident memory, by least squares. 0 with fewer than two samples.
double residentSlope(std::span<const ProcessFigures> samples);

}  // namespace eyrie::bench
