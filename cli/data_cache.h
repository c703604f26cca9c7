// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <absl/status/statusor.h>

#include "cli/import_memory.h"
#include "cli/progress_bar.h"
#include "fabric/scene.h"
#include "renderer/page/page_source.h"

namespace eyrie::cli {

/// What a file or URL named on the command line is, told by its ending.
enum class DataFile {
    Scene,          ///< .json
    Terrain,        ///< .eyt
    Mesh,           ///< .eym
    MeshSource,     ///< .ply, .obj and others: import::isMeshSource
    TerrainSource,  ///< anything else: GDAL decides
};
DataFile dataFileOf(const std::string& path);

/// Imports of source files, kept from run to run and named by the content of what they came from:
/// a file is imported again only when its bytes, or the importer, have changed.
class DataCache {
public:
    /// Creates `folder` when the first import needs it. `meshMemoryBytes`: what the import of a
    /// mesh may take, about.
    DataCache(std::filesystem::path folder, ProgressBar::Style progress, std::stop_token stop,
              page::SourceOptions sources = {},
              std::uint64_t meshMemoryBytes = defaultMeshMemory());

    /// The .eyt or .eym to draw for `path`: itself, or the import of a source file. Data at a URL
    /// are opened once, to see whether they can be, and a mesh is copied, so that renderers of this
    /// machine find it. `imagery` names pictures to lay over an elevation model. Errors: those of
    /// the importers, and of opening a URL; InvalidArgument where `path` is a scene, or imported
    /// already and so has no use for pictures.
    absl::StatusOr<std::string> dataFor(const std::string& path, fabric::ObjectKind kind,
                                        const std::vector<std::string>& imagery = {});

    /// The .eyt of several elevation models as one terrain, as import::openDems lays them over each
    /// other. Their order counts. Errors: those of the importer.
    absl::StatusOr<std::string> mosaicOf(const std::vector<std::string>& rasters);

    /// What was said of sources that were imported since the last call: what is odd in them, what
    /// was assumed, what was left out. Lines for people, each with the name of its source. Imports
    /// that were there already say nothing.
    std::vector<std::string> takeNotes() { return std::exchange(notes_, {}); }

    /// How data at URLs are read.
    const page::SourceOptions& sources() const { return sources_; }

private:
    absl::Status reach(const std::string& url, fabric::ObjectKind kind);
    /// `sources`: one, or elevation models to be laid over each other.
    absl::StatusOr<std::string> imported(const std::vector<std::string>& sources,
                                         fabric::ObjectKind kind,
                                         const std::vector<std::string>& imagery);
    absl::Status import(const std::vector<std::string>& sources, const std::string& target,
                        fabric::ObjectKind kind, const std::vector<std::string>& imagery);
    absl::StatusOr<std::vector<std::string>> importNoting(
        const std::vector<std::string>& sources, const std::string& target, fabric::ObjectKind kind,
        const std::vector<std::string>& imagery) const;

    const std::filesystem::path folder_;
    const ProgressBar::Style progress_;
    const std::stop_token stop_;
    const page::SourceOptions sources_;
    const std::uint64_t meshMemoryBytes_;
    std::vector<std::string> notes_;
};

}  // namespace eyrie::cli
