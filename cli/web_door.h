// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <absl/status/statusor.h>

#include "cli/door_options.h"
#include "coordinator/http/server.h"

namespace eyrie::cli {

/// Starts the HTTP server on what --listen says, with the page that was built beside this program,
/// for whom `doors` lets in.
/// Errors: InvalidArgument, naming --listen and a remedy.
absl::StatusOr<std::unique_ptr<http::Server>> openWebDoor(const std::string& listen,
                                                          const Doors& doors,
                                                          coordinator::FrameSource& frames);

}  // namespace eyrie::cli
