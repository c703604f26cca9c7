// SPDX-License-Identifier: Apache-2.0
#include "fabric/frustum.h"

#include <glm/trigonometric.hpp>

namespace eyrie::fabric {

Frustum symmetricFrustum(double fovYDegrees, double aspect) {
    const double top = glm::tan(glm::radians(fovYDegrees) / 2);
    return {-top * aspect, top * aspect, -top, top};
}

Mat4 clipFromView(const Frustum& f, double nearMetres) {
    Mat4 m(0.0);
    m[0][0] = 2 / (f.right - f.left);
    m[1][1] = 2 / (f.top - f.bottom);
    m[2][0] = (f.right + f.left) / (f.right - f.left);
    m[2][1] = (f.top + f.bottom) / (f.top - f.bottom);
    m[2][3] = -1;
    m[3][2] = nearMetres;
    return m;
}

}  // namespace eyrie::fabric
