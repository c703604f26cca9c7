// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace eyrie::cli {

/// Does something where what goes on while it lives takes longer than it may.
class StopLimit {
public:
    /// Calls `late` on a thread of its own, once, `limit` from now, unless destroyed before.
    StopLimit(std::chrono::milliseconds limit, std::function<void()> late);
    StopLimit(const StopLimit&) = delete;
    StopLimit& operator=(const StopLimit&) = delete;

private:
    std::jthread thread_;
};

}  // namespace eyrie::cli
