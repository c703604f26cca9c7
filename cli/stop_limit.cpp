// SPDX-License-Identifier: Apache-2.0
#include "cli/stop_limit.h"

#include <condition_variable>
#include <mutex>
#include <utility>

namespace eyrie::cli {

StopLimit::StopLimit(std::chrono::milliseconds limit, std::function<void()> late)
    : thread_([limit, late = std::move(late)](const std::stop_token& stop) {
          std::mutex mutex;
          std::condition_variable_any wake;
          std::unique_lock lock(mutex);
          wake.wait_for(lock, stop, limit, [] { return false; });
          if (!stop.stop_requested())
              late();
      }) {}

}  // namespace eyrie::cli
