// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "service/channel_drawer.h"

namespace eyrie::service {

/// The one thread that a renderer lives on, from its creation to its end, and the queue of what it
/// is to do. Jobs run one by one, in the order posted. All functions may be called from any thread.
class GlThread {
public:
    using Job = std::function<void(ChannelDrawer&)>;

    /// Starts the thread and creates the drawer on it. Errors: what `create` says.
    static absl::StatusOr<std::unique_ptr<GlThread>> start(const DrawerFactory& create,
                                                           std::size_t maxQueuedJobs = 64);

    /// Runs the jobs still queued, then destroys the drawer, on its thread.
    ~GlThread();
    GlThread(const GlThread&) = delete;
    GlThread& operator=(const GlThread&) = delete;

    const fabric::DeviceInfo& device() const { return device_; }

    /// Every job accepted is run. ResourceExhausted when the queue is full.
    absl::Status post(Job job);

private:
    explicit GlThread(std::size_t maxQueuedJobs) : maxQueuedJobs_(maxQueuedJobs) {}
    void work(ChannelDrawer& drawer);

    const std::size_t maxQueuedJobs_;
    fabric::DeviceInfo device_;
    std::mutex mutex_;  ///< guards jobs_ and stopping_
    std::condition_variable changed_;
    std::deque<Job> jobs_;
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace eyrie::service
