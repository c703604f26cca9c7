// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "fabric/scene.h"

namespace eyrie::v1 {
class Scene;
}

namespace eyrie::wire {

/// Writes each transform as a matrix.
v1::Scene toMessage(const fabric::Scene& scene);

/// Fills in what is absent (an object's name is then its file's) and turns colours of the message,
/// sRGB from 0 to 1, into what the scene holds: linear for objects, sRGB bytes for the background.
/// Paths are taken as they are. InvalidArgument, naming the object and field, for numbers out of
/// range, an object without data, a transform given twice, and what fabric::validate refuses.
absl::StatusOr<fabric::Scene> fromMessage(const v1::Scene& message);

/// The two halves of the sRGB transfer function (IEC 61966-2-1), for values from 0 to 1.
double linearFromSrgb(double encoded);
double srgbFromLinear(double linear);

}  // namespace eyrie::wire
