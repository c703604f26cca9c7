// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace eyrie::import {

/// For TriangleMesh::notes, what Assimp 5.2 makes of an X3D file otherwise than the format means
/// it: nodes that hold others and are passed over with all in them, shapes that are not read,
/// colours that are read for others', nodes that are shown though they are not to be seen,
/// triangles that are seen from behind.
std::vector<std::string> x3dCaveats(std::string_view text);

}  // namespace eyrie::import
