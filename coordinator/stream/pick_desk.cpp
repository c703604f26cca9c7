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
        pick_ = std::move(pick);
    }
    changed_.notify_all();
}

void PickDesk::ask(ViewerProfile profile) {
    {
        const std::lock_guard lock(mutex_);
        profiling_ = Profiling{std::move(profile)};
    }
    changed_.notify_all();
}

std::optional<std::string> PickDesk::takeAnswer() {
    const std::lock_guard lock(mutex_);
    if (pickAnswer_)
        return std::exchange(pickAnswer_, std::nullopt);
    return std::exchange(profileAnswer_, std::nullopt);
}

/// Picks the next point of a profile; the answer once that was the last, or when one fails.
std::optional<std::string> PickDesk::takeStep(Profiling& profiling) const {
    const auto& [sequence, line] = profiling.profile;
    if (!line.ok())
        return profiledMessage(sequence, line.status());
    const absl::StatusOr<fabric::Box> bounds = profiledBounds(frames_.status());
    if (!bounds.ok())
        return profiledMessage(sequence, bounds.status());
    const absl::StatusOr<fabric::Picked> picked =
        frames_.pick(pickFromAbove(*line, static_cast<int>(profiling.found.size()), *bounds));
    if (!picked.ok())
        return profiledMessage(sequence, picked.status());
    profiling.found.push_back(*picked);
    if (std::ssize(profiling.found) < line->samples)
        return std::nullopt;
    return profiledMessage(sequence, profiling.found);
}

void PickDesk::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return isStopping_ || pick_ || profiling_; });
        if (isStopping_)
            return;
        const std::optional<ViewerPick> pick = std::exchange(pick_, std::nullopt);
        std::optional<Profiling> profiling =
            pick ? std::nullopt : std::exchange(profiling_, std::nullopt);
        lock.unlock();
        std::optional<std::string> answer =
            pick ? pickedMessage(pick->sequence, pick->request.ok() ? frames_.pick(*pick->request)
                                                                    : pick->request.status())
                 : takeStep(*profiling);
        lock.lock();
        if (isStopping_)
            return;
        if (!answer) {
            // Goes on after a pick, unless another profile has been asked for.
            if (!profiling_)
                profiling_ = std::move(profiling);
            continue;
        }
        (pick ? pickAnswer_ : profileAnswer_) = std::move(answer);
        lock.unlock();
        answered_();
        lock.lock();
    }
}

}  // namespace eyrie::stream
