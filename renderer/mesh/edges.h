// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// An edge as a triangle passes it. Corners at one position are the same.
struct Edge {
    std::uint64_t from;  ///< positions, as packed
    std::uint64_t to;
    std::uint32_t fromVertex;
    std::uint32_t toVertex;
    std::uint32_t triangle;

    std::pair<std::uint64_t, std::uint64_t> ends() const { return std::minmax(from, to); }
};

/// The same for both ways.
std::uint64_t hashOfEdge(std::uint64_t from, std::uint64_t to);

/// Every edge that is not passed as often one way as the other, as often as it is passed, and
/// perhaps some others, in the order of their ends and then ways; nothing where they are more than
/// `most`.
///
/// Edges are compared by 64-bit hashes: one passes for none of these with a probability of 2^-64.
std::optional<std::vector<Edge>> edgesLeftOver(const PackedMesh& mesh, std::size_t most);

}  // namespace eyrie::mesh
