// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "renderer/truth/pinhole.h"

namespace eyrie::truth {

using Triangle = std::array<fabric::Vec3, 3>;

/// A ray prepared for many triangles: axes permuted and sheared so that it runs along +z.
class WatertightRay {
public:
    explicit WatertightRay(const Ray& ray);
    /// The ray's parameter at the triangle, either side; infinity for none.
    double hit(const Triangle& triangle) const;

private:
    fabric::Vec3 origin_;
    std::array<int, 3> axes_;
    fabric::Vec3 shear_;
};

/// The point of `triangle` closest to `point`.
fabric::Vec3 closestPoint(const Triangle& triangle, const fabric::Vec3& point);

}  // namespace eyrie::truth
