// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "coordinator/stream/pacer.h"

namespace eyrie::stream {

/// The viewers of a session whose screens share a swap barrier: nobody sees a picture before all
/// who are in step have it. A swap gives each of them its part of one picture, waits until all say
/// that they have decoded it, and then gives all the word to show it; until then none of them is
/// given another.
///
/// Who is not ready within the patience is behind, and not waited for: it gets pictures by itself,
/// and is in step again from the next swap on once it has been ready within the patience. So one
/// that stalls holds the others up once, for so long; one that leaves, not at all. Not thread-safe.
class SwapGroup {
public:
    using Member = std::uint64_t;

    explicit SwapGroup(Clock::duration patience) : patience_(patience) {}

    void join(Member member) { members_[member]; }
    void leave(Member member);

    int size() const { return static_cast<int>(members_.size()); }
    int behind() const;
    bool isInStep(Member member) const;

    /// While this is so, who is in step is to be given nothing else.
    bool isSwapping() const { return swap_.has_value(); }

    /// Who would be given a picture now, and whether it has room for one.
    struct Candidate {
        Member member = 0;
        bool hasRoom = false;
    };
    /// Those of `candidates`, who are in step, with whom a swap can begin: all of them, or nobody
    /// while one has no room, until that has been so for the patience: then it is behind. Nobody
    /// while a swap is under way.
    std::vector<Member> gather(std::span<const Candidate> candidates, Clock::time_point now);

    /// `members`, who are in step, are going to be given the picture of `swap`; not 0.
    void begin(std::uint64_t swap, std::span<const Member> members);
    /// It has been handed over: to one of a swap, or to one that is behind.
    void given(Member member, std::uint64_t swap, Clock::time_point now);
    /// It will not be given the picture of the swap that is under way.
    void withheld(Member member);
    /// The member has decoded its picture of `swap`. Of another than it was given, or said twice,
    /// it counts for nothing.
    void ready(Member member, std::uint64_t swap, Clock::time_point now);

    /// Who is to show its picture of which swap now; each once.
    struct Word {
        Member member = 0;
        std::uint64_t swap = 0;

        bool operator==(const Word&) const = default;
    };
    std::vector<Word> takeWords(Clock::time_point now);

    /// When gather() or takeWords() may have somebody although nobody does anything.
    std::optional<Clock::time_point> deadline() const;

    /// Swaps that have ended since this was asked last: all who were given a picture have shown it
    /// together, or without those that fell behind.
    struct Ended {
        int together = 0;
        int cutShort = 0;
    };
    Ended takeEnded();

private:
    struct State {
        std::uint64_t given = 0;  ///< the swap of its last picture; 0: none
        Clock::time_point givenAt = {};
        bool isReady = false;  ///< for that
        bool isBehind = false;
    };

    bool isHeldBy(Member member) const;
    void endSwap();

    const Clock::duration patience_;
    std::map<Member, State> members_;
    std::optional<std::uint64_t> swap_;             ///< that is under way
    std::vector<Member> swapping_;                  ///< whom it is for
    std::optional<Clock::time_point> noRoomSince_;  ///< that a swap could have begun with
    std::vector<Word> words_;                       ///< of those that are behind
    Ended ended_;
};

}  // namespace eyrie::stream
