// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace eyrie::coordinator {

/// Who wants to know of changes. All functions may be called from any thread.
class Listeners {
public:
    /// Returns a handle for remove.
    int add(std::function<void()> listener);

    /// After it returns the listener runs no more; except that a listener may remove itself.
    /// Waits for a call in progress, so do not hold a lock that the listener takes.
    void remove(int handle);

    /// Calls each listener, without locks held; several threads may do so at the same time.
    void notify();

private:
    struct Entry {
        std::function<void()> listener;
        std::vector<std::thread::id> callers;  ///< threads that are in a call
        bool removed = false;
    };

    void call(Entry& entry);

    std::mutex mutex_;  ///< guards what follows, entries included
    std::condition_variable returned_;
    std::map<int, std::shared_ptr<Entry>> entries_;
    int nextHandle_ = 1;
};

}  // namespace eyrie::coordinator
