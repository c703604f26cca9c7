// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/frame/frame_source.h"
#include "coordinator/stream/viewer_messages.h"

namespace eyrie::stream {

/// One browser's picks and profiles, on a thread of its own: frames do not wait for them, nor a
/// pick for a profile, which is a row of picks. The newest question of a kind replaces one that has
/// not been answered yet, and its answer one that has not been taken. All functions may be called
/// from any thread.
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
    void ask(ViewerProfile profile);
    /// A ViewerResponse with a ViewerPicked or a ViewerProfiled.
    std::optional<std::string> takeAnswer();

    /// Makes the thread end soon, without waiting for it.
    void stop();

private:
    /// A profile and what has been found of it.
    struct Profiling {
        ViewerProfile profile;
        std::vector<fabric::Picked> found = {};
    };

    void work();
    std::optional<std::string> takeStep(Profiling& profiling) const;

    coordinator::FrameSource& frames_;
    const std::function<void()> answered_;
    std::mutex mutex_;  ///< guards what follows, up to the thread
    std::condition_variable changed_;
    bool isStopping_ = false;
    std::optional<ViewerPick> pick_;
    std::optional<Profiling> profiling_;
    std::optional<std::string> pickAnswer_;
    std::optional<std::string> profileAnswer_;
    std::thread thread_;
};

}  // namespace eyrie::stream
