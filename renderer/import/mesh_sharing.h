// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/mesh_split.h"

/// What the parts of a mesh on disk have in common.
namespace eyrie::import {

/// A position that vertices of `part` and of `other` have.
struct SharedPoint {
    std::uint64_t position = 0;
    std::uint32_t part = 0;
    std::uint32_t other = 0;
};

/// A triangle of `owner` with a corner at a point that it shares with `host`.
struct Guest {
    SpooledTriangle triangle;
    std::uint32_t owner = 0;
    std::uint32_t host = 0;
};

struct MeshSharing {
    GroupedRows<SharedPoint> points;  ///< by part
    GroupedRows<Guest> guests;  ///< by host: with them its triangles have all their neighbours
};

/// `atOnce`: triangles that memory may hold. Stage reported: "borders". Errors: disk full,
/// Cancelled.
absl::StatusOr<MeshSharing> findSharing(const MeshSplit& split, std::uint64_t atOnce,
                                        const std::string& outPath, const ImportControl& control);

}  // namespace eyrie::import
