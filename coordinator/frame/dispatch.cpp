// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/dispatch.h"

#include <algorithm>
#include <utility>

#include <spdlog/spdlog.h>

#include "fabric/status.h"

namespace eyrie::coordinator {
namespace {

/// How often a dispatch looks for renderers that have become free or late.
constexpr std::chrono::milliseconds kLookAgain{20};

}  // namespace

Dispatch::Dispatch(Plan plan) : plan_(std::move(plan)), parts_(plan_.tasks.size()) {}

absl::StatusOr<std::vector<Dispatch::Drawn>> Dispatch::run(Crew& crew) {
    std::unique_lock lock(mutex_);
    while (!isDone()) {
        RETURN_IF_ERROR(assign(crew));
        changed_.wait_for(lock, kLookAgain);
    }
    std::vector<Drawn> drawn;
    for (Part& part : parts_) drawn.push_back(std::move(part.drawn));
    return drawn;
}

bool Dispatch::isDone() const {
    return std::all_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.done; });
}

absl::Status Dispatch::assign(Crew& crew) {
    const std::vector<std::shared_ptr<Member>> members = crew.ready(plan_.sceneRevision);
    for (std::size_t i = 0; i < parts_.size(); ++i)
        if (!parts_[i].done && (parts_[i].running == 0 || Clock::now() >= parts_[i].late))
            RETURN_IF_ERROR(assign(i, members, crew));
    return absl::OkStatus();
}

absl::Status Dispatch::assign(std::size_t index,
                              const std::vector<std::shared_ptr<Member>>& members, Crew& crew) {
    Part& part = parts_[index];
    Member* chosen = nullptr;
    bool anyLeft = part.running != 0;
    for (const std::shared_ptr<Member>& member : members) {
        if (std::find(part.asked.begin(), part.asked.end(), member->id()) != part.asked.end())
            continue;
        anyLeft = true;
        // One that has finished its part already must not take the next one's part, too: each
        // renderer is to keep to its own share of the data, which it has in memory.
        if (member->isIdle() && (chosen == nullptr || timesAsked(*member) < timesAsked(*chosen)))
            chosen = member.get();
    }
    if (chosen == nullptr)
        return anyLeft ? absl::OkStatus() : part.error;
    if (!part.asked.empty())
        spdlog::warn("frame {}: {} draws the part that {} {}", plan_.tasks[index].frameNumber,
                     chosen->id(), part.asked.back(),
                     part.running != 0 ? "has not finished" : "could not draw");
    start(index, *chosen, crew);
    return absl::OkStatus();
}

std::ptrdiff_t Dispatch::timesAsked(const Member& member) const {
    std::ptrdiff_t times = 0;
    for (const Part& part : parts_)
        times += std::count(part.asked.begin(), part.asked.end(), member.id());
    return times;
}

void Dispatch::start(std::size_t index, Member& member, Crew& crew) {
    Part& part = parts_[index];
    ++part.running;
    part.asked.push_back(member.id());
    const Clock::time_point now = Clock::now();
    part.late = now + plan_.lateAfter;
    member.draw(plan_.frameData, plan_.tasks[index], plan_.sceneRevision, plan_.callTimeout,
                [self = shared_from_this(), index, &member, &crew,
                 now](absl::StatusOr<fabric::ChannelResult> result) {
                    if (!result.ok())  // even when the dispatch has ended without it
                        crew.noteFailure(member.id(), result.status());
                    self->finish(index, member, now, std::move(result));
                });
}

void Dispatch::finish(std::size_t index, const Member& member, Clock::time_point started,
                      absl::StatusOr<fabric::ChannelResult> result) {
    const auto taken =
        std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - started);
    {
        const std::lock_guard lock(mutex_);
        Part& part = parts_[index];
        --part.running;
        if (!result.ok()) {
            part.error = result.status();
        } else if (!part.done) {
            part.done = true;
            part.drawn = {*std::move(result), member.device(), taken};
        }
    }
    changed_.notify_one();
}

}  // namespace eyrie::coordinator
