// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fabric/box.h"
#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// Holes that are told apart; a mesh with more counts as open everywhere.
inline constexpr std::size_t kMostLids = 64;

/// What closes a mesh in thought: no one draws it, but whoever looks from outside and sees the mesh
/// from behind looks through one of them (docs/errors.md#back-faces).
struct Lids {
    /// Of the mesh's vertices. Together with the mesh's they pass each edge as often one way as the
    /// other, corners at one position being the same.
    std::vector<Triangle> triangles;
    /// Around those with an area, one a hole; in lattice steps. Slits, as dropped triangles without
    /// area leave them, have none.
    std::vector<fabric::Box> boxes;
};

/// For each group of open edges that hang together a fan from one of their ends; none for a closed
/// mesh. Nothing where there are more than kMostLids holes, or an open edge for every few
/// triangles.
///
/// Edges are compared by 64-bit hashes: an open edge passes for none with a probability of 2^-64.
/// Of meshes that are made so that hashes are the same: nothing, or too few.
std::optional<Lids> findLids(const PackedMesh& mesh);

/// Of a triangle between these positions, for each edge a number of its own, or less that number
/// where it is passed the other way. All of them make 0 where the mesh is closed.
std::uint64_t edgeSum(const std::array<std::uint64_t, 3>& positions);

}  // namespace eyrie::mesh
