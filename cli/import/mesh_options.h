// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/statusor.h>

#include "cli/import/options.h"
#include "renderer/import/mesh_import.h"

namespace eyrie::cli {

/// What `eyrie import mesh` was asked for, as it was written.
struct MeshImportChoices : ImportOptions {
    import::MeshImportOptions how;
    std::string normals = "auto";
    std::string memory;
    std::string flight;  ///< to tune for; empty: the leaf size is `how`'s
    std::string within;  ///< a folder beyond which no file is read that sources name
};

/// InvalidArgument where --memory or --normals cannot be understood.
absl::StatusOr<import::MeshImportOptions> importOptions(const MeshImportChoices& choices);

}  // namespace eyrie::cli
