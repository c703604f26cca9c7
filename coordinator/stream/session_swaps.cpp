// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "coordinator/stream/session_impl.h"
#include "coordinator/stream/swap_barrier.h"

namespace eyrie::stream {
/// Of those whose screens share a barrier; null where it is shown behind none, or alone.
const SwapGroup* Session::Impl::groupOf(const Seat& seat) const {
    const auto group = groups_.find(seat.barrier);
    return group == groups_.end() || group->second.size() < 2 ? nullptr : &group->second;
}

bool Session::Impl::isInSwap(const Seat& seat) const {
    const auto group = groups_.find(seat.barrier);
    return group != groups_.end() && group->second.isSwapping() && group->second.isInStep(seat.id);
}

/// There is something that it gets together with others.
bool Session::Impl::awaitsSwap(const Seat& seat) const {
    const SwapGroup* const group = groupOf(seat);
    return isInSwap(seat) || (group != nullptr && group->isInStep(seat.id) && !hasNewest(seat));
}

bool Session::Impl::hasNewest(const Seat& seat) const {
    return progress_.newest() != nullptr && seat.delivered.picture == progress_.newest()->number;
}

/// What it keeps for a word that will not come is shown now.
void Session::Impl::leaveGroup(Seat& seat) {
    const auto group = groups_.find(std::exchange(seat.barrier, ""));
    if (group == groups_.end())
        return;
    group->second.leave(seat.id);
    seat.outbox.putWord(swapMessage(seat.delivered.picture));
    if (group->second.size() == 0)
        groups_.erase(group);
}

/// Each seat joins those behind its barrier.
void Session::Impl::arrangeGroups() {
    if (!source_ || !progress_.wanted())
        return;
    for (const auto& seat : seats_) {
        const auto shown = seat->shown(progress_.wanted()->frame.shown.front());
        const std::string barrier = shown ? swapBarrierOf(source_->canvases, *shown) : "";
        if (barrier == seat->barrier)
            continue;
        leaveGroup(*seat);
        seat->barrier = barrier;
        if (!barrier.empty())
            groups_.try_emplace(barrier, swapPatience_).first->second.join(seat->id);
        isStateStale_ = true;
    }
}

/// Puts out the words that a group has to say now; returns who is to be told.
Seats Session::Impl::sayWords(SwapGroup& group) {
    Seats told;
    for (const SwapGroup::Word& word : group.takeWords(Clock::now()))
        for (const auto& seat : seats_)
            if (seat->id == word.member) {
                seat->outbox.putWord(swapMessage(word.swap));
                told.push_back(seat);
            }
    const SwapGroup::Ended ended = group.takeEnded();
    if (telemetry_ != nullptr)
        telemetry_->metrics.swapped(ended.together, ended.cutShort);
    return told;
}

/// True where somebody was told, and the lock given up for it.
bool Session::Impl::endLateSwaps(std::unique_lock<std::mutex>& lock) {
    bool isAny = false;
    for (auto& [name, group] : groups_) {
        const int behind = group.behind();
        isAny = !sayWords(group).empty() || isAny;
        isStateStale_ = isStateStale_ || behind != group.behind();
    }
    if (isAny)
        tell(lock);
    return isAny;
}

std::optional<Clock::time_point> Session::Impl::deadline() const {
    std::optional<Clock::time_point> first;
    for (const auto& [name, group] : groups_) first = sooner(first, group.deadline());
    return first;
}

std::shared_ptr<Session::Impl::Swap> Session::Impl::nextSwap(Clock::time_point now) {
    for (auto& [barrier, group] : groups_)
        if (group.size() >= 2 && !group.isSwapping())
            if (auto swap = swapOf(barrier, group, now))
                return swap;
    return nullptr;
}

/// Of the newest picture, with all in step that lack it; null while it is not of all screens.
std::shared_ptr<Session::Impl::Swap> Session::Impl::swapOf(const std::string& barrier,
                                                           SwapGroup& group,
                                                           Clock::time_point now) {
    const std::shared_ptr<const Picture> picture = progress_.newest();
    if (picture == nullptr)
        return nullptr;
    std::vector<SwapGroup::Candidate> candidates;
    auto swap = std::make_shared<Swap>(Swap{picture, barrier, {}});
    for (const auto& seat : seats_) {
        if (seat->barrier != barrier || !group.isInStep(seat->id) ||
            seat->delivered.picture == picture->number)
            continue;
        const auto as = seat->movingClass(*picture);
        if (!as) {
            group.gather({}, now);
            return nullptr;
        }
        seat->outbox.dropStill();  // what is left of it is of the picture before
        candidates.push_back({seat->id, seat->outbox.hasRoom(0)});
        swap->seats.emplace_back(seat, *as);
    }
    const int behind = group.behind();
    const std::vector<SwapGroup::Member> members = group.gather(candidates, now);
    isStateStale_ = isStateStale_ || behind != group.behind();
    if (members.empty())
        return nullptr;
    std::erase_if(swap->seats, [&](const auto& each) {
        return std::ranges::find(members, each.first->id) == members.end();
    });
    group.begin(picture->number, members);
    return swap;
}

/// Encodes its picture for each class, and hands it to all of them.
void Session::Impl::serveTogether(std::unique_lock<std::mutex>& lock, const Swap& swap) {
    std::map<QualityClass, Seats> classes;
    for (const auto& [seat, as] : swap.seats) {
        seat->delivered = {swap.picture->number, as.fineness};
        seat->isServed = true;
        seat->timesPassedOver = 0;
        classes[as].push_back(seat);
    }
    for (const auto& [as, seats] : classes) {
        const auto encoded = encodingOf(lock, swap.picture, as, seats);
        if (!encoded.ok())
            setProblem(renderProblem_, problemOf(encoded.status()));
        for (const auto& seat : seats) {
            seat->isServed = false;
            const auto group = groups_.find(swap.barrier);
            if (group == groups_.end() || seat->barrier != swap.barrier)
                continue;  // it has left meanwhile
            if (encoded.ok()) {
                give(*seat, *encoded, as, *swap.picture, swap.picture->number);
                group->second.given(seat->id, swap.picture->number, Clock::now());
            } else {
                group->second.withheld(seat->id);
            }
        }
        tell(lock);
    }
}

}  // namespace eyrie::stream
