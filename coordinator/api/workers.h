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

    /// False, and nothing is done, when too many wait or after stop(). `whose` is for withdraw().
    bool post(std::function<void()> job, const void* whose = nullptr);

    /// Forgets what was posted with that `whose` and has not begun: it waits no longer.
    void withdraw(const void* whose);

    /// Does what waits, and returns when all is done. May be called twice, but not by a job.
    void stop();

private:
    struct Job {
        std::function<void()> run;
        const void* whose = nullptr;
    };
    void work();

    const std::size_t queued_;
    std::mutex mutex_;  ///< guards jobs_ and isStopping_
    std::condition_variable changed_;
    std::deque<Job> jobs_;
    bool isStopping_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace eyrie::api
