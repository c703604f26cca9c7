// SPDX-License-Identifier: Apache-2.0
#include "service/pick_thread.h"

#include <new>
#include <utility>

#include <fmt/format.h>

namespace eyrie::service {
namespace {

/// Picks whatever its files say that they hold.
absl::StatusOr<fabric::Picked> pickWith(const PickFunction& pick,
                                        const fabric::PickRequest& request,
                                        std::chrono::steady_clock::time_point deadline) {
    try {
        return pick(request, deadline);
    } catch (const std::bad_alloc&) {
        return absl::ResourceExhaustedError("the renderer has no memory for the pick");
    }
}

}  // namespace

PickThread::PickThread() : thread_([this] { work(); }) {}

PickThread::~PickThread() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_one();
    thread_.join();
    for (const Job& job : jobs_) job.done(absl::CancelledError("the renderer is ending"));
}

void PickThread::use(PickFunction pick) {
    const std::lock_guard lock(mutex_);
    pick_ = std::move(pick);
}

void PickThread::pick(const fabric::PickRequest& request,
                      std::chrono::steady_clock::time_point deadline, const Done& done) {
    if (const absl::Status status = post(request, deadline, done); !status.ok())
        done(status);
}

absl::Status PickThread::post(const fabric::PickRequest& request,
                              std::chrono::steady_clock::time_point deadline, const Done& done) {
    {
        const std::lock_guard lock(mutex_);
        if (!pick_)
            return absl::FailedPreconditionError("no scene is open; open one before picking");
        if (jobs_.size() >= kMaxQueued)
            return absl::ResourceExhaustedError(fmt::format(
                "the renderer has {} picks waiting already; send fewer at once", jobs_.size()));
        jobs_.push_back({pick_, request, deadline, done});
    }
    changed_.notify_one();
    return absl::OkStatus();
}

void PickThread::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
        if (stopping_)
            return;
        {
            const Job job = std::move(jobs_.front());
            jobs_.pop_front();
            lock.unlock();
            job.done(pickWith(job.pick, job.request, job.deadline));
        }  // what it holds goes here, not under the lock
        lock.lock();
    }
}

}  // namespace eyrie::service
