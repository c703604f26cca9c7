// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/swap_group.h"

#include <algorithm>
#include <utility>

namespace eyrie::stream {

void SwapGroup::leave(Member member) {
    members_.erase(member);
    noRoomSince_.reset();
    std::erase_if(words_, [&](const Word& word) { return word.member == member; });
    withheld(member);
}

void SwapGroup::withheld(Member member) {
    if (std::erase(swapping_, member) != 0 && swapping_.empty())
        swap_.reset();
}

int SwapGroup::behind() const {
    return static_cast<int>(
        std::ranges::count_if(members_, [](const auto& each) { return each.second.isBehind; }));
}

bool SwapGroup::isInStep(Member member) const {
    const auto known = members_.find(member);
    return known != members_.end() && !known->second.isBehind;
}

std::vector<SwapGroup::Member> SwapGroup::gather(std::span<const Candidate> candidates,
                                                 Clock::time_point now) {
    std::vector<Member> gathered;
    if (swap_)
        return gathered;
    for (const Candidate& each : candidates)
        if (each.hasRoom)
            gathered.push_back(each.member);
    if (gathered.size() == candidates.size()) {
        noRoomSince_.reset();
        return gathered;
    }
    noRoomSince_ = noRoomSince_.value_or(now);
    if (now - *noRoomSince_ < patience_)
        return {};
    for (const Candidate& each : candidates)
        if (!each.hasRoom)
            members_.at(each.member).isBehind = true;
    noRoomSince_.reset();
    return gathered;
}

void SwapGroup::begin(std::uint64_t swap, std::span<const Member> members) {
    swap_ = swap;
    swapping_.assign(members.begin(), members.end());
    for (const Member member : swapping_) members_.at(member).given = 0;
}

void SwapGroup::given(Member member, std::uint64_t swap, Clock::time_point now) {
    const auto known = members_.find(member);
    if (known == members_.end())
        return;  // it has left meanwhile
    State& state = known->second;
    state.given = swap;
    state.givenAt = now;
    state.isReady = false;
}

void SwapGroup::ready(Member member, std::uint64_t swap, Clock::time_point now) {
    const auto known = members_.find(member);
    if (known == members_.end())
        return;
    State& state = known->second;
    if (swap == 0 || state.given != swap || state.isReady)
        return;
    state.isReady = true;
    if (!state.isBehind)
        return;
    words_.push_back({member, swap});
    state.isBehind = now - state.givenAt > patience_;
}

bool SwapGroup::isHeldBy(Member member) const {
    const State& state = members_.at(member);
    return state.given != *swap_ || !state.isReady;
}

void SwapGroup::endSwap() {
    bool isShort = false;
    for (const Member member : swapping_) {
        if (isHeldBy(member))
            isShort = members_.at(member).isBehind = true;
        else
            words_.push_back({member, *swap_});
    }
    ++(isShort ? ended_.cutShort : ended_.together);
    swap_.reset();
    swapping_.clear();
}

std::vector<SwapGroup::Word> SwapGroup::takeWords(Clock::time_point now) {
    const bool isHeld =
        swap_ && std::ranges::any_of(swapping_, [this](Member member) { return isHeldBy(member); });
    const std::optional<Clock::time_point> last = deadline();
    if (swap_ && (!isHeld || (last && now >= *last)))
        endSwap();
    return std::exchange(words_, {});
}

/// Of a swap, nobody is late before all have been handed their pictures.
std::optional<Clock::time_point> SwapGroup::deadline() const {
    if (!swap_)
        return noRoomSince_ ? std::optional(*noRoomSince_ + patience_) : std::nullopt;
    Clock::time_point last{};
    for (const Member member : swapping_) {
        const State& state = members_.at(member);
        if (state.given != *swap_)
            return std::nullopt;
        last = std::max(last, state.givenAt);
    }
    return last + patience_;
}

SwapGroup::Ended SwapGroup::takeEnded() { return std::exchange(ended_, {}); }

}  // namespace eyrie::stream
