// SPDX-License-Identifier: Apache-2.0
#include "cli/scene_files.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "access/printable.h"
#include "cli/crs_notes.h"
#include "cli/placement.h"
#include "cli/text_file.h"
#include "eyrie/v1/scene.pb.h"
#include "fabric/status.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/page/remote_name.h"
#include "renderer/terrain/eyt_format.h"
#include "wire/json.h"
#include "wire/scene.h"

namespace eyrie::cli {
namespace {

namespace fs = std::filesystem;

fabric::SceneObject objectOf(const std::string& path) {
    const DataFile file = dataFileOf(path);
    const bool mesh = file == DataFile::Mesh || file == DataFile::MeshSource;
    const std::string name = fs::path(page::withoutQuery(path)).stem().string();
    return {.name = access::isUtf8(name) ? name : access::printable(name),
            .kind = mesh ? fabric::ObjectKind::Mesh : fabric::ObjectKind::Terrain,
            .path = path};
}

/// An object for each of what is no scene; rasters, however many, are one terrain in the place of
/// the first.
absl::StatusOr<std::vector<fabric::SceneObject>> objectsOf(const std::vector<std::string>& paths,
                                                           DataCache& cache) {
    std::vector<fabric::SceneObject> objects;
    std::vector<std::string> rasters;
    std::size_t terrain = 0;
    for (const std::string& path : paths) {
        const bool isRaster = dataFileOf(path) == DataFile::TerrainSource;
        if (isRaster && rasters.empty())
            terrain = objects.size();
        if (!isRaster || rasters.empty())
            objects.push_back(objectOf(path));
        if (isRaster)
            rasters.push_back(path);
    }
    if (rasters.size() < 2)
        return objects;
    objects[terrain].name += fmt::format(" and {} more", rasters.size() - 1);
    ASSIGN_OR_RETURN(objects[terrain].path, cache.mosaicOf(rasters));
    return objects;
}

/// Objects named on the command line, without a transform of their own, by kind.
struct LooseObjects {
    std::vector<fabric::SceneObject*> meshes;
    std::shared_ptr<const terrain::EytFile> terrain;
};

absl::StatusOr<LooseObjects> looseObjects(fabric::Scene& scene, std::size_t firstLoose,
                                          const page::SourceOptions& sources) {
    LooseObjects loose;
    for (std::size_t i = firstLoose; i < scene.objects.size(); ++i) {
        fabric::SceneObject& object = scene.objects[i];
        if (object.kind == fabric::ObjectKind::Mesh)
            loose.meshes.push_back(&object);
        else if (!loose.terrain) {
            ASSIGN_OR_RETURN(loose.terrain, terrain::EytFile::open(object.path, sources));
        }
    }
    return loose;
}

absl::Status placeMeshes(fabric::Scene& scene, std::size_t firstLoose,
                         const page::SourceOptions& sources, std::vector<std::string>& notes) {
    ASSIGN_OR_RETURN(const LooseObjects loose, looseObjects(scene, firstLoose, sources));
    if (!loose.terrain)
        return absl::OkStatus();
    for (fabric::SceneObject* object : loose.meshes) {
        ASSIGN_OR_RETURN(const mesh::EymFile file, mesh::EymFile::open(object->path, sources));
        if (overlapsInPlan(file.bounds(), loose.terrain->index().bounds()))
            continue;
        ASSIGN_OR_RETURN(object->worldFromObject, placeOnTerrain(file.bounds(), *loose.terrain));
        notes.push_back(fmt::format(
            "{} shares no coordinates with the terrain: it is shown on the ground at its middle, "
            "scaled {:.3g} times; write a scene file to place it yourself",
            object->name, object->worldFromObject[0][0]));
    }
    return absl::OkStatus();
}

/// Without `.` and `..`, but where these lead out of a link's target to something else.
std::string normalised(const fs::path& path) {
    const fs::path whole = fs::absolute(path), normal = whole.lexically_normal();
    std::error_code none;
    const bool isAnother = fs::exists(whole, none) && !fs::equivalent(whole, normal, none);
    return (isAnother ? whole : normal).string();
}

/// What a scene file in `folder` calls `name`, as it is called everywhere.
absl::Status place(std::string& name, const fs::path& folder) {
    // No mesh of another format is drawn from a URL: DataCache tells what is.
    if (const absl::Status known = page::checkScheme(name); !known.ok())
        return dataFileOf(name) == DataFile::MeshSource ? absl::OkStatus() : known;
    if (!page::isVirtual(name))
        name = normalised(folder / name);
    return absl::OkStatus();
}

}  // namespace

absl::StatusOr<fabric::Scene> readSceneFile(const std::string& path) {
    ASSIGN_OR_RETURN(const std::string text, readText(path));
    ASSIGN_OR_RETURN(const v1::Scene message, wire::sceneMessageFromJson(text, path));
    absl::StatusOr<fabric::Scene> scene = wire::fromMessage(message);
    if (!scene.ok())
        return fabric::withContext(scene.status(), path);
    const fs::path folder = fs::absolute(path).parent_path();
    for (fabric::SceneObject& object : scene->objects) {
        RETURN_IF_ERROR(fabric::withContext(place(object.path, folder), path));
        for (std::string& picture : object.imagery)
            RETURN_IF_ERROR(fabric::withContext(place(picture, folder), path));
    }
    return scene;
}

absl::StatusOr<NamedScene> assembleScene(std::span<const std::string> paths, DataCache& cache,
                                         std::vector<std::string>& notes) {
    std::optional<fabric::Scene> scene;
    std::vector<fabric::SceneObject> fromScenes;
    std::vector<std::string> others;
    for (const std::string& path : paths) {
        if (dataFileOf(path) != DataFile::Scene) {
            others.push_back(path);
            continue;
        }
        ASSIGN_OR_RETURN(fabric::Scene one, readSceneFile(path));
        fromScenes.insert(fromScenes.end(), one.objects.begin(), one.objects.end());
        if (!scene)
            scene = std::move(one);
    }
    if (!scene)
        scene.emplace();
    ASSIGN_OR_RETURN(const std::vector<fabric::SceneObject> loose, objectsOf(others, cache));
    scene->objects = std::move(fromScenes);
    const std::size_t firstLoose = scene->objects.size();
    scene->objects.insert(scene->objects.end(), loose.begin(), loose.end());
    if (scene->objects.empty())
        return absl::InvalidArgumentError(
            fmt::format("{}: objects is empty; name a terrain or a mesh", paths.front()));
    for (fabric::SceneObject& object : scene->objects) {
        ASSIGN_OR_RETURN(const std::string data,
                         cache.dataFor(object.path, object.kind, object.imagery));
        object.path = page::isVirtual(data) ? data : normalised(data);
        object.imagery.clear();
    }
    for (std::string& note : cache.takeNotes()) notes.push_back(std::move(note));
    ASSIGN_OR_RETURN(const std::vector<std::string> ofCrs, crsNotes(*scene, cache.sources()));
    notes.insert(notes.end(), ofCrs.begin(), ofCrs.end());
    NamedScene named{*scene, *std::move(scene)};
    RETURN_IF_ERROR(placeMeshes(named.scene, firstLoose, cache.sources(), notes));
    RETURN_IF_ERROR(fabric::validate(named.scene));
    return named;
}

}  // namespace eyrie::cli
