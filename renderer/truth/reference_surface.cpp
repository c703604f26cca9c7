// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/reference_surface.h"

namespace eyrie::truth {

Displacement ReferenceSurface::displacement(const Pinhole& camera,
                                            const fabric::Vec3& point) const {
    const auto other = counterpart(point);
    const auto p = camera.project(point);
    const auto q = other ? camera.project(*other) : std::nullopt;
    if (!p || !q)
        return {};
    return {camera.pixelsBetween(*p, *q), fabric::Vec2(point) == fabric::Vec2(*other),
            point.z < other->z};
}

}  // namespace eyrie::truth
