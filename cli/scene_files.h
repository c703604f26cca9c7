// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "cli/data_cache.h"
#include "fabric/scene.h"

namespace eyrie::cli {

/// A scene file as it is: paths made absolute, URLs left as they are, nothing imported.
absl::StatusOr<fabric::Scene> readSceneFile(const std::string& path);

/// A scene that a command line names.
struct NamedScene {
    fabric::Scene scene;
    /// The same without the transforms that were found for it here, which depend on what the files
    /// hold.
    fabric::Scene asNamed;
};

/// One scene of everything named: scene files, .eyt and .eym files, and sources, which go through
/// `cache`; rasters, however many, become one terrain. Lights, ambient and background are the first
/// scene file's. A mesh that shares no coordinates with the terrain beside it is placed on it
/// (placeOnTerrain); `notes` says so, and what DataCache::takeNotes and crsNotes have.
absl::StatusOr<NamedScene> assembleScene(std::span<const std::string> paths, DataCache& cache,
                                         std::vector<std::string>& notes);

}  // namespace eyrie::cli
