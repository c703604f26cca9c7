// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <mutex>

#include <absl/status/statusor.h>

#include "fabric/frame_data.h"

namespace eyrie::service {

/// The frame data received last. All functions may be called from any thread.
class FrameDataHistory {
public:
    static constexpr std::size_t kVersionsKept = 8;

    /// Forgets the oldest of more than kVersionsKept. A version sent again replaces the one before:
    /// a coordinator that starts anew counts from 1.
    void store(const fabric::FrameData& frameData);

    /// FailedPrecondition, naming the versions there are, when `version` was never sent or is
    /// forgotten.
    absl::StatusOr<fabric::FrameData> find(std::uint64_t version) const;

private:
    mutable std::mutex mutex_;  ///< guards versions_
    std::deque<fabric::FrameData> versions_;
};

}  // namespace eyrie::service
