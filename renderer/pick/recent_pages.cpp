// SPDX-License-Identifier: Apache-2.0
#include "renderer/pick/recent_pages.h"

#include <algorithm>
#include <utility>

namespace eyrie::pick {

std::shared_ptr<const void> RecentPages::find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find(entries_, key, &Entry::key);
    if (found == entries_.end())
        return nullptr;
    entries_.splice(entries_.begin(), entries_, found);
    return entries_.front().value;
}

void RecentPages::keep(const Key& key, std::shared_ptr<const void> value, std::uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    if (bytes > limitBytes_ || std::ranges::find(entries_, key, &Entry::key) != entries_.end())
        return;
    entries_.push_front({key, std::move(value), bytes});
    bytes_ += bytes;
    while (bytes_ > limitBytes_) {
        bytes_ -= entries_.back().bytes;
        entries_.pop_back();
    }
}

}  // namespace eyrie::pick
