// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "fabric/vec.h"

/// What an equalizer's settings may be, in files and while it runs, and what it may set.
namespace eyrie::config {

/// Of a compound or a frame, either way.
inline constexpr double kMostZoom = 64;

inline constexpr double kMostEqualizerPixels = 1e9;

inline bool isShare(const double& value) { return value >= 0 && value <= 1; }
inline bool isAboveZero(const double& value) { return value > 0 && std::isfinite(value); }
inline bool isChunk(const double& value) { return value > 0 && value <= 1; }

inline bool isPixels(const fabric::Vec2& value) {
    return value.x >= 0 && value.y >= 0 && value.x <= kMostEqualizerPixels &&
           value.y <= kMostEqualizerPixels && value.x == std::floor(value.x) &&
           value.y == std::floor(value.y);
}
inline bool isTileSize(const fabric::Vec2& value) {
    return isPixels(value) && value.x >= 1 && value.y >= 1;
}

}  // namespace eyrie::config
