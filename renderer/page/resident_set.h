// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

namespace eyrie::page {

/// Values kept within a limit in bytes that holds at all times. One thread.
///
/// Each frame ranks what it wants, 0 the most. Room for something new is made by dropping what
/// ranks below it: first what no rank was given, least recently ranked out first, then the lowest
/// ranks. So as long as the ranks stay the same the set only ever changes for the better, and
/// comes to rest: it does not thrash, however small the limit.
template <typename Key, typename Value>
class ResidentSet {
public:
    using Rank = std::uint32_t;

    explicit ResidentSet(std::uint64_t limitBytes) : limitBytes_(limitBytes) {}

    /// Null when it is not there. Valid until the next makeRoom.
    Value* find(const Key& key) {
        const auto found = entries_.find(key);
        return found == entries_.end() ? nullptr : &found->second.value;
    }
    bool contains(const Key& key) const { return entries_.contains(key); }

    /// Starts a frame: nothing has a rank.
    void beginFrame() {
        ++now_;
        victims_.clear();
        areVictimsKnown_ = false;
    }

    /// Gives what is there a rank for this frame. Ranks are given before room is made.
    void rank(const Key& key, Rank rank) {
        assert(!areVictimsKnown_);
        if (const auto found = entries_.find(key); found != entries_.end()) {
            found->second.rank =
                found->second.ranked == now_ ? std::min(found->second.rank, rank) : rank;
            found->second.ranked = now_;
        }
    }

    /// Whether `bytes` more fit after dropping what ranks below `rank`; drops it only if so.
    bool makeRoom(std::uint64_t bytes, Rank rank) {
        if (bytes_ + bytes <= limitBytes_)
            return true;
        findVictims();
        std::uint64_t freed = 0;
        std::size_t count = 0;
        while (bytes_ + bytes > limitBytes_ + freed) {
            if (count == victims_.size() || victims_[victims_.size() - 1 - count].rank <= rank)
                return false;
            freed += victims_[victims_.size() - 1 - count++].bytes;
        }
        for (; count > 0; --count) {
            entries_.erase(victims_.back().key);
            victims_.pop_back();
        }
        bytes_ -= freed;
        return true;
    }

    /// Precondition: `key` is not there, and makeRoom(bytes, rank) was true just before.
    Value& insert(const Key& key, Value value, std::uint64_t bytes, Rank rank) {
        bytes_ += bytes;
        assert(bytes_ <= limitBytes_);
        return entries_.insert_or_assign(key, Entry{std::move(value), bytes, now_, rank})
            .first->second.value;
    }

    std::uint64_t bytes() const { return bytes_; }
    std::uint64_t limitBytes() const { return limitBytes_; }
    std::size_t size() const { return entries_.size(); }

private:
    static constexpr Rank kUnranked = std::numeric_limits<Rank>::max();

    struct Entry {
        Value value;
        std::uint64_t bytes;
        std::uint64_t ranked;  ///< when it last was
        Rank rank;             ///< then
    };
    struct Victim {
        Key key;
        Rank rank;
        std::uint64_t ranked;
        std::uint64_t bytes;
    };

    /// Once a frame, and only when room is short. Ascending: the first to go is last.
    void findVictims() {
        if (std::exchange(areVictimsKnown_, true))
            return;
        for (const auto& [key, entry] : entries_)
            victims_.push_back(
                {key, entry.ranked == now_ ? entry.rank : kUnranked, entry.ranked, entry.bytes});
        std::sort(victims_.begin(), victims_.end(), [](const Victim& a, const Victim& b) {
            return a.rank != b.rank ? a.rank < b.rank : a.ranked > b.ranked;
        });
    }

    std::uint64_t limitBytes_;
    std::uint64_t bytes_ = 0;
    std::uint64_t now_ = 1;
    std::unordered_map<Key, Entry> entries_;
    bool areVictimsKnown_ = false;
    std::vector<Victim> victims_;
};

}  // namespace eyrie::page
