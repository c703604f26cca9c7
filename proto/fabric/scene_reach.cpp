// SPDX-License-Identifier: Apache-2.0
#include "fabric/scene_reach.h"

#include <cmath>

#include <fmt/format.h>

namespace eyrie::fabric {

absl::Status checkReach(const SceneObject& object, const Box& bounds) {
    for (const Vec3& corner : {bounds.min, bounds.max})
        for (int axis = 0; axis < 3; ++axis)
            if (!bounds.isEmpty() && !(std::abs(corner[axis]) <= kMaxSceneMetres))
                return absl::InvalidArgumentError(fmt::format(
                    "object '{}' reaches to {:.3g} metres; scenes reach from {:g} to {:g}: check "
                    "its transform",
                    object.name, corner[axis], -kMaxSceneMetres, kMaxSceneMetres));
    return absl::OkStatus();
}

}  // namespace eyrie::fabric
