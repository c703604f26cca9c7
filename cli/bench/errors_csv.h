// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/bench/runs.h"

namespace eyrie::cli::bench {

/// A line for each frame that was held against the source; nothing at all where none was.
std::string errorsCsv(const std::vector<BenchRun>& runs);

}  // namespace eyrie::cli::bench
