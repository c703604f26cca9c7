// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <absl/status/status.h>

#include "cli/progress_bar.h"

namespace CLI {
class App;
}

/// What `eyrie import terrain` and `eyrie import mesh` have in common.
namespace eyrie::cli {

struct ImportOptions {
    std::vector<std::string> sources;
    std::string out;
    bool quiet = false;
    bool json = false;
    bool progressJson = false;
};

/// How progress is told.
ProgressBar::Style progressStyle(const ImportOptions& options);

/// InvalidArgument unless the output's name has `ending`, such as ".eyt".
absl::Status checkEnding(const ImportOptions& options, std::string_view ending);

/// Declares those that are the same for both.
void addCommonOptions(CLI::App& command, ImportOptions& options);

}  // namespace eyrie::cli
