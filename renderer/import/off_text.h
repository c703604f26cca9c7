// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace eyrie::import {

/// An OFF file (Geomview) as Assimp 5.2 can read it, which refuses colours of vertices that are of
/// three numbers (they are opaque), and headers that name in another order what vertices have, as
/// MeshLab's CSTOFF and NCOFF. MeshLab puts colours before normals there, and others as it says:
/// what is of a normal's length tells. Nothing for one without, or where that does not tell.
std::optional<std::string> offForAssimp(std::string_view off);

/// For TriangleMesh::notes: opacities of vertices that have normals, colours of faces, faces of
/// more corners than Assimp reads, and where there are fewer or more than the header counts.
std::vector<std::string> offCaveats(std::string_view off);

}  // namespace eyrie::import
