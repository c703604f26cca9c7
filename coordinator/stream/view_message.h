// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <absl/status/statusor.h>

#include "coordinator/frame/frame_source.h"

namespace eyrie::v1 {
class ShownPicture;
class ViewRequest;
}  // namespace eyrie::v1

namespace eyrie::stream {

struct ViewRequest {
    std::uint64_t sequence = 0;
    std::uint64_t viewer = 0;  ///< Seat::id of who asked
    coordinator::FrameRequest frame;
    bool isUnderground = false;  ///< the camera may be under ground
};

inline constexpr int kMinPictureSide = 16;
inline constexpr int kMaxPictureSide = 4096;

/// Errors: InvalidArgument, naming what this version does not know.
absl::StatusOr<coordinator::Shown> shownFromMessage(const v1::ShownPicture& message);

/// Sizes are clamped to kMinPictureSide..kMaxPictureSide. Errors: InvalidArgument (a view that
/// cannot be drawn; the message tells the user why).
absl::StatusOr<ViewRequest> viewFromMessage(const v1::ViewRequest& message);

v1::ViewRequest toMessage(const ViewRequest& view);

}  // namespace eyrie::stream
