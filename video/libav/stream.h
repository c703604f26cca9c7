// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "video/module.h"

namespace eyrie::video {

/// See Module::makeStream.
absl::StatusOr<std::unique_ptr<StreamEncoder>> makeStream(const StreamSettings& settings);

}  // namespace eyrie::video
