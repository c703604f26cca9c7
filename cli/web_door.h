// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <absl/status/statusor.h>

#include "cli/door_options.h"
#include "coordinator/coordinator.h"
#include "coordinator/http/server.h"

namespace eyrie::cli {

/// Starts the HTTP server on what --listen says, with the page that was built beside this program,
/// for whom `doors` lets in; `video` is ServerOptions::video, `limits` its limits.
/// Errors: InvalidArgument, naming --listen and a remedy.
absl::StatusOr<std::unique_ptr<http::Server>> openWebDoor(const std::string& listen,
                                                          const Doors& doors,
                                                          const video::Module* video,
                                                          const http::CrowdLimits& limits,
                                                          coordinator::Coordinator& coordinator);

/// Stops the door, and that of `coordinator` for gRPC: viewers and programs get what they have
/// asked for, for some seconds at most, after which the frames in progress are given up.
void closeWebDoor(http::Server& door, coordinator::Coordinator& coordinator);

}  // namespace eyrie::cli
