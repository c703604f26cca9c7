// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/options/completed_line.h"

namespace eyrie::cli {

/// Every option that can be set, its value, and where that came from, once the line has been
/// parsed; itself a file for --options.
std::string printedConfig(const CompletedLine& line);

}  // namespace eyrie::cli
