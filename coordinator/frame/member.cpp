// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/member.h"

#include <utility>

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::coordinator {

Member::Member(std::string id, fabric::DeviceInfo device, std::shared_ptr<ChannelRenderer> renderer)
    : id_(std::move(id)),
      device_(std::move(device)),
      renderer_(std::move(renderer)),
      thread_([this] { work(); }) {}

Member::~Member() {
    retire();
    thread_.join();
}

void Member::retire() {
    {
        const std::lock_guard lock(mutex_);
        retired_ = true;
    }
    renderer_->cancel();
    changed_.notify_one();
}

void Member::post(std::function<void()> job) {
    ++pending_;
    {
        const std::lock_guard lock(mutex_);
        jobs_.push_back(std::move(job));
    }
    changed_.notify_one();
}

void Member::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return retired_ || !jobs_.empty(); });
        if (jobs_.empty())
            break;
        const std::function<void()> job = std::move(jobs_.front());
        jobs_.pop_front();
        lock.unlock();
        job();
        lock.lock();
    }
    ended_ = true;
}

void Member::open(std::shared_ptr<const fabric::Scene> scene, std::uint64_t revision,
                  std::chrono::milliseconds timeout, OpenDone done) {
    post([this, scene = std::move(scene), revision, timeout, done = std::move(done)] {
        // On an error a renderer keeps the scene before, which is no use to the next frame.
        openRevision_ = 0;
        absl::StatusOr<fabric::SceneInfo> info =
            renderer_->openScene(*scene, Clock::now() + timeout);
        if (info.ok())
            openRevision_ = revision;
        --pending_;
        done(std::move(info));
    });
}

void Member::draw(const fabric::FrameData& frameData, const fabric::ChannelTask& task,
                  std::uint64_t revision, std::chrono::milliseconds timeout, DrawDone done) {
    post([this, frameData, task, revision, timeout, done = std::move(done)] {
        absl::StatusOr<fabric::ChannelResult> result = drawNow(frameData, task, revision, timeout);
        if (absl::IsCancelled(result.status()))  // only retire cancels
            result = absl::UnavailableError(fmt::format("{} was given up", id_));
        const bool ok = result.ok();
        if (ok)
            --pending_;
        done(std::move(result));
        // One that failed takes no more work before `done` has decided what becomes of it.
        if (!ok)
            --pending_;
    });
}

absl::StatusOr<fabric::Picked> Member::pick(const fabric::PickRequest& request,
                                            std::uint64_t revision,
                                            std::chrono::milliseconds timeout) {
    absl::StatusOr<fabric::Picked> picked = renderer_->pick(request, Clock::now() + timeout);
    if (openRevision_ != revision)
        return absl::AbortedError(fmt::format("{} has opened another scene meanwhile", id_));
    return picked;
}

absl::StatusOr<fabric::ChannelResult> Member::drawNow(const fabric::FrameData& frameData,
                                                      const fabric::ChannelTask& task,
                                                      std::uint64_t revision,
                                                      std::chrono::milliseconds timeout) {
    if (openRevision_ != revision)
        return absl::AbortedError(fmt::format("{} has opened another scene meanwhile", id_));
    const Clock::time_point deadline = Clock::now() + timeout;
    if (sentVersion_ != frameData.version) {
        RETURN_IF_ERROR(renderer_->setFrameData(frameData, deadline));
        sentVersion_ = frameData.version;
    }
    return renderer_->render(task, deadline);
}

}  // namespace eyrie::coordinator
