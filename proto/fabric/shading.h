// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace eyrie::fabric {

/// How surfaces are drawn.
enum class Shading {
    Smooth,   ///< light in every pixel, normals interpolated (Phong)
    Gouraud,  ///< light at vertices, interpolated; terrain, whose normals are a map, stays smooth
    Flat,     ///< one normal a triangle
    Wireframe
};

}  // namespace eyrie::fabric
