// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>

#include <absl/status/status.h>

#include "renderer/mesh/back_faces.h"
#include "renderer/mesh/codec/exact_codec.h"
#include "renderer/mesh/kd_tree.h"
#include "renderer/mesh/lod/lod_tree.h"
#include "renderer/mesh/output_file.h"
#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

struct EymOptions {
    /// Pages are coded; otherwise they lie in the file as they are drawn.
    bool isCoded = true;
    std::uint64_t sourceHash = 0;       ///< kept in the file (EymFile::sourceHash)
    std::uint64_t turnedTriangles = 0;  ///< likewise
    /// Of source positions, where they are kept; else the least that holds them.
    std::optional<ExactForm> exactForm = {};
};

/// Appends `mesh`, cut into the leaves of `tree` and with the coarser nodes of `lod`, to the empty
/// `out` as an .eym file (eym_format.h); the caller commits it. Where the mesh has exact positions
/// they are kept. `backs`: findBacks of mesh and tree.
/// The same mesh, tree and options give the same bytes. Errors: Cancelled,
/// ResourceExhausted, Unavailable. Preconditions: at least one triangle; no node with more than
/// kMaxNodeTriangles.
absl::Status writeEym(const PackedMesh& mesh, const KdTree& tree, const LodTree& lod,
                      const Backs& backs, const EymOptions& options, OutputFile& out,
                      const std::stop_token& stop = {});

}  // namespace eyrie::mesh
