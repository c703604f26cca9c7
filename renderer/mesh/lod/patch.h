// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "renderer/mesh/lod/field.h"
#include "renderer/mesh/lod/shifts.h"
#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// A surface that stands for a part of a mesh and uses its vertices.
///
/// Each point of the part's full surface has a partner on this one, and each of this one there; the
/// ways from there to partners here on triangle i are in shifts[i]: their lengths bound the
/// distance of either surface to the other. Where no component was left out partners are those of a
/// continuous map, one to one. What it does to the colours of partners, as light, is in tints[i],
/// and to their normals in normals[i].
struct Patch {
    std::vector<Triangle> triangles;
    std::vector<Shifts> shifts;  ///< one a triangle
    /// One a triangle. None where the part has one colour, or the triangles are the part's own.
    std::vector<FieldChanges> tints = {};
    /// One a triangle. None where the triangles are the part's own, or too many to be drawn so.
    std::vector<FieldChanges> normals = {};

    /// Bound on the distance between partners, in lattice steps.
    double error() const {
        double largest = 0;
        for (const Shifts& one : shifts) largest = std::max(largest, double{one.longest()});
        return largest;
    }
};

}  // namespace eyrie::mesh
