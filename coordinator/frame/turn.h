// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace eyrie::coordinator {

/// A lock that is given in the order in which it was asked for, so that no viewer starves.
class Turn {
public:
    void lock() {
        std::unique_lock guard(mutex_);
        const std::uint64_t mine = next_++;
        changed_.wait(guard, [&] { return mine == current_; });
    }
    void unlock() {
        {
            const std::lock_guard guard(mutex_);
            ++current_;
        }
        changed_.notify_all();
    }

private:
    std::mutex mutex_;  ///< guards the tickets
    std::condition_variable changed_;
    std::uint64_t next_ = 0;
    std::uint64_t current_ = 0;
};

}  // namespace eyrie::coordinator
