// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "fabric/camera.h"
#include "fabric/frame_budget.h"
#include "fabric/look.h"
#include "fabric/shading.h"

namespace eyrie::fabric {

/// Whether what is hidden behind something is found and left out. It changes no pixel.
enum class Occlusion {
    Auto,  ///< where measurements say that it pays
    On,
    Off
};

/// What changes from frame to frame. Versioned: renderers receive each version once, and channel
/// tasks name the version they are to be drawn with.
struct FrameData {
    std::uint64_t version = 0;
    Camera camera;
    double tauPixels = 1;  ///< screen-space error asked for; 0.01 to 1000
    Shading shading = Shading::Smooth;
    Look look = {};
    Occlusion occlusion = Occlusion::Auto;
    /// A time to hold by drawing at a larger tau: by fabric::tauForBudget, for all objects alike.
    std::optional<FrameBudget> budget = {};

    bool operator==(const FrameData&) const = default;
};

inline constexpr double kMinTauPixels = 0.01;
inline constexpr double kMaxTauPixels = 1000;

}  // namespace eyrie::fabric
