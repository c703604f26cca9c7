// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/matrix4x4.h>
#include <assimp/vector3.h>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

/// Assimp's values in double precision.
namespace eyrie::import {

inline glm::dmat4 toDouble(const aiMatrix4x4& m) {
    return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2,
            m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
}

inline glm::dvec3 toDouble(const aiVector3D& v) { return {v.x, v.y, v.z}; }

}  // namespace eyrie::import
