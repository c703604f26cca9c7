// SPDX-License-Identifier: Apache-2.0
#include "service/frame_data_history.h"

#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace eyrie::service {

void FrameDataHistory::store(const fabric::FrameData& frameData) {
    const std::lock_guard lock(mutex_);
    std::erase_if(versions_, [&](const auto& other) { return other.version == frameData.version; });
    versions_.push_back(frameData);
    if (versions_.size() > kVersionsKept)
        versions_.pop_front();
}

absl::StatusOr<fabric::FrameData> FrameDataHistory::find(std::uint64_t version) const {
    const std::lock_guard lock(mutex_);
    std::vector<std::uint64_t> known;
    for (const fabric::FrameData& frameData : versions_) {
        if (frameData.version == version)
            return frameData;
        known.push_back(frameData.version);
    }
    return absl::FailedPreconditionError(
        fmt::format("task.frame_data_version is {}, but this renderer has [{}]; call SetFrameData "
                    "with it first",
                    version, fmt::join(known, ", ")));
}

}  // namespace eyrie::service
