// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/status.h>

#include "fabric/scene.h"

namespace eyrie::coordinator {

/// What the renderer `id` at `address` says of `scene`, as anybody may read it: data have the names
/// of their objects in place of paths and addresses, and the renderer its id. A path that is a bare
/// file name says nothing of where it lies, may be a word of the text, and stays.
absl::Status forAnybody(const absl::Status& failure, const fabric::Scene& scene,
                        const std::string& id, const std::string& address);

}  // namespace eyrie::coordinator
