// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "renderer/mesh/packed_mesh.h"

namespace eyrie::import {

/// A unit normal per vertex: the mean of its triangles' normals, each weighted by the triangle's
/// angle there, so that how a surface is cut into triangles does not matter.
///
/// Where triangles cancel out (the two sides of a thin sheet) the first one's normal stands; a
/// vertex without triangles gets +z. The same for any number of threads.
/// Precondition: no triangle has zero area.
/// G. Thürmer, C. A. Wüthrich, "Computing Vertex Normals from Polygonal Facets", 1998.
std::vector<glm::vec3> smoothNormals(std::span<const std::uint64_t> positions,
                                     std::span<const mesh::Triangle> triangles);

/// A unit normal per corner, three a triangle: the mean as above of those triangles around its
/// vertex that are reached from its own across edges at which neighbours' normals differ by
/// `creaseRadians` at most. The same for any number of threads. Precondition: as above.
std::vector<glm::vec3> creasedNormals(std::span<const std::uint64_t> positions,
                                      std::span<const mesh::Triangle> triangles,
                                      double creaseRadians);

}  // namespace eyrie::import
