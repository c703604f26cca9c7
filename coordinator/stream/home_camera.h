// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fabric/box.h"
#include "fabric/camera.h"
#include "fabric/scene.h"

namespace eyrie::stream {

/// Where a session starts: a three-quarter view of the whole scene.
///
/// Looks at `bounds` (world metres, not empty), centred, from the south-west, 30 degrees above
/// the horizon; a scene that is no flatter than a third of its width is seen from 20 degrees, so
/// that it stands before the viewer. All eight corners of the box lie inside a 4:3 picture (and so
/// inside every wider one) with a field of view of 45 degrees.
fabric::Camera homeCamera(const fabric::Box& bounds);

/// World space: a box of the scene with its terrains' heights drawn times `exaggeration`.
fabric::Box exaggeratedBounds(const fabric::SceneInfo& scene, double exaggeration);

}  // namespace eyrie::stream
