// SPDX-License-Identifier: Apache-2.0
#include "tests/renderer/sample_scene.h"

#include <cstdlib>
#include <filesystem>

#include <glm/gtc/matrix_transform.hpp>

#include "fabric/status.h"
#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_synth.h"
#include "renderer/import/terrain_import.h"
#include "renderer/import/terrain_synth.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::test {
namespace {

constexpr std::uint64_t kSeed = 7;

/// A folder that lives as long as the process.
const std::filesystem::path& sampleFolder() {
    struct Folder {
        std::filesystem::path path;
        Folder() {
            std::string name = (std::filesystem::temp_directory_path() / "eyrie-XXXXXX").string();
            path = mkdtemp(name.data());
        }
        ~Folder() {
            std::error_code ignored;
            std::filesystem::remove_all(path, ignored);
        }
    };
    static const Folder folder;
    return folder.path;
}

absl::StatusOr<fabric::SceneObject> sampleMesh() {
    fabric::SceneObject object;
    object.name = "blob";
    object.path = sampleFolder() / "blob.eym";
    if (!std::filesystem::exists(object.path))
        RETURN_IF_ERROR(
            import::importMesh(import::synthesizeMesh(60000, kSeed), object.path).status());
    return object;
}

absl::StatusOr<fabric::SceneObject> sampleTerrain() {
    fabric::SceneObject object;
    object.name = "hills";
    object.kind = fabric::ObjectKind::Terrain;
    object.path = sampleFolder() / "hills.eyt";
    if (!std::filesystem::exists(object.path))
        RETURN_IF_ERROR(import::importTerrain(import::synthesizeTerrain(1025, kSeed),
                                              {.name = "hills", .crsWkt = "", .hash = kSeed},
                                              object.path, {})
                            .status());
    return object;
}

/// The transform that stands the mesh, scaled to a quarter of the terrain, on its middle.
absl::StatusOr<fabric::Mat4> onTop(const fabric::SceneObject& mesh,
                                   const fabric::SceneObject& terrain) {
    ASSIGN_OR_RETURN(const mesh::EymFile meshFile, mesh::EymFile::open(mesh.path));
    ASSIGN_OR_RETURN(const auto terrainFile, terrain::EytFile::open(terrain.path));
    const fabric::Box box = meshFile.bounds();
    const fabric::Box ground = terrainFile->index().bounds();
    const double scale = ground.size().x / 4 / box.size().x;
    return glm::translate(
        glm::scale(glm::translate(fabric::Mat4(1.0), ground.centre()), fabric::Vec3(scale)),
        -box.centre());
}

}  // namespace

std::string name(SampleKind kind) {
    switch (kind) {
        case SampleKind::Mesh:
            return "Mesh";
        case SampleKind::Terrain:
            return "Terrain";
        case SampleKind::Both:
            return "Both";
    }
    return "";
}

absl::StatusOr<fabric::Scene> sampleScene(SampleKind kind) {
    fabric::Scene scene;
    scene.lights.push_back({});
    if (kind != SampleKind::Terrain) {
        ASSIGN_OR_RETURN(fabric::SceneObject mesh, sampleMesh());
        scene.objects.push_back(mesh);
    }
    if (kind != SampleKind::Mesh) {
        ASSIGN_OR_RETURN(fabric::SceneObject terrain, sampleTerrain());
        scene.objects.push_back(terrain);
    }
    if (kind == SampleKind::Both) {
        ASSIGN_OR_RETURN(scene.objects[0].worldFromObject,
                         onTop(scene.objects[0], scene.objects[1]));
    }
    return scene;
}

}  // namespace eyrie::test
