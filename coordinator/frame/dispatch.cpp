// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/dispatch.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "fabric/log.h"
#include "fabric/status.h"

namespace eyrie::coordinator {
namespace {

/// How often a dispatch looks for renderers that have become free or late.
constexpr std::chrono::milliseconds kLookAgain{20};

/// Null when it is not there any more.
Member* memberOf(const std::string& id, const std::vector<std::shared_ptr<Member>>& members) {
    const auto found = std::ranges::find(members, id, [](const auto& one) { return one->id(); });
    return found == members.end() ? nullptr : found->get();
}

}  // namespace

Dispatch::Dispatch(Plan plan) : plan_(std::move(plan)), parts_(plan_.tasks.size()) {}

absl::StatusOr<std::vector<Dispatch::Drawn>> Dispatch::run(Crew& crew) {
    const std::stop_callback wake(plan_.stop, [this] {
        { const std::lock_guard lock(mutex_); }
        changed_.notify_one();
    });
    std::unique_lock lock(mutex_);
    absl::Status status = assignUnlessStopped(crew);
    plan_.handedOut();
    while (status.ok() && !isDone()) {
        if (std::exchange(someAreLate_, false)) {
            lock.unlock();
            crew.noteLateness();
            lock.lock();
        } else {
            changed_.wait_until(lock, nextLook());
        }
        status = assignUnlessStopped(crew);
    }
    hasEnded_ = true;
    if (!status.ok() && !plan_.stop.stop_requested())
        giveUp(crew.ready(plan_.sceneRevision));
    if (std::exchange(someAreLate_, false)) {
        lock.unlock();
        crew.noteLateness();
    }
    RETURN_IF_ERROR(status);
    std::vector<Drawn> drawn;
    for (Part& part : parts_) drawn.push_back(std::move(part.drawn));
    return drawn;
}

bool Dispatch::isDone() const {
    return std::all_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.done; });
}

Dispatch::Clock::time_point Dispatch::nextLook() const {
    const Clock::time_point now = Clock::now();
    Clock::time_point next = now + kLookAgain;
    for (const Part& part : parts_)
        if (!part.done && isLastAtWork(part) && part.hasBegun && part.late > now)
            next = std::min(next, part.late);
    return next;
}

absl::Status Dispatch::assignUnlessStopped(Crew& crew) {
    if (plan_.stop.stop_requested())
        return absl::CancelledError("nobody wants this frame any more");
    return assign(crew);
}

absl::Status Dispatch::assign(Crew& crew) {
    const Members members = crew.ready(plan_.sceneRevision);
    const std::vector<std::string>* waiting = nullptr;  // the queue whose takers are all busy
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        Part& part = parts_[i];
        const std::vector<std::string>* const queue = part.asked.empty() ? queueOf(i) : nullptr;
        if (part.done || (!part.atWork.empty() && !isOverdue(part, members)) ||
            (queue != nullptr && queue == waiting))
            continue;
        RETURN_IF_ERROR(assign(i, members, crew));
        if (part.asked.empty())
            waiting = queue;
    }
    return absl::OkStatus();
}

absl::Status Dispatch::assign(std::size_t index, const Members& members, Crew& crew) {
    Part& part = parts_[index];
    Member* chosen = preferredOf(index, members);
    if (chosen != nullptr && part.asked.empty() && queueOf(index) != nullptr && !chosen->isIdle())
        return absl::OkStatus();  // whoever of its takers is free first has it
    if (chosen == nullptr)
        chosen = idleOf(part, members);
    if (chosen == nullptr) {
        const bool anyLeft = !part.atWork.empty() ||
                             std::any_of(members.begin(), members.end(), [&](const auto& member) {
                                 return !wasAsked(part, *member);
                             });
        return anyLeft ? absl::OkStatus() : part.error;
    }
    if (!part.asked.empty())
        noteReissue(index, *chosen, members);
    start(index, *chosen, members, crew);
    return absl::OkStatus();
}

bool Dispatch::wasAsked(const Part& part, const Member& member) const {
    return std::find(part.asked.begin(), part.asked.end(), member.id()) != part.asked.end();
}

bool Dispatch::isLastAtWork(const Part& part) {
    return !part.asked.empty() &&
           std::ranges::find(part.atWork, part.asked.back()) != part.atWork.end();
}

/// The renderer that was asked last could not draw it, takes longer than it may, or does not come
/// to it.
bool Dispatch::isOverdue(const Part& part, const Members& members) const {
    if (!isLastAtWork(part))
        return true;
    if (part.hasBegun)
        return Clock::now() >= part.late;
    return std::ranges::any_of(members, [&](const auto& member) {
        return member->id() == part.asked.back() && member->isLate();
    });
}

const std::vector<std::string>* Dispatch::queueOf(std::size_t index) const {
    const auto& queueOf = plan_.takers.queueOf;
    return index < queueOf.size() && queueOf[index] ? &plan_.takers.queues[*queueOf[index]]
                                                    : nullptr;
}

/// One that is free, or one that will be; null when nobody is worth waiting for.
Member* Dispatch::takerOf(std::size_t index, const std::vector<std::string>& takers,
                          const Members& members) const {
    Member* busy = nullptr;
    for (const std::string& taker : takers) {
        Member* const member = memberOf(taker, members);
        if (member == nullptr || wasAsked(parts_[index], *member) || member->isLate())
            continue;
        if (member->isIdle())
            return member;
        if (busy == nullptr)
            busy = member;
    }
    return busy;
}

/// Null when there is none, or it is not worth waiting for.
Member* Dispatch::preferredOf(std::size_t index, const Members& members) const {
    if (const auto* const takers = queueOf(index))
        return takerOf(index, *takers, members);
    if (index >= plan_.takers.preferred.size())
        return nullptr;
    Member* const member = memberOf(plan_.takers.preferred[index], members);
    return member == nullptr || wasAsked(parts_[index], *member) || member->isLate() ? nullptr
                                                                                     : member;
}

/// One that has finished its part already must not take the next one's part, too: each renderer is
/// to keep to its own share of the data, which it has in memory.
Member* Dispatch::idleOf(const Part& part, const Members& members) const {
    Member* chosen = nullptr;
    for (const std::shared_ptr<Member>& member : members)
        if (member->isIdle() && !member->isLate() && !wasAsked(part, *member) &&
            (chosen == nullptr || timesAsked(*member) < timesAsked(*chosen)))
            chosen = member.get();
    return chosen;
}

std::ptrdiff_t Dispatch::timesAsked(const Member& member) const {
    std::ptrdiff_t times = 0;
    for (const Part& part : parts_)
        times += std::count(part.asked.begin(), part.asked.end(), member.id());
    return times;
}

std::chrono::milliseconds Dispatch::patienceWith(const Member& member,
                                                 const Members& members) const {
    if (const auto own = member.patience(plan_.kind))
        return *own;
    std::optional<std::chrono::milliseconds> slowest;
    for (const std::shared_ptr<Member>& other : members)
        slowest = std::max(slowest, other->patience(plan_.kind));
    return slowest.value_or(plan_.firstPatience);
}

void Dispatch::noteReissue(std::size_t index, const Member& chosen, const Members& members) {
    Part& part = parts_[index];
    spdlog::warn("frame {}: {} draws the part that {} {}", plan_.tasks[index].frameNumber,
                 chosen.id(), part.asked.back(),
                 !isLastAtWork(part) ? "could not draw"
                 : part.hasBegun     ? "has not finished"
                                     : "has not begun");
    if (plan_.telemetry)
        plan_.telemetry->metrics.taskReissued(isLastAtWork(part));
    noteLate(part, members);
}

/// The one that was asked for `part` last is, if it is at work on it.
void Dispatch::noteLate(Part& part, const Members& members) {
    if (!isLastAtWork(part) || !part.hasBegun)
        return;
    for (const std::shared_ptr<Member>& member : members)
        if (member->id() == part.asked.back() &&
            std::ranges::find(part.slow, member->id()) == part.slow.end()) {
            part.slow.push_back(member->id());
            someAreLate_ |= member->addLate();
        }
}

/// There will be no frame: those at work on it are not to be waited for by the next.
void Dispatch::giveUp(const Members& members) {
    for (Part& part : parts_)
        if (!part.done)
            noteLate(part, members);
}

void Dispatch::start(std::size_t index, Member& member, const Members& members, Crew& crew) {
    Part& part = parts_[index];
    part.hasBegun = false;
    part.asked.push_back(member.id());
    part.atWork.push_back(member.id());
    const std::chrono::milliseconds patience = patienceWith(member, members);
    const auto self = shared_from_this();
    const bool isAsked = member.draw(
        {plan_.frameData, plan_.tasks[index], plan_.sceneRevision, plan_.kind, patience,
         plan_.callTimeout,
         [self, index, &member, patience] { return self->begin(index, member, patience); },
         plan_.freed, plan_.stop},
        [self, index, &member, &crew](absl::StatusOr<fabric::ChannelResult> result,
                                      Clock::duration taken) {
            if (!result.ok())  // even when the dispatch has ended without it
                crew.noteFailure(member.id(), result.status());
            const bool isLateNoMore = self->finish(index, member, std::move(result), taken);
            self->plan_.freed();
            if (isLateNoMore)
                crew.noteLateness();
        });
    if (isAsked)
        return;
    part.atWork.pop_back();  // it has ended since the crew was asked
    part.error = absl::UnavailableError(fmt::format("{} was given up", member.id()));
}

/// False when it need not.
bool Dispatch::begin(std::size_t index, const Member& member, std::chrono::milliseconds patience) {
    {
        const std::lock_guard lock(mutex_);
        Part& part = parts_[index];
        if (hasEnded_ || part.done || plan_.stop.stop_requested())
            return false;
        if (part.asked.back() == member.id()) {
            part.hasBegun = true;
            part.late = Clock::now() + patience;
        }
    }
    changed_.notify_one();
    return true;
}

/// Returns whether `member` was late and is so no more.
bool Dispatch::finish(std::size_t index, Member& member,
                      absl::StatusOr<fabric::ChannelResult> result, Clock::duration taken) {
    bool isLateNoMore = false;
    {
        const std::lock_guard lock(mutex_);
        Part& part = parts_[index];
        std::erase(part.atWork, member.id());
        isLateNoMore = std::erase(part.slow, member.id()) != 0 && member.removeLate();
        if (!result.ok()) {
            part.error = result.status();
        } else if (!part.done) {
            part.done = true;
            part.drawn = {*std::move(result), member.device(), taken, member.id()};
        }
    }
    changed_.notify_one();
    return isLateNoMore;
}

}  // namespace eyrie::coordinator
