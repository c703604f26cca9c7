// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/status.h>

#include "fabric/camera.h"
#include "fabric/scene.h"

namespace eyrie::fabric {

/// Cameras reach ten times as far, so that there is one that sees all of a scene.
inline constexpr double kMaxSceneMetres = kMaxCoordinateMetres / 10;

/// InvalidArgument, naming the object, when its bounds in the world reach farther.
absl::Status checkReach(const SceneObject& object, const Box& bounds);

}  // namespace eyrie::fabric
