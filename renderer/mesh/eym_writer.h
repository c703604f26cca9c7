// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stop_token>

#include <absl/status/status.h>

#include "renderer/mesh/kd_tree.h"
#include "renderer/mesh/lod/lod_tree.h"
#include "renderer/mesh/output_file.h"
#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// Appends `mesh`, cut into the leaves of `tree` and with the coarser nodes of `lod`, to the empty
/// `out` as an .eym file (eym_format.h); the caller commits it. The same mesh, tree and
/// `sourceHash` give the same bytes. Errors: Cancelled, ResourceExhausted, Unavailable.
/// Precondition: at least one triangle.
absl::Status writeEym(const PackedMesh& mesh, const KdTree& tree, const LodTree& lod,
                      std::uint64_t sourceHash, OutputFile& out, const std::stop_token& stop = {});

}  // namespace eyrie::mesh
