// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <stop_token>
#include <string>

#include <absl/status/statusor.h>

#include "cli/cache_options.h"
#include "cli/scene_files.h"

namespace eyrie::cli {

/// The scene that `paths` name, as for assembleScene; sources are imported first. Of no paths one
/// without objects: what is shown is for programs to say. Unless `isQuiet`, progress and what is to
/// be said of sources and scene go to standard error. Errors: those of assembleScene; Cancelled.
absl::StatusOr<NamedScene> loadScene(std::span<const std::string> paths,
                                     const CacheOptions& options, bool isQuiet,
                                     const std::stop_token& stop);

}  // namespace eyrie::cli
