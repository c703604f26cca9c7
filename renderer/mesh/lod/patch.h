// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// A surface that stands for a part of a mesh and uses its vertices.
///
/// There is a continuous map, one to one, of the part's full surface onto this one that moves no
/// point that lands on triangle i by more than bounds[i] lattice steps: a bound on the distance of
/// either surface to the other.
struct Patch {
    std::vector<Triangle> triangles;
    std::vector<float> bounds;  ///< one a triangle
};

}  // namespace eyrie::mesh
