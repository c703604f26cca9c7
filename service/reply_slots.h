// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <mutex>

#include <absl/status/status.h>

namespace eyrie::service {

/// Counts the answers of a service from their start to their end, so that readers that are slow, or
/// never read, hold a bounded amount of its memory.
///
/// An answer is open until its last message has been handed over, and leaves from then on: a reader
/// may have all of it, and ask for more, before this side is told so. All functions may be called
/// from any thread.
class ReplySlots {
public:
    static constexpr int kMaxOpen = 16;
    /// Of last messages that nobody is known to have.
    static constexpr std::size_t kMaxLeavingBytes = std::size_t{32} << 20;

    void open();
    /// `bytes` of its last message, which it holds until then.
    void leave(std::size_t bytes);
    /// Of one that has left: the same `bytes`.
    void close(std::size_t bytes);

    /// Whether the one opened last may be answered. Errors: ResourceExhausted.
    absl::Status check() const;

private:
    mutable std::mutex mutex_;  ///< guards what follows
    int open_ = 0;
    std::size_t leavingBytes_ = 0;
};

}  // namespace eyrie::service
