// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/status.h>

#include "fabric/channel_task.h"
#include "fabric/frame_data.h"

namespace eyrie {

/// InvalidArgument where the frame data or the task cannot be drawn, saying what is wrong.
absl::Status validateTask(const fabric::FrameData& frameData, const fabric::ChannelTask& task);

}  // namespace eyrie
