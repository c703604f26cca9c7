// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/obj_materials.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <map>
#include <span>

#include <absl/status/statusor.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "renderer/import/obj_textures.h"
#include "renderer/import/texture_files.h"
#include "renderer/mesh/mapped_file.h"

namespace eyrie::import {
namespace {

namespace fs = std::filesystem;

/// What Assimp reads where a material file is missing.
std::string insteadOfMissing(const std::string& path) {
    return fs::path(path).filename().replace_extension(".mtl").string();
}

/// The name by which findTexture() finds beside the OBJ what it finds beside its material file.
std::string nameFromObj(const std::string& name, const std::string& path,
                        const std::string& library) {
    if (name.empty() || !findTexture(name, path).empty())
        return name;
    const std::string found = findTexture(name, path, library);
    const fs::path fromObj = fs::path(found).lexically_relative(fs::path(path).parent_path());
    return found.empty() ? name : fromObj.empty() ? found : fromObj.string();
}

std::map<std::string, ObjMaterial> materialsOf(std::string_view obj, const std::string& path) {
    std::map<std::string, ObjMaterial> materials;
    for (const std::string& name : materialFilesOf(obj, path)) {
        const std::string found = findTexture(name, path);
        const absl::StatusOr<mesh::MappedFile> file = mesh::MappedFile::open(found);
        if (found.empty() || !file.ok())
            continue;
        const auto bytes = file->bytes();
        auto more = objMaterialsOf({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        for (auto& [ignored, material] : more)
            material.texture.name = nameFromObj(material.texture.name, path, found);
        materials.merge(more);
    }
    return materials;
}

/// Assimp's shift comes before its scale.
void applyTexture(const ObjTexture& texture, aiMaterial& material) {
    const aiString name(texture.name);
    material.AddProperty(&name, AI_MATKEY_TEXTURE_DIFFUSE(0));
    if (texture.scale == glm::vec2(1) && texture.offset == glm::vec2(0))
        return;
    aiUVTransform transform;
    transform.mScaling = {texture.scale.x, texture.scale.y};
    transform.mTranslation = {texture.scale.x != 0 ? texture.offset.x / texture.scale.x : 0,
                              texture.scale.y != 0 ? texture.offset.y / texture.scale.y : 0};
    material.AddProperty(&transform, 1, AI_MATKEY_UVTRANSFORM_DIFFUSE(0));
}

void apply(const ObjMaterial& stated, aiMaterial& material) {
    if (stated.texture.name.empty())
        return;
    applyTexture(stated.texture, material);
    const aiColor3D white(1, 1, 1);
    if (!stated.hasColour)
        material.AddProperty(&white, 1, AI_MATKEY_COLOR_DIFFUSE);
}

}  // namespace

std::vector<std::string> materialFilesOf(std::string_view obj, const std::string& path) {
    std::vector<std::string> names = librariesOfObj(obj);
    for (std::string& name : names)
        if (findTexture(name, path).empty())
            name = insteadOfMissing(path);
    return names;
}

std::vector<std::string> applyObjMaterials(const std::string& path, std::string_view obj,
                                           const aiScene& scene) {
    const std::vector<std::string> libraries = librariesOfObj(obj);
    std::vector<std::string> missing, unknown;
    std::ranges::copy_if(libraries, std::back_inserter(missing),
                         [&](const std::string& name) { return findTexture(name, path).empty(); });
    const std::map<std::string, ObjMaterial> materials = materialsOf(obj, path);
    std::size_t otherColours = 0;
    for (aiMaterial* material : std::span(scene.mMaterials, scene.mNumMaterials)) {
        const std::string name = material->GetName().C_Str();
        if (const auto stated = materials.find(name); stated != materials.end()) {
            apply(stated->second, *material);
            otherColours += stated->second.hasOtherColour ? 1 : 0;
        } else if (name != AI_DEFAULT_MATERIAL_NAME) {
            unknown.push_back(name);
        }
    }
    std::vector<std::string> notes;
    if (otherColours > 0)
        notes.push_back(
            fmt::format("left out the colours of {} materials, which are given as 'xyz' or "
                        "'spectral': give them as red, green and blue",
                        otherColours));
    const std::string instead = insteadOfMissing(path);
    if (!missing.empty() && findTexture(instead, path).empty()) {
        notes.push_back(
            fmt::format("{} of {} material files are missing, and what they define is plain: "
                        "'{}'",
                        missing.size(), libraries.size(), missing.front()));
        return notes;
    }
    if (!missing.empty())
        notes.push_back(
            fmt::format("{} of {} material files are missing, and '{}' is read in their place: "
                        "'{}'",
                        missing.size(), libraries.size(), instead, missing.front()));
    if (!unknown.empty())
        notes.push_back(
            fmt::format("{} materials are used that no material file defines, and what has them is "
                        "plain: '{}'",
                        unknown.size(), unknown.front()));
    return notes;
}

}  // namespace eyrie::import
