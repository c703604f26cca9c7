// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <list>
#include <unordered_map>
#include <utility>

namespace eyrie::page {

/// Values kept up to a limit in bytes, least recently used out first. One thread.
///
/// What was used since the last call of `trim` stays whatever the limit: a frame's own working set
/// is never thrown out under it.
template <typename Key, typename Value>
class LruCache {
public:
    explicit LruCache(std::uint64_t limitBytes) : limitBytes_(limitBytes) {}

    /// The value, now the most recently used; null when it is not there. Stays valid until trim.
    Value* find(const Key& key) {
        const auto it = index_.find(key);
        if (it == index_.end())
            return nullptr;
        entries_.splice(entries_.begin(), entries_, it->second);
        it->second->lastUse = now_;
        return &it->second->value;
    }

    /// Precondition: `key` is not there.
    Value& insert(const Key& key, Value value, std::uint64_t bytes) {
        entries_.push_front({key, std::move(value), bytes, now_});
        index_.emplace(key, entries_.begin());
        bytes_ += bytes;
        return entries_.front().value;
    }

    /// Ends a frame: drops what has not been used longest until the limit holds.
    void trim() {
        while (bytes_ > limitBytes_ && !entries_.empty() && entries_.back().lastUse != now_) {
            bytes_ -= entries_.back().bytes;
            index_.erase(entries_.back().key);
            entries_.pop_back();
        }
        ++now_;
    }

    std::uint64_t bytes() const { return bytes_; }
    std::size_t size() const { return index_.size(); }

private:
    struct Entry {
        Key key;
        Value value;
        std::uint64_t bytes;
        std::uint64_t lastUse;
    };

    std::uint64_t limitBytes_;
    std::uint64_t bytes_ = 0;
    std::uint64_t now_ = 1;
    std::list<Entry> entries_;  // most recently used first
    std::unordered_map<Key, typename std::list<Entry>::iterator> index_;
};

}  // namespace eyrie::page
