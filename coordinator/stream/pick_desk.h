// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "coordinator/frame/frame_source.h"
#include "coordinator/stream/viewer_messages.h"

namespace eyrie::stream {

/// One browser's picks, on a thread of its own: frames do not wait for them. The newest question
/// replaces one that has not been asked on yet, and its answer one that has not been taken. All
/// functions may be called from any thread.
class PickDesk {
public:
    /// Calls `answered`, on the desk's thread and without locks held, when takeAnswer() has
    /// something new. `frames` outlives the desk.
    PickDesk(coordinator::FrameSource& frames, std::function<void()> answered);

    /// Waits for the pick in progress.
    ~PickDesk();
    PickDesk(const PickDesk&) = delete;
    PickDesk& operator=(const PickDesk&) = delete;

    void ask(ViewerPick pick);
    /// A ViewerResponse with a ViewerPicked.
    std::optional<std::string> takeAnswer();

    /// Makes the thread end soon, without waiting for it.
    void stop();

private:
    void work();

    coordinator::FrameSource& frames_;
    const std::function<void()> answered_;
    std::mutex mutex_;  ///< guards what follows, up to the thread
    std::condition_variable changed_;
    bool isStopping_ = false;
    std::optional<ViewerPick> asked_;
    std::optional<std::string> answer_;
    std::thread thread_;
};

}  // namespace eyrie::stream
