// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/compound/plan.h"
#include "coordinator/compound/work.h"

namespace eyrie::compound {

/// By which sights a picture is seen, from the draws that its parts come of: what is drawn in other
/// pixels, in ranges or on other channels is of the same sight. `fovYDegrees` is the camera's.
fabric::SeenAreas seenAreas(const Picture& picture, const WorkList& list, double fovYDegrees);

}  // namespace eyrie::compound
