// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/member.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::coordinator {

Member::Member(std::string id, fabric::DeviceInfo device, std::shared_ptr<ChannelRenderer> renderer,
               const PatienceOptions& patience, std::string node)
    : id_(std::move(id)),
      device_(std::move(device)),
      node_(std::move(node)),
      renderer_(std::move(renderer)),
      patience_(patience) {
    for (std::thread& thread : threads_) thread = std::thread([this] { work(); });
}

Member::~Member() {
    retire();
    for (std::thread& thread : threads_) thread.join();
}

void Member::retire() {
    {
        const std::lock_guard lock(mutex_);
        retired_ = true;
    }
    renderer_->cancel();
    changed_.notify_all();
}

bool Member::isIdle() const {
    const std::lock_guard lock(mutex_);
    return !isHeld_ && jobs_.empty() && working_ < kThreads && occupants_ == 0;
}

std::optional<std::chrono::milliseconds> Member::patience(std::uint64_t kind) const {
    const std::lock_guard lock(mutex_);
    return patience_.limit(kind);
}

void Member::Hold::release() {
    if (!std::exchange(isHeld_, false))
        return;
    {
        const std::lock_guard lock(member_.mutex_);
        member_.isHeld_ = false;
    }
    member_.changed_.notify_all();
}

void Member::Hold::end() {
    release();
    if (std::exchange(hasEnded_, true))
        return;
    {
        const std::lock_guard lock(member_.mutex_);
        --member_.working_;
    }
    member_.changed_.notify_all();
}

bool Member::post(Job job) {
    {
        const std::lock_guard lock(mutex_);
        if (retired_)
            return false;
        jobs_.push_back(std::move(job));
    }
    changed_.notify_all();
    return true;
}

void Member::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return !isHeld_ && (retired_ || !jobs_.empty()); });
        if (jobs_.empty())
            break;
        const Job job = std::move(jobs_.front());
        jobs_.pop_front();
        isHeld_ = true;
        ++working_;
        lock.unlock();
        {
            Hold hold(*this);
            job(hold);
        }
        lock.lock();
    }
    ++ended_;
}

void Member::leave(std::function<void()> left) {
    post([this, left = std::move(left)](Hold& hold) {
        hold.release();  // programs may yet have to be prepared
        {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [this] {
                return retired_ || (working_ == 1 && jobs_.empty() && occupants_ == 0);
            });
        }
        hold.end();
        left();
    });
}

void Member::open(std::shared_ptr<const fabric::Scene> scene, std::uint64_t revision,
                  std::chrono::milliseconds timeout, OpenDone done) {
    wantedRevision_ = revision;
    post([this, scene = std::move(scene), revision, timeout, done = std::move(done)](Hold& hold) {
        if (wantedRevision_ != revision) {
            hold.end();
            return done(absl::CancelledError("another scene is to be opened"));
        }
        // On an error a renderer keeps the scene before, which is no use to the next frame.
        openRevision_ = 0;
        absl::StatusOr<fabric::SceneInfo> info =
            renderer_->openScene(*scene, Clock::now() + timeout);
        if (info.ok())
            openRevision_ = revision;
        hold.end();
        done(std::move(info));
    });
}

bool Member::draw(const Draw& what, DrawDone done) {
    return post([this, frameData = what.frameData, task = what.task, revision = what.revision,
                 kind = what.kind, patience = what.patience, timeout = what.timeout,
                 begins = what.begins, drawn = what.drawn, stop = what.stop,
                 done = std::move(done)](Hold& hold) {
        drawNow({frameData, task, revision, kind, patience, timeout, begins, drawn, stop}, hold,
                done);
    });
}

void Member::drawNow(const Draw& what, Hold& hold, const DrawDone& done) {
    if (what.begins && !what.begins()) {
        hold.end();
        return done(absl::CancelledError("it is not needed any more"), {});
    }
    const Clock::time_point started = Clock::now();
    Clock::duration waited{};
    absl::StatusOr<fabric::ChannelResult> result = render(what, hold, waited);
    const bool isStopped = what.stop.stop_requested() && absl::IsCancelled(result.status());
    if (absl::IsCancelled(result.status()) && !isStopped)  // by retire
        result = absl::UnavailableError(fmt::format("{} was given up", id_));
    const bool ok = result.ok();
    // What it waited for was another's. A renderer may say anything.
    const Clock::duration all = Clock::now() - started;
    const Clock::duration taken = all - std::clamp(waited, Clock::duration(), all);
    if (ok) {
        const std::lock_guard lock(mutex_);
        patience_.record(what.kind, what.patience,
                         std::chrono::duration_cast<std::chrono::milliseconds>(taken));
    }
    if (ok || isStopped)
        hold.end();
    // One that failed takes no more work before `done` has decided what becomes of it.
    done(std::move(result), taken);
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
    const bool isPosted = post([this, frameData, revision, timeout, prepared](Hold&) {
        prepared->set_value(sendFrameData(frameData, revision, Clock::now() + timeout));
    });
    if (!isPosted)
        prepared->set_value(absl::UnavailableError(fmt::format("{} was given up", id_)));
    return done;
}

std::shared_ptr<void> Member::occupy() {
    const auto add = [this](int occupants) {
        {
            const std::lock_guard lock(mutex_);
            occupants_ += occupants;
        }
        changed_.notify_all();
    };
    add(1);
    return {nullptr, [add](void*) { add(-1); }};
}

absl::StatusOr<fabric::ProgramResult> Member::runProgram(const fabric::ChannelProgram& program,
                                                         std::uint64_t revision,
                                                         std::chrono::milliseconds timeout,
                                                         const std::stop_token& stop) {
    RETURN_IF_ERROR(checkRevision(revision));
    ASSIGN_OR_RETURN(fabric::ProgramResult result,
                     renderer_->runProgram(program, Clock::now() + timeout, stop));
    RETURN_IF_ERROR(checkRevision(revision));  // another may have been opened meanwhile, and drawn
    return result;
}

absl::Status Member::checkRevision(std::uint64_t revision) const {
    if (openRevision_ != revision)
        return absl::AbortedError(fmt::format("{} has opened another scene meanwhile", id_));
    return absl::OkStatus();
}

absl::Status Member::sendFrameData(const fabric::FrameData& frameData, std::uint64_t revision,
                                   Clock::time_point deadline) {
    RETURN_IF_ERROR(checkRevision(revision));
    if (sentVersion_ != frameData.version) {
        RETURN_IF_ERROR(renderer_->setFrameData(frameData, deadline));
        sentVersion_ = frameData.version;
    }
    return absl::OkStatus();
}

absl::StatusOr<fabric::ChannelResult> Member::render(const Draw& what, Hold& hold,
                                                     Clock::duration& waited) {
    const Clock::time_point deadline = Clock::now() + what.timeout;
    RETURN_IF_ERROR(checkRevision(what.revision));
    const bool hasIt = sentVersion_ == what.frameData.version;
    const auto drawn = [&] {
        sentVersion_ = what.frameData.version;
        hold.release();
        if (what.drawn)
            what.drawn();
    };
    return renderer_->render(what.task, deadline,
                             {drawn, [&](std::chrono::nanoseconds time) { waited = time; }},
                             hasIt ? nullptr : &what.frameData, what.stop);
}

}  // namespace eyrie::coordinator
