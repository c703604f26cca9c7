// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/statusor.h>

#include "coordinator/api/programs.h"

namespace CLI {
class App;
}

namespace eyrie::cli {

/// What a coordinator may have done by other processes for who asks by its API.
struct ProgramOptions {
    int imports = 1;
    std::string importMemory = "1G";
    const CLI::App* program = nullptr;  ///< whose options are the coordinator's, not theirs
};

void addProgramOptions(CLI::App& command, ProgramOptions& options);

/// Errors: InvalidArgument (the memory).
absl::StatusOr<api::Programs> programsOf(const ProgramOptions& options);

}  // namespace eyrie::cli
