// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/pick_desk.h"

#include <utility>

namespace eyrie::stream {

PickDesk::PickDesk(coordinator::FrameSource& frames, std::function<void()> answered)
    : frames_(frames), answered_(std::move(answered)), thread_([this] { work(); }) {}

PickDesk::~PickDesk() {
    stop();
    thread_.join();
}

void PickDesk::stop() {
    {
        const std::lock_guard lock(mutex_);
        isStopping_ = true;
    }
    changed_.notify_all();
}

void PickDesk::ask(ViewerPick pick) {
    {
        const std::lock_guard lock(mutex_);
        asked_ = std::move(pick);
    }
    changed_.notify_all();
}

std::optional<std::string> PickDesk::takeAnswer() {
    const std::lock_guard lock(mutex_);
    return std::exchange(answer_, std::nullopt);
}

void PickDesk::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return isStopping_ || asked_.has_value(); });
        if (isStopping_)
            return;
        const ViewerPick pick = *std::exchange(asked_, std::nullopt);
        lock.unlock();
        std::string answer = pickedMessage(
            pick.sequence, pick.request.ok() ? frames_.pick(*pick.request) : pick.request.status());
        lock.lock();
        answer_ = std::move(answer);
        if (isStopping_)
            return;
        lock.unlock();
        answered_();
        lock.lock();
    }
}

}  // namespace eyrie::stream
