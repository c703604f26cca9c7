// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/mesh/packed_mesh.h"

namespace eyrie::import {

/// What making the winding consistent found. Components are connected by edges that exactly two
/// triangles share.
struct OrientCounts {
    std::uint64_t components = 0;
    std::uint64_t closedComponents = 0;
    std::uint64_t turnedTriangles = 0;
    /// Edges across which no choice agrees, as on a Möbius strip; their components count as open.
    std::uint64_t contraryEdges = 0;

    bool operator==(const OrientCounts&) const = default;
};

/// Says which triangles to turn so that those of a component wind the same way: counter-clockwise
/// seen from outside, where that is known. A closed component encloses a positive volume; so does
/// one whose holes are small beside it, closed by a point amid them. Of any other the larger area
/// stays as it is: a sheet has no outside. Each component is judged alone, so a shell inside
/// another faces outward too.
///
/// `positions` are packed (mesh/vertex_packing.h), each different. The same for any number of
/// threads. Preconditions: every corner is below positions.size(); no triangle has zero area.
std::vector<bool> findTurned(std::span<const std::uint64_t> positions,
                             std::span<const mesh::Triangle> triangles, OrientCounts& counts);

}  // namespace eyrie::import
