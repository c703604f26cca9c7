// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace eyrie::mesh {

/// Normals as they would be if they were smooth and the triangles were all there is: at each vertex
/// the sum of its triangles' normals by the angle there, packed (vertex_packing.h). Where a mesh's
/// normals are computed at import, inner vertices of leaves have just these.
///
/// The same bits on every machine with IEEE arithmetic: sums, products, quotients and square roots
/// only, in a fixed order, never fused. Precondition: indices below positions.size(), three a
/// triangle; normals.size() == positions.size().
void forecastNormals(std::span<const std::uint64_t> positions,
                     std::span<const std::uint16_t> indices, std::span<std::uint32_t> normals);

}  // namespace eyrie::mesh
