// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace eyrie::config {

/// More are never under way at once: renderers keep the frame data of as many.
inline constexpr std::int64_t kMostFramesUnderWay = 8;

/// Of a configuration: its latency and the one that is being seen.
inline std::int64_t framesUnderWay(std::int64_t latency) {
    return std::clamp<std::int64_t>(latency, 0, kMostFramesUnderWay - 1) + 1;
}

}  // namespace eyrie::config
