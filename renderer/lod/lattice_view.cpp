// SPDX-License-Identifier: Apache-2.0
#include "renderer/lod/lattice_view.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

namespace eyrie::lod {

LatticeView::LatticeView(const View& view, const fabric::Mat4& worldFromObject,
                         const fabric::Mat4& objectFromLattice) {
    using fabric::Mat3;
    using fabric::Mat4;
    using fabric::Vec3;
    constexpr double kLimit = 1 << 23;

    using Wide4 = glm::mat<4, 4, long double>;
    Wide4 relativeFromObject(worldFromObject);
    relativeFromObject[3] -= glm::vec<4, long double>(view.eye, 0);
    const Mat4 fromEye(relativeFromObject * Wide4(objectFromLattice));
    const Mat3 linear(fromEye);
    const Vec3 camera = glm::inverse(linear) * -Vec3(fromEye[3]);
    const Vec3 snapped = glm::clamp(glm::round(camera), Vec3(-kLimit), Vec3(kLimit));
    const Vec3 offset = linear * (snapped - camera);  // world axes, from the camera

    Mat4 relativeFromLattice(linear);
    relativeFromLattice[3] = fabric::Vec4(offset, 1.0);
    const Mat4 clip = fabric::clipFromView(view.frustum, fabric::kNearMetres) *
                      Mat4(view.viewFromWorldRotation) * relativeFromLattice;
    cameraLattice = glm::ivec3(snapped);
    clipFromLattice = glm::mat4(clip);
    metresFromLattice = linear;
    cameraOffsetMetres = -offset;
}

}  // namespace eyrie::lod
