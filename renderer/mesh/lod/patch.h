// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// A surface that stands for a part of a mesh and uses its vertices.
///
/// Each point of the part's full surface has a partner on this one, and each of this one there; no
/// two partners, the one here on triangle i, are farther apart than bounds[i] lattice steps: a
/// bound on the distance of either surface to the other. Where no component was left out partners
/// are those of a continuous map, one to one.
struct Patch {
    std::vector<Triangle> triangles;
    std::vector<float> bounds;  ///< one a triangle
};

}  // namespace eyrie::mesh
