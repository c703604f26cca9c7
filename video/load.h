// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "video/module.h"

namespace eyrie::video {

/// The module for video, from lib/eyrie beside the bin folder that this program is in; loaded once,
/// and there until the process ends. FailedPrecondition, with the remedy, where it is missing,
/// lacks a library, or belongs to another version of Eyrie.
absl::StatusOr<const Module*> load();

}  // namespace eyrie::video
