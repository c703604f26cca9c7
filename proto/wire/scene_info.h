// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "fabric/scene.h"

namespace eyrie::v1 {
class Box;
class OpenSceneResponse;
}  // namespace eyrie::v1

namespace eyrie::wire {

/// Precondition: the box is not empty; a message has no empty box, it leaves the field out.
v1::Box toMessage(const fabric::Box& box);

/// InvalidArgument for coordinates that are not finite and for min > max.
absl::StatusOr<fabric::Box> fromMessage(const v1::Box& message);

v1::OpenSceneResponse toMessage(const fabric::SceneInfo& info);
absl::StatusOr<fabric::SceneInfo> fromMessage(const v1::OpenSceneResponse& message);

}  // namespace eyrie::wire
