// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "service/channel_drawer.h"

namespace eyrie::service {

/// Where picks are made, beside the frames: reading pages may take long, and no frame is to wait
/// for it. One after the other, in the order asked. All functions may be called from any thread.
class PickThread {
public:
    using Done = std::function<void(absl::StatusOr<fabric::Picked>)>;

    static constexpr std::size_t kMaxQueued = 16;

    PickThread();
    /// Answers what is still queued with Cancelled.
    ~PickThread();
    PickThread(const PickThread&) = delete;
    PickThread& operator=(const PickThread&) = delete;

    /// What later picks are made with: of the scene that is open now.
    void use(PickFunction pick);

    /// Calls `done` once, mostly on the thread. FailedPrecondition without a scene,
    /// ResourceExhausted when too many wait, DeadlineExceeded, what the function says.
    void pick(const fabric::PickRequest& request, std::chrono::steady_clock::time_point deadline,
              const Done& done);

private:
    struct Job {
        PickFunction pick;
        fabric::PickRequest request;
        std::chrono::steady_clock::time_point deadline;
        Done done;
    };

    absl::Status post(const fabric::PickRequest& request,
                      std::chrono::steady_clock::time_point deadline, const Done& done);
    void work();

    std::mutex mutex_;  ///< guards what follows, up to the thread
    std::condition_variable changed_;
    PickFunction pick_;
    std::deque<Job> jobs_;
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace eyrie::service
