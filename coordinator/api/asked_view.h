// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "coordinator/frame/frame_source.h"

namespace eyrie::v1 {
class Camera;
}

namespace eyrie::api {

/// What is absent of a request's picture.
inline constexpr int kUsualWidth = 1280;
inline constexpr int kUsualHeight = 720;

/// `message` or, where it is empty, where viewers start, for heights drawn times `exaggeration`.
/// Errors: InvalidArgument (the camera), Unavailable (no scene is open, and so viewers start
/// nowhere).
absl::StatusOr<fabric::Camera> cameraOf(const v1::Camera& message,
                                        const coordinator::FrameSource& frames,
                                        double exaggeration);

}  // namespace eyrie::api
