// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/bench/frame_error.h"

namespace eyrie::cli::bench {

/// The first line of errors.csv.
std::string errorsCsvHead();

/// A line for each frame that was held against the source, beginning with the run's `tauPixels`.
std::string errorsCsv(double tauPixels, const MeasuredErrors& measured);

}  // namespace eyrie::cli::bench
