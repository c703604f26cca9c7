// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "fabric/box.h"
#include "fabric/flight.h"

namespace eyrie::fabric {

/// Neither file says how long a frame is.
inline constexpr double kPathFramesPerSecond = 30;

/// More are two hours, and taken for a mistake.
inline constexpr std::size_t kMostPathKeys = 250'000;

/// Of a path that is read: `note` says what had to be assumed, for the user to read.
struct CameraPath {
    Flight flight;
    std::string note;
};

/// A camera path of older programs, as text: lines of numbers with white space or commas between,
/// - eqPly's: a model rotation (3 degrees), then steps "frames x y z heading pitch roll", the model
///   fitted into a box of 2, turned first and moved then; linear in between;
/// - one camera a line: eye, up and view-plane normal, nine numbers.
/// `bounds` are the scene's: eqPly's model, and what cameras look at. Neither file says how wide
/// the view is: `fovYDegrees`. web/src/flight/paths.ts reads the same, and a test compares them.
///
/// Errors: InvalidArgument, without the file's name, where the text is neither, has more than
/// kMostPathKeys, or its cameras are refused by validate.
absl::StatusOr<CameraPath> cameraPathFromText(std::string_view text, const Box& bounds,
                                              double fovYDegrees);

}  // namespace eyrie::fabric
