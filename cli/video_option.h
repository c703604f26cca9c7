// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>

#include "video/module.h"

namespace eyrie::cli {

/// --h264.
void addVideoOption(CLI::App& command, bool& isAsked);

/// The module for video where it is asked for, null where it is not. Errors: those of video::load,
/// naming the option.
absl::StatusOr<const video::Module*> videoModule(bool isAsked);

}  // namespace eyrie::cli
