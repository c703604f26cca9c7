// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/workers.h"

#include <utility>

namespace eyrie::api {

Workers::Workers(std::size_t threads, std::size_t queued) : queued_(queued) {
    for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

Workers::~Workers() { stop(); }

bool Workers::post(std::function<void()> job, const void* whose) {
    {
        const std::lock_guard lock(mutex_);
        if (isStopping_ || jobs_.size() >= queued_)
            return false;
        jobs_.push_back({std::move(job), whose});
    }
    changed_.notify_one();
    return true;
}

void Workers::withdraw(const void* whose) {
    const std::lock_guard lock(mutex_);
    std::erase_if(jobs_, [&](const Job& job) { return job.whose == whose; });
}

void Workers::stop() {
    {
        const std::lock_guard lock(mutex_);
        isStopping_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_)
        if (thread.joinable())
            thread.join();
}

void Workers::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return isStopping_ || !jobs_.empty(); });
        if (jobs_.empty())
            return;
        const std::function<void()> job = std::move(jobs_.front().run);
        jobs_.pop_front();
        lock.unlock();
        job();
        lock.lock();
    }
}

}  // namespace eyrie::api
