// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include <absl/status/statusor.h>

#include "fabric/channel_task.h"
#include "fabric/frame_data.h"
#include "fabric/pick.h"
#include "fabric/scene.h"

namespace eyrie::coordinator {

/// A renderer as the coordinator sees it: one behind gRPC, or one in this process.
///
/// openScene, setFrameData and render are called by one thread at a time and block; pick blocks,
/// too, but may be called beside them from any thread, as may cancel. Of errors, Unavailable and
/// DeadlineExceeded say that the renderer is gone.
class ChannelRenderer {
public:
    using Clock = std::chrono::steady_clock;

    virtual ~ChannelRenderer() = default;

    virtual absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene& scene,
                                                        Clock::time_point deadline) = 0;
    virtual absl::Status setFrameData(const fabric::FrameData& frameData,
                                      Clock::time_point deadline) = 0;
    /// The image lies inside the task's pixel viewport, fills its area, and has depth if the task
    /// wants it (and is not empty).
    virtual absl::StatusOr<fabric::ChannelResult> render(const fabric::ChannelTask& task,
                                                         Clock::time_point deadline) = 0;

    /// What a place of a picture of the open scene shows.
    virtual absl::StatusOr<fabric::Picked> pick(const fabric::PickRequest& request,
                                                Clock::time_point deadline) = 0;

    /// Ends the calls in progress, and every later one, soon, with Cancelled.
    virtual void cancel() = 0;
};

}  // namespace eyrie::coordinator
