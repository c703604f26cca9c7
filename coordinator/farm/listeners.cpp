// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/listeners.h"

#include <algorithm>
#include <utility>

namespace eyrie::coordinator {

int Listeners::add(std::function<void()> listener) {
    auto entry = std::make_shared<Entry>();
    entry->listener = std::move(listener);
    const std::lock_guard lock(mutex_);
    entries_.emplace(nextHandle_, std::move(entry));
    return nextHandle_++;
}

void Listeners::remove(int handle) {
    std::unique_lock lock(mutex_);
    const auto found = entries_.find(handle);
    if (found == entries_.end())
        return;
    const std::shared_ptr<Entry> entry = std::move(found->second);
    entries_.erase(found);
    entry->removed = true;
    returned_.wait(lock, [&] {
        return std::all_of(entry->callers.begin(), entry->callers.end(),
                           [](std::thread::id id) { return id == std::this_thread::get_id(); });
    });
}

void Listeners::notify() {
    std::vector<std::shared_ptr<Entry>> entries;
    {
        const std::lock_guard lock(mutex_);
        for (const auto& [handle, entry] : entries_) entries.push_back(entry);
    }
    for (const std::shared_ptr<Entry>& entry : entries) call(*entry);
}

void Listeners::call(Entry& entry) {
    const std::thread::id me = std::this_thread::get_id();
    {
        const std::lock_guard lock(mutex_);
        if (entry.removed)
            return;
        entry.callers.push_back(me);
    }
    entry.listener();
    {
        const std::lock_guard lock(mutex_);
        entry.callers.erase(std::find(entry.callers.begin(), entry.callers.end(), me));
    }
    returned_.notify_all();
}

}  // namespace eyrie::coordinator
