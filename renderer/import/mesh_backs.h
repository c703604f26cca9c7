// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/mesh_spool.h"

namespace eyrie::import {

/// By their numbers, the triangles of a mesh on disk that an eye outside its bounds may see from
/// behind: what mesh::seenFromBehind finds. Nothing where all of them may be, or where one row of
/// columns is more than memory may hold. `atOnce`: triangles that it may.
/// Stage reported: "backs". Errors: disk full, Cancelled.
absl::StatusOr<std::optional<std::vector<bool>>> findBacks(const MeshSpool& spool,
                                                           std::uint64_t atOnce,
                                                           const std::string& outPath,
                                                           const ImportControl& control);

}  // namespace eyrie::import
