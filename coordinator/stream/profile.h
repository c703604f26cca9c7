// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/status.h>
#include <absl/status/statusor.h>

#include "coordinator/frame/frame_source.h"
#include "fabric/box.h"
#include "fabric/pick.h"
#include "fabric/vec.h"

namespace eyrie::stream {

/// A line over a scene, seen from above.
struct ProfileLine {
    fabric::Vec2 from{0, 0};  ///< world metres, x and y
    fabric::Vec2 to{0, 0};
    int samples = 0;                    ///< 2 to kMaxSamples, both ends among them
    fabric::HiddenObjects hidden = {};  ///< that are looked through

    bool operator==(const ProfileLine&) const = default;
};

inline constexpr int kMaxSamples = 512;

/// InvalidArgument, naming the field, unless the ends are within fabric::kMaxCoordinateMetres and
/// the number is in its range.
absl::Status validate(const ProfileLine& line);

/// Of the scene that is measured, world metres. Unavailable, saying why, while none is open.
absl::StatusOr<fabric::Box> profiledBounds(const coordinator::Status& status);

/// Asks what lies topmost at sample `index` of `line`, by looking straight down from above all of a
/// scene with these bounds, world metres. Its answer's errorMetres is how far from the source the
/// point may be, in whatever direction: of a steep wall the height there may be off by far more.
/// Precondition: 0 <= index < line.samples.
fabric::PickRequest pickFromAbove(const ProfileLine& line, int index, const fabric::Box& scene);

}  // namespace eyrie::stream
