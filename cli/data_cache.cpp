// SPDX-License-Identifier: Apache-2.0
#include "cli/data_cache.h"

#include <algorithm>
#include <cctype>
#include <span>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/import_notes.h"
#include "cli/several_sources.h"
#include "cli/source_record.h"
#include "fabric/partial_file.h"
#include "fabric/status.h"
#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_reader.h"
#include "renderer/import/raster_hash.h"
#include "renderer/import/terrain_import.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/page/remote_name.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::cli {
namespace {

namespace fs = std::filesystem;

/// Raise either when an importer makes something else of the same source.
constexpr int kMeshImporterVersion = 23;
constexpr int kTerrainImporterVersion = 14;

std::string lowerCaseEnding(const std::string& path) {
    std::string ending = fs::path(page::withoutQuery(path)).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

std::string meshName(std::uint64_t sourceHash) {
    return fmt::format("{:016x}-{}.eym", sourceHash, kMeshImporterVersion);
}

/// Name of the import of `sources`: what they hold, in their order, and what made it.
absl::StatusOr<std::string> importName(const std::vector<std::string>& sources,
                                       fabric::ObjectKind kind,
                                       const std::vector<std::string>& imagery,
                                       const std::stop_token& stop) {
    if (kind == fabric::ObjectKind::Mesh) {
        ASSIGN_OR_RETURN(const std::uint64_t hash, import::meshSourceHash(sources));
        return meshName(hash);
    }
    std::uint64_t hash = 0;
    for (const std::string& source : sources) {
        ASSIGN_OR_RETURN(const std::uint64_t part, import::placedRasterHash(source, stop));
        hash = hash * 41 + part;
    }
    for (const std::string& picture : imagery) {
        ASSIGN_OR_RETURN(const std::uint64_t part, import::placedRasterHash(picture, stop));
        hash = hash * 37 + part;
    }
    return fmt::format("{:016x}-{}.eyt", hash, kTerrainImporterVersion);
}

/// Only .eyt and .eym are drawn from where they lie; rasters can be imported from there.
absl::Status isHere(const std::string& source, fabric::ObjectKind kind) {
    if (page::isPlainPath(source))
        return absl::OkStatus();
    if (kind == fabric::ObjectKind::Mesh)
        return absl::InvalidArgumentError(fmt::format(
            "{}: only .eyt and .eym files are drawn from a URL, and meshes are imported "
            "from files of this machine; download or unpack this one, or name the .eym "
            "that `eyrie import mesh` made of it",
            source));
    RETURN_IF_ERROR(page::checkScheme(source));
    return absl::InvalidArgumentError(fmt::format(
        "{}: only .eyt and .eym files are drawn from a URL; name what `eyrie import terrain` makes "
        "of this one, which it reads where it lies, or download it",
        source));
}

/// Here nothing says how much memory an import may take: behind advice to allow more.
absl::Status withRemedy(const absl::Status& status) {
    const std::string message(status.message());
    if (!message.ends_with("allow more memory"))
        return status;
    return {status.code(), fmt::format("{} (`eyrie import mesh --memory` sets how much)", message)};
}

/// Whether the file at `path`, which importName has named, is what its name says, as far as it can
/// tell.
bool isImport(const fs::path& path, fabric::ObjectKind kind) {
    if (kind == fabric::ObjectKind::Terrain)
        return terrain::EytFile::open(path.string()).ok();
    const auto file = mesh::EymFile::open(path.string());
    return file.ok() && path.filename().string() == meshName(file->sourceHash());
}

}  // namespace

DataFile dataFileOf(const std::string& path) {
    const std::string ending = lowerCaseEnding(path);
    if (ending == ".json")
        return DataFile::Scene;
    if (ending == ".eyt")
        return DataFile::Terrain;
    if (ending == ".eym")
        return DataFile::Mesh;
    return import::isMeshSource(page::withoutQuery(path)) ? DataFile::MeshSource
                                                          : DataFile::TerrainSource;
}

DataCache::DataCache(fs::path folder, ProgressBar::Style progress, std::stop_token stop,
                     page::SourceOptions sources, std::uint64_t meshMemoryBytes)
    : folder_(std::move(folder)),
      progress_(progress),
      stop_(std::move(stop)),
      sources_(std::move(sources)),
      meshMemoryBytes_(meshMemoryBytes) {}

absl::StatusOr<std::string> DataCache::dataFor(const std::string& path, fabric::ObjectKind kind,
                                               const std::vector<std::string>& imagery) {
    switch (dataFileOf(path)) {
        case DataFile::Terrain:
        case DataFile::Mesh:
            RETURN_IF_ERROR(page::checkScheme(path));
            if (!imagery.empty())
                return absl::InvalidArgumentError(fmt::format(
                    "{}: is imported already, so its imagery ({}) cannot be laid over it; name the "
                    "elevation model instead, or run `eyrie import terrain` with --imagery",
                    path, fmt::join(imagery, ", ")));
            // Said here, at once: a renderer would only find out when it opens the scene.
            if (page::isVirtual(path)) {
                RETURN_IF_ERROR(reach(path, kind));
                return path;
            }
            if (std::error_code ignored; !fs::exists(path, ignored))
                return absl::NotFoundError(fmt::format("{}: no such file", path));
            return path;
        case DataFile::Scene:
            return absl::InvalidArgumentError(
                fmt::format("{}: a scene cannot be an object of a scene", path));
        case DataFile::MeshSource:
        case DataFile::TerrainSource:
            break;
    }
    RETURN_IF_ERROR(isHere(path, kind));
    for (const std::string& picture : imagery)
        RETURN_IF_ERROR(isHere(picture, fabric::ObjectKind::Terrain));
    return imported({path}, kind, imagery);
}

absl::StatusOr<std::string> DataCache::mosaicOf(const std::vector<std::string>& rasters) {
    for (const std::string& raster : rasters)
        RETURN_IF_ERROR(isHere(raster, fabric::ObjectKind::Terrain));
    absl::StatusOr<std::string> made = imported(rasters, fabric::ObjectKind::Terrain, {});
    // Among others because they have no place in common, or lie too far apart.
    if (absl::IsInvalidArgument(made.status()) || absl::IsResourceExhausted(made.status()))
        return absl::Status(made.status().code(),
                            fmt::format("{} (several rasters become one terrain; a scene file "
                                        "shows each as one of its own)",
                                        std::string(made.status().message())));
    return made;
}

absl::Status DataCache::reach(const std::string& url, fabric::ObjectKind kind) {
    if (kind == fabric::ObjectKind::Terrain)
        return terrain::EytFile::open(url, sources_).status();
    return mesh::EymFile::open(url, sources_).status();
}

absl::StatusOr<std::string> DataCache::imported(const std::vector<std::string>& sources,
                                                fabric::ObjectKind kind,
                                                const std::vector<std::string>& imagery) {
    ASSIGN_OR_RETURN(const std::string name, importName(sources, kind, imagery, stop_));
    const std::string target = (folder_ / name).string();
    std::error_code error;
    if (fs::exists(target, error) && isImport(target, kind)) {
        // Of the same bytes, perhaps from elsewhere. A cache that others keep may not be written.
        recordSources(target, sources).IgnoreError();
        return target;
    }
    fs::create_directories(folder_, error);
    if (error)
        return absl::FailedPreconditionError(
            fmt::format("{}: cannot create this folder for imports ({}); name another with "
                        "--cache FOLDER",
                        folder_.string(), error.message()));
    fabric::removeAllAbandoned(folder_);
    RETURN_IF_ERROR(import(sources, target, kind, imagery));
    if (const auto now = importName(sources, kind, imagery, stop_); !now.ok() || *now != name) {
        fs::remove(target, error);
        RETURN_IF_ERROR(now.status());
        return absl::UnavailableError(
            fmt::format("{}: changed while it was imported; run it again", titleOf(sources)));
    }
    RETURN_IF_ERROR(recordSources(target, sources));
    return target;
}

absl::Status DataCache::import(const std::vector<std::string>& sources, const std::string& target,
                               fabric::ObjectKind kind, const std::vector<std::string>& imagery) {
    ASSIGN_OR_RETURN(const std::vector<std::string> notes,
                     importNoting(sources, target, kind, imagery));
    for (const std::string& note : notes)
        notes_.push_back(fmt::format("{}: {}", titleOf(sources), note));
    return absl::OkStatus();
}

absl::StatusOr<std::vector<std::string>> DataCache::importNoting(
    const std::vector<std::string>& sources, const std::string& target, fabric::ObjectKind kind,
    const std::vector<std::string>& imagery) const {
    ProgressBar bar(fs::path(titleOf(sources)).filename().string(), megabytesOf(sources), "MB",
                    progress_);
    const import::ImportControl control{bar.callback(), stop_};
    if (kind == fabric::ObjectKind::Terrain) {
        ASSIGN_OR_RETURN(import::TerrainImportReport made,
                         import::importTerrain(sources, target, {.imagery = imagery}, control));
        return std::move(made.notes);
    }
    const auto made =
        import::importMesh(sources, target, {.memoryBytes = meshMemoryBytes_}, control);
    if (!made.ok())
        return withRemedy(made.status());
    return notesOf(*made);
}

}  // namespace eyrie::cli
