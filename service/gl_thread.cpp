// SPDX-License-Identifier: Apache-2.0
#include "service/gl_thread.h"

#include <future>
#include <utility>

#include <fmt/format.h>

namespace eyrie::service {

absl::StatusOr<std::unique_ptr<GlThread>> GlThread::start(const DrawerFactory& create,
                                                          std::size_t maxQueuedJobs) {
    std::unique_ptr<GlThread> result(new GlThread(maxQueuedJobs));
    std::promise<absl::Status> created;
    std::future<absl::Status> status = created.get_future();
    result->thread_ =
        std::thread([self = result.get(), create, created = std::move(created)]() mutable {
            absl::StatusOr<std::unique_ptr<ChannelDrawer>> drawer = create();
            if (drawer.ok())
                self->device_ = (*drawer)->device();
            created.set_value(drawer.status());
            if (drawer.ok())
                self->work(**drawer);
        });
    if (absl::Status failed = status.get(); !failed.ok())
        return failed;
    return result;
}

GlThread::~GlThread() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_one();
    thread_.join();
}

absl::Status GlThread::post(Job job) {
    {
        const std::lock_guard lock(mutex_);
        if (jobs_.size() >= maxQueuedJobs_)
            return absl::ResourceExhaustedError(fmt::format(
                "the renderer has {} tasks waiting already; send fewer at once", jobs_.size()));
        jobs_.push_back(std::move(job));
    }
    changed_.notify_one();
    return absl::OkStatus();
}

void GlThread::work(ChannelDrawer& drawer) {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
        if (jobs_.empty())
            return;
        Job job = std::move(jobs_.front());
        jobs_.pop_front();
        lock.unlock();
        job(drawer);
        job = nullptr;  // what it holds goes here, not under the lock
        lock.lock();
    }
}

}  // namespace eyrie::service
