// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>

#include <absl/status/status.h>

#include "renderer/mesh/output_file.h"

namespace eyrie::mesh {

/// A node above .eym files that become one, or one of these.
struct JoinedNode {
    std::int32_t left = -1;   ///< of the nodes that are joined; -1: all of an .eym file stands here
    std::int32_t right = -1;  ///< what lies under the node follows it: depth first
    std::uint64_t offset = 0;  ///< of its .eym file in `parts`; above others that has one node only
};

/// Appends to the empty `out` one .eym file made of several, which lie one after the other in the
/// unnamed `parts`, each from a multiple of 8 on: their pages as they are, one table of nodes.
/// `vertexCount`: of all, each counted once. Preconditions: they have one lattice and the same
/// options, and no materials or lights. Errors: Cancelled, those of OutputFile.
absl::Status joinEym(const OutputFile& parts, std::span<const JoinedNode> nodes,
                     std::uint64_t vertexCount, OutputFile& out, const std::stop_token& stop = {});

}  // namespace eyrie::mesh
