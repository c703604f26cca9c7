// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "fabric/camera.h"

namespace eyrie::v1 {
class Camera;
}

namespace eyrie::wire {

v1::Camera toMessage(const fabric::Camera& camera);

/// Absent `up` and `fovy_degrees` take their defaults. InvalidArgument, naming the field, for
/// arrays that do not have three finite numbers and for what fabric::validate refuses.
absl::StatusOr<fabric::Camera> fromMessage(const v1::Camera& message);

}  // namespace eyrie::wire
