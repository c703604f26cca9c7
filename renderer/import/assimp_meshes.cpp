// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_meshes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <absl/status/status.h>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "fabric/box.h"
#include "fabric/status.h"
#include "renderer/import/assimp_axes.h"
#include "renderer/import/assimp_colours.h"
#include "renderer/import/assimp_lights.h"
#include "renderer/import/assimp_materials.h"
#include "renderer/import/assimp_rounding.h"
#include "renderer/import/assimp_values.h"
#include "renderer/import/polygon.h"

namespace eyrie::import {
namespace {

/// Of surfaces without a material, where others have one.
const aiColor4D kPlain{0.8F, 0.8F, 0.8F, 1.0F};

std::uint8_t byteOf(float value, bool isLinear) {
    double shown = std::isfinite(value) ? std::clamp(double{value}, 0.0, 1.0) : 1.0;
    if (isLinear)  // IEC 61966-2-1
        shown = shown <= 0.0031308 ? 12.92 * shown : 1.055 * std::pow(shown, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * shown));
}

/// That of OFF, whose files have none, has no name and is grey; 3DS has a name of its own for one.
bool hasOwnMaterial(const aiMaterial& material, const AssimpFormat& format) {
    constexpr std::array<std::string_view, 2> kNotOwn = {AI_DEFAULT_MATERIAL_NAME, "%%%DEFAULT"};
    aiString name;
    aiColor4D ignored;
    return format.extension != ".off" &&
           material.Get(AI_MATKEY_COLOR_DIFFUSE, ignored) == AI_SUCCESS &&
           !(material.Get(AI_MATKEY_NAME, name) == AI_SUCCESS &&
             std::ranges::count(kNotOwn, std::string_view(name.C_Str())) > 0);
}

/// Whether a mesh shows others' shapes besides its own.
bool isMorphed(const aiMesh* mesh) {
    return std::ranges::any_of(std::span(mesh->mAnimMeshes, mesh->mNumAnimMeshes),
                               [](const aiAnimMesh* shape) { return shape->mWeight != 0; });
}

/// Gathers what the nodes of a scene show.
class SceneMeshes {
public:
    SceneMeshes(const aiScene& scene, const AssimpFormat& format, std::string_view text)
        : scene_(scene),
          format_(format),
          text_(text),
          materials_(scene, format),
          colours_(scene, format),
          isRounded_(!hasSingleCoordinates(format, text)) {
        hasColours_ = colours_.areAny();
        for (unsigned int i = 0; i < scene.mNumMeshes; ++i) {
            const aiMesh& mesh = *scene.mMeshes[i];
            hasNormals_ = hasNormals_ || mesh.mNormals != nullptr;
            hasColours_ = hasColours_ || materialOf(mesh) != nullptr;
        }
    }

    absl::StatusOr<TriangleMesh> gather();

private:
    const aiMaterial* materialOf(const aiMesh& mesh) const;
    absl::Status add(unsigned int number, const AssimpPlace& place);
    absl::Status addVertices(const aiMesh& mesh, const AssimpPlace& place);
    void addColours(unsigned int number);
    void addTextureCoordinates(const aiMesh& mesh);
    absl::Status addFaces(const aiMesh& mesh, std::uint32_t first, bool isMirrored);
    absl::Status addFace(const aiFace& face, std::uint32_t first);
    void cutAway(const aiMesh& mesh, std::size_t firstTriangle);
    void noteWhatIsLeftOut();
    void noteRounding();

    const aiScene& scene_;
    const AssimpFormat& format_;
    std::string_view text_;
    AssimpMaterials materials_;
    AssimpColours colours_;
    bool hasNormals_ = false;
    bool hasColours_ = false;
    bool isRounded_;
    std::size_t cutAway_ = 0;
    std::size_t notOpaque_ = 0;  // vertices that are shown as if they were
    TriangleMesh result_;
    std::vector<std::uint32_t> corners_;  // of the face being added
};

const aiMaterial* SceneMeshes::materialOf(const aiMesh& mesh) const {
    if (mesh.mMaterialIndex >= scene_.mNumMaterials)
        return nullptr;
    const aiMaterial* material = scene_.mMaterials[mesh.mMaterialIndex];
    return hasOwnMaterial(*material, format_) ? material : nullptr;
}

absl::Status SceneMeshes::addVertices(const aiMesh& mesh, const AssimpPlace& place) {
    const glm::dmat4& worldFromMesh = place.worldFromNode();
    const glm::dmat3 worldFromNormal = glm::transpose(glm::inverse(glm::dmat3(worldFromMesh)));
    for (unsigned int i = 0; i < mesh.mNumVertices; ++i) {
        const aiVector3D& v = mesh.mVertices[i];
        const fabric::Vec3 position(worldFromMesh * glm::dvec4(v.x, v.y, v.z, 1));
        if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z))
            return absl::InvalidArgumentError(fmt::format(
                "mesh '{}', vertex {}: found {}, {}, {}, expected finite coordinates; remove or "
                "repair the vertex",
                mesh.mName.C_Str(), i, position.x, position.y, position.z));
        result_.positions.push_back(position);
        result_.roundingMetres =
            std::max(result_.roundingMetres,
                     place.roundingMetres(glm::length(glm::dvec3(v.x, v.y, v.z)), isRounded_));
        if (!hasNormals_)
            continue;
        const aiVector3D n = mesh.mNormals != nullptr ? mesh.mNormals[i] : aiVector3D();
        result_.normals.emplace_back(worldFromNormal * glm::dvec3(n.x, n.y, n.z));
    }
    return absl::OkStatus();
}

void SceneMeshes::addColours(unsigned int number) {
    const aiMesh& mesh = *scene_.mMeshes[number];
    const aiMaterial* material = materialOf(mesh);
    aiColor4D diffuse = colours_.areAnyOf(number) ? aiColor4D(1, 1, 1, 1) : kPlain;
    if (material != nullptr)
        diffuse = materials_.colourOf(mesh);
    if (format_.extension == ".x3d" && colours_.areAnyOf(number))
        diffuse = {1, 1, 1, diffuse.a};  // where these stand for the material's
    const bool isOpaque = !format_.isGltf() && !materials_.mayShowWhatIsBehind(mesh);
    for (unsigned int i = 0; i < mesh.mNumVertices; ++i) {
        const aiColor4D own = colours_.of(number, i);
        notOpaque_ += isOpaque && own.a < 1 ? 1 : 0;
        const auto shown = [this](float value) { return byteOf(value, format_.hasLinearColours); };
        result_.colours.push_back(
            {shown(diffuse.r * own.r), shown(diffuse.g * own.g), shown(diffuse.b * own.b),
             byteOf(materials_.isOpaque(mesh) ? 1.0F : diffuse.a * own.a, false)});
    }
}

void SceneMeshes::addTextureCoordinates(const aiMesh& mesh) {
    result_.materialOf.resize(result_.positions.size(), materials_.numberOf(mesh));
    for (unsigned int i = 0; i < mesh.mNumVertices && materials_.hasTextures(); ++i)
        result_.textureCoordinates.push_back(materials_.textureCoordinates(mesh, i));
}

absl::Status SceneMeshes::addFace(const aiFace& face, std::uint32_t first) {
    if (face.mNumIndices < 3) {
        ++result_.droppedFaces;
        return absl::OkStatus();
    }
    corners_.clear();
    for (unsigned int i = 0; i < face.mNumIndices; ++i) {
        if (face.mIndices[i] >= result_.positions.size() - first)
            return absl::InvalidArgumentError(fmt::format(
                "found the corner {}, expected a vertex from 0 to {}; export the mesh again",
                face.mIndices[i], result_.positions.size() - first));
        corners_.push_back(first + face.mIndices[i]);
    }
    if (corners_.size() == 3)
        result_.triangles.push_back({corners_[0], corners_[1], corners_[2]});
    else if (!triangulatePolygon(result_.positions, corners_, result_.triangles))
        return absl::InvalidArgumentError(fmt::format(
            "found a concave polygon of {} corners, expected at most {}; triangulate it before "
            "export",
            corners_.size(), kMaxConcaveCorners));
    return absl::OkStatus();
}

absl::Status SceneMeshes::addFaces(const aiMesh& mesh, std::uint32_t first, bool isMirrored) {
    const std::size_t firstTriangle = result_.triangles.size();
    for (unsigned int i = 0; i < mesh.mNumFaces; ++i)
        if (const absl::Status added = addFace(mesh.mFaces[i], first); !added.ok())
            return fabric::withContext(added,
                                       fmt::format("mesh '{}', face {}", mesh.mName.C_Str(), i));
    if (isMirrored)
        for (std::size_t i = firstTriangle; i < result_.triangles.size(); ++i)
            std::swap(result_.triangles[i][1], result_.triangles[i][2]);
    return absl::OkStatus();
}

/// Takes away the triangles that are one hole by the alpha of their corners.
void SceneMeshes::cutAway(const aiMesh& mesh, std::size_t firstTriangle) {
    const std::uint8_t least = byteOf(materials_.cutoffWithoutImage(mesh), false);
    const auto isCut = [&](std::uint32_t corner) { return result_.colours[corner].a < least; };
    const auto cut =
        std::remove_if(result_.triangles.begin() + static_cast<std::ptrdiff_t>(firstTriangle),
                       result_.triangles.end(),
                       [&](const auto& triangle) { return std::ranges::all_of(triangle, isCut); });
    cutAway_ += static_cast<std::size_t>(result_.triangles.end() - cut);
    result_.triangles.erase(cut, result_.triangles.end());
}

absl::Status SceneMeshes::add(unsigned int number, const AssimpPlace& place) {
    const aiMesh& mesh = *scene_.mMeshes[number];
    const std::size_t first = result_.positions.size();
    if (first + mesh.mNumVertices >= std::numeric_limits<std::uint32_t>::max())
        return absl::InvalidArgumentError(
            "found more than 2^32 vertices, all instances of meshes counted; import it in parts");
    RETURN_IF_ERROR(addVertices(mesh, place));
    if (hasColours_)
        addColours(number);
    if (materials_.areAny())
        addTextureCoordinates(mesh);
    const std::size_t firstTriangle = result_.triangles.size();
    RETURN_IF_ERROR(addFaces(mesh, static_cast<std::uint32_t>(first),
                             glm::determinant(glm::dmat3(place.worldFromNode())) < 0));
    if (hasColours_)
        cutAway(mesh, firstTriangle);
    return absl::OkStatus();
}

void SceneMeshes::noteWhatIsLeftOut() {
    for (std::string& note : colours_.notes()) result_.notes.push_back(std::move(note));
    if (scene_.mNumAnimations > 0)
        result_.notes.push_back(
            fmt::format("left out its animations, {} of them: everything stays where "
                        "the file's nodes put it",
                        scene_.mNumAnimations));
    if (cutAway_ > 0)
        result_.notes.push_back(fmt::format(
            "left out {} triangles whose opacity is below the cutoff of their material, "
            "which nobody would see",
            cutAway_));
    if (notOpaque_ > 0)
        result_.notes.push_back(
            fmt::format("{} vertices are not opaque, which is left out, as their materials are: "
                        "for see-through surfaces export it as glTF",
                        notOpaque_));
    const std::span meshes(scene_.mMeshes, scene_.mNumMeshes);
    const auto bent =
        std::ranges::count_if(meshes, [](const aiMesh* one) { return one->HasBones(); });
    if (bent > 0)
        result_.notes.push_back(
            fmt::format("left out the skeletons of {} of {} meshes: what these bend or move is as "
                        "it was made, where its node is",
                        bent, scene_.mNumMeshes));
    const auto morphed = std::ranges::count_if(meshes, isMorphed);
    if (morphed > 0)
        result_.notes.push_back(
            fmt::format("left out the morph targets of {} of {} meshes: these have their basic "
                        "shape; apply the shape keys before export",
                        morphed, scene_.mNumMeshes));
}

/// Assimp keeps coordinates in single precision. Of a model around 0 that loses nothing that one
/// sees; of one that stands in the coordinates of a country it loses decimetres.
void SceneMeshes::noteRounding() {
    constexpr double kSeen = 7e-5;  // of the longest side; most are moved by a seventh of it
    fabric::Box bounds;
    for (const fabric::Vec3& position : result_.positions) bounds.grow(position);
    const fabric::Vec3 size = bounds.size();
    const double rounding = result_.roundingMetres;
    if (rounding > kSeen * std::max({size.x, size.y, size.z}))
        result_.notes.push_back(
            fmt::format("coordinates are rounded, by up to {:.2g} m: they, or what their "
                        "nodes move them by, are far from 0, and read in single precision; export "
                        "the mesh nearer to 0, or as "
                        "PLY with coordinates of the type double",
                        rounding));
}

absl::StatusOr<TriangleMesh> SceneMeshes::gather() {
    struct Placed {
        const aiNode* node;
        AssimpPlace place;
    };
    const double metresPerUnit = metresPerUnitOf(scene_, format_, text_, result_.notes);
    const glm::dmat4 worldFromScene =
        glm::scale(zUpFromScene(scene_, format_), glm::dvec3(metresPerUnit));
    std::vector<Placed> waiting;
    if (scene_.mRootNode != nullptr)
        waiting.push_back(
            {scene_.mRootNode,
             AssimpPlace(worldFromScene).child(toDouble(scene_.mRootNode->mTransformation))});
    while (!waiting.empty()) {
        const auto [node, place] = waiting.back();
        waiting.pop_back();
        for (unsigned int i = 0; i < node->mNumMeshes; ++i)
            if (node->mMeshes[i] < scene_.mNumMeshes)
                RETURN_IF_ERROR(add(node->mMeshes[i], place));
        for (unsigned int i = node->mNumChildren; i-- > 0;)
            waiting.push_back(
                {node->mChildren[i], place.child(toDouble(node->mChildren[i]->mTransformation))});
    }
    if (result_.triangles.empty())
        return absl::InvalidArgumentError(
            fmt::format("found no face with three corners or more ({} with fewer), expected at "
                        "least one; export the mesh again with its faces",
                        result_.droppedFaces));
    materials_.moveTo(result_);
    result_.lights =
        lightsOf(scene_, format_.extension, worldFromScene, metresPerUnit, result_.notes);
    if (metresPerUnit != 1)
        result_.notes.push_back(fmt::format(
            "brought to metres: the file says that its unit is {:.6g} m", metresPerUnit));
    noteWhatIsLeftOut();
    noteRounding();
    return std::move(result_);
}

}  // namespace

absl::StatusOr<TriangleMesh> gatherMeshes(const aiScene& scene, const AssimpFormat& format,
                                          std::string_view text) {
    return SceneMeshes(scene, format, text).gather();
}

}  // namespace eyrie::import
