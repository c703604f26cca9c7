// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace eyrie::api {

/// Threads that do jobs in the order in which they were given. Any thread may call.
class Workers {
public:
    /// At most `queued` jobs wait.
    Workers(std::size_t threads, std::size_t queued);
    /// As stop().
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    /// False, and nothing is done, when too many wait or after stop().
    bool post(std::function<void()> job);

    /// Does what waits, and returns when all is done. May be called twice, but not by a job.
    void stop();

private:
    void work();

    const std::size_t queued_;
    std::mutex mutex_;  ///< guards jobs_ and isStopping_
    std::condition_variable changed_;
    std::deque<std::function<void()>> jobs_;
    bool isStopping_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace eyrie::api
