// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/statusor.h>

#include "coordinator/config/configuration.h"
#include "coordinator/config/findings.h"

namespace eyrie::cli {

/// Whether a configuration by this name is JSON; otherwise it is .eqc.
inline bool isJson(const std::string& path) { return path.ends_with(".json"); }

/// What `path` holds; what is wrong in it is in `findings`, and then the configuration is not to be
/// used. Errors: those of readText; InvalidArgument: it is no regular file.
absl::StatusOr<config::Configuration> readConfiguration(const std::string& path,
                                                        config::Findings& findings);

}  // namespace eyrie::cli
