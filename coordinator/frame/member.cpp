// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/member.h"

#include <utility>

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::coordinator {

Member::Member(std::string id, fabric::DeviceInfo device, std::shared_ptr<ChannelRenderer> renderer,
               const PatienceOptions& patience)
    : id_(std::move(id)),
      device_(std::move(device)),
      renderer_(std::move(renderer)),
      patience_(patience),
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

std::optional<std::chrono::milliseconds> Member::patience(std::uint64_t kind) const {
    const std::lock_guard lock(mutex_);
    return patience_.limit(kind);
}

void Member::post(std::function<void()> job) {
    ++pending_;
    {
        const std::lock_guard lock(mutex_);
        jobs_.push_back(std::move(job));
    }
    changed_.notify_one();
}

void Member::leave(std::function<void()> left) {
    post([this, left = std::move(left)] {
        --pending_;
        left();
    });
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

void Member::draw(const Draw& what, DrawDone done) {
    post([this, frameData = what.frameData, task = what.task, revision = what.revision,
          kind = what.kind, patience = what.patience, timeout = what.timeout,
          done = std::move(done)] {
        const Clock::time_point started = Clock::now();
        absl::StatusOr<fabric::ChannelResult> result = drawNow(frameData, task, revision, timeout);
        if (absl::IsCancelled(result.status()))  // only retire cancels
            result = absl::UnavailableError(fmt::format("{} was given up", id_));
        const bool ok = result.ok();
        const Clock::duration taken = Clock::now() - started;
        if (ok) {
            const std::lock_guard lock(mutex_);
            patience_.record(kind, patience,
                             std::chrono::duration_cast<std::chrono::milliseconds>(taken));
        }
        if (ok)
            --pending_;
        done(std::move(result), taken);
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

std::future<absl::Status> Member::prepare(const fabric::FrameData& frameData,
                                          std::uint64_t revision,
                                          std::chrono::milliseconds timeout) {
    auto prepared = std::make_shared<std::promise<absl::Status>>();
    std::future<absl::Status> done = prepared->get_future();
    post([this, frameData, revision, timeout, prepared] {
        prepared->set_value(sendFrameData(frameData, revision, Clock::now() + timeout));
        --pending_;
    });
    return done;
}

absl::StatusOr<fabric::ProgramResult> Member::runProgram(const fabric::ChannelProgram& program,
                                                         std::uint64_t revision,
                                                         std::chrono::milliseconds timeout,
                                                         const std::stop_token& stop) {
    if (openRevision_ != revision)
        return absl::AbortedError(fmt::format("{} has opened another scene meanwhile", id_));
    return renderer_->runProgram(program, Clock::now() + timeout, stop);
}

absl::Status Member::sendFrameData(const fabric::FrameData& frameData, std::uint64_t revision,
                                   Clock::time_point deadline) {
    if (openRevision_ != revision)
        return absl::AbortedError(fmt::format("{} has opened another scene meanwhile", id_));
    if (sentVersion_ != frameData.version) {
        RETURN_IF_ERROR(renderer_->setFrameData(frameData, deadline));
        sentVersion_ = frameData.version;
    }
    return absl::OkStatus();
}

absl::StatusOr<fabric::ChannelResult> Member::drawNow(const fabric::FrameData& frameData,
                                                      const fabric::ChannelTask& task,
                                                      std::uint64_t revision,
                                                      std::chrono::milliseconds timeout) {
    const Clock::time_point deadline = Clock::now() + timeout;
    RETURN_IF_ERROR(sendFrameData(frameData, revision, deadline));
    return renderer_->render(task, deadline);
}

}  // namespace eyrie::coordinator
