// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

namespace eyrie::import {

/// For TriangleMesh::notes: what Assimp 5.2 does not read of the 3MF at `path`. In a process that
/// may fail (zip_parts.h). Errors: those of countRecoloured3mfObjects.
absl::StatusOr<std::vector<std::string>> notesOf3mf(const std::string& path);

/// Of a model, as it is in a 3MF, the objects that have other colours than that of one base
/// material, all of which they get. Errors: InvalidArgument where objects are those of other
/// parts (3MF Production Extension), for which Assimp takes objects of this part, or none.
absl::StatusOr<std::uint64_t> countRecoloured3mfObjects(std::string_view model);

}  // namespace eyrie::import
