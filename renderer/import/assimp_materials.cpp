// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_materials.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <fmt/format.h>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

namespace eyrie::import {
namespace {

/// Where places come to, v upwards. What an aiUVTransform means depends on the format, whatever
/// Assimp's own step makes of it (TextureTransform.cpp: scaled and turned about the middle).
///
/// Shifted, turned counter-clockwise and scaled is X3D's (ISO/IEC 19775-1, 18.4.8; its centre is in
/// the shift, x3d_text.h), and what OBJ's has been brought to. AC3D's shift comes last, as in the
/// loader that its author gives away. FBX's angles are in degrees. In which order FBX, 3DS, ASE,
/// COB and what Maya adds to COLLADA shift, turn and scale, and about what, is written down
/// nowhere, and programs disagree: they are taken as X3D's.
glm::dmat3 matrixOf(const aiUVTransform& transform, std::string_view extension) {
    const double unit = extension == ".fbx" ? glm::radians(1.0) : 1;
    const double c = std::cos(unit * double{transform.mRotation});
    const double s = std::sin(unit * double{transform.mRotation});
    const glm::dmat3 scale(transform.mScaling.x, 0, 0, 0, transform.mScaling.y, 0, 0, 0, 1);
    const glm::dmat3 turn(c, s, 0, -s, c, 0, 0, 0, 1);
    const glm::dmat3 shift(1, 0, 0, 0, 1, 0, transform.mTranslation.x, transform.mTranslation.y, 1);
    return extension.starts_with(".ac") ? shift * scale * turn : scale * turn * shift;
}

/// That of glTF's KHR_texture_transform: scaled, turned counter-clockwise as seen with v downwards,
/// and shifted. Assimp hands on another shift, which makes up for a turn about the middle that its
/// own step does not make; here it is taken back.
glm::dmat3 gltfMatrixOf(const aiUVTransform& transform) {
    const glm::dvec2 scale(transform.mScaling.x, transform.mScaling.y);
    const double c = std::cos(-double{transform.mRotation});
    const double s = std::sin(-double{transform.mRotation});
    const glm::dvec2 offset(transform.mTranslation.x - scale.x * (1 - c + s) / 2,
                            scale.y * (s + c - 1) / 2 + 1 - scale.y - transform.mTranslation.y);
    const glm::dmat3 downFromDown(scale.x * c, -scale.x * s, 0, scale.y * s, scale.y * c, 0,
                                  offset.x, offset.y, 1);
    const glm::dmat3 flip(1, 0, 0, 0, -1, 0, 0, 1, 1);
    return flip * downFromDown * flip;
}

/// Texels that are not coded, which none of the formats has in use, are left out.
TextureSource embedded(const aiTexture& texture, const char* name) {
    TextureSource source{name, {}, 0};
    if (texture.mHeight != 0)
        return source;
    const auto* bytes = reinterpret_cast<const std::byte*>(texture.pcData);
    source.bytes.assign(bytes, bytes + texture.mWidth);
    return source;
}

enum class AlphaMode { Unknown, Opaque, Mask, Blend };  ///< glTF's, which alone has them

AlphaMode alphaModeOf(const aiMaterial& material) {
    aiString mode;
    if (material.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) != AI_SUCCESS)
        return AlphaMode::Unknown;
    const std::string_view word(mode.C_Str());
    return word == "BLEND"  ? AlphaMode::Blend
           : word == "MASK" ? AlphaMode::Mask
                            : AlphaMode::Opaque;
}

/// 0 where a material does not say.
int sidesOf(const aiMaterial& material) {
    int isTwoSided = 0;
    return material.Get(AI_MATKEY_TWOSIDED, isTwoSided) != AI_SUCCESS ? 0 : isTwoSided != 0 ? 2 : 1;
}

std::string textureName(const aiMaterial& material, aiTextureType type, unsigned int index) {
    aiString path;
    return material.GetTexture(type, index, &path) == AI_SUCCESS ? path.C_Str() : "";
}

/// Of the texture that a material's diffuse colour has. FBX's physical materials have a base colour
/// alone, glTF's both.
aiTextureType colourTypeOf(const aiMaterial& material) {
    return material.GetTextureCount(aiTextureType_DIFFUSE) > 0 ? aiTextureType_DIFFUSE
                                                               : aiTextureType_BASE_COLOR;
}

/// Whether a material has a texture of `type` besides the one of its diffuse colour. Formats that
/// know opacity by the alpha of that name it twice.
bool hasOtherTexture(const aiMaterial& material, aiTextureType type) {
    const aiTextureType colourType = colourTypeOf(material);
    if (type == colourType)
        return false;
    const std::string diffuse = textureName(material, colourType, 0);
    for (unsigned int i = 0; i < material.GetTextureCount(type); ++i)
        if (const std::string name = textureName(material, type, i);
            !name.empty() && name != diffuse)
            return true;
    return false;
}

/// glTF's magFilter NEAREST.
bool asksForSquares(const aiMaterial& material, aiTextureType type) {
    constexpr int kNearest = 9728;
    int filter = 0;
    return material.Get(AI_MATKEY_GLTF_MAPPINGFILTER_MAG(type, 0), filter) == AI_SUCCESS &&
           filter == kNearest;
}

float cutoffOf(const aiMaterial& material) {
    float cutoff = 0.5F;
    material.Get(AI_MATKEY_GLTF_ALPHACUTOFF, cutoff);
    return std::isfinite(cutoff) ? std::clamp(cutoff, 0.0F, 1.0F) : 0.5F;
}

}  // namespace

AssimpMaterials::AssimpMaterials(const aiScene& scene, const AssimpFormat& format)
    : scene_(scene), format_(format) {
    const std::span materials(scene.mMaterials, scene.mNumMaterials);
    hasSides_ = std::ranges::any_of(
        materials, [](const aiMaterial* material) { return sidesOf(*material) == 2; });
    for (const aiMaterial* material : materials) {
        entries_.push_back(read(*material));
        countLeftOut(*material);
    }
}

/// Beyond what can be told apart all are plain.
std::uint16_t AssimpMaterials::number(const mesh::Material& material) {
    const auto known = std::find(materials_.begin(), materials_.end(), material);
    const auto number = static_cast<std::size_t>(known - materials_.begin());
    if (number == mesh::kMaxMaterials)
        return 0;
    if (known == materials_.end())
        materials_.push_back(material);
    return static_cast<std::uint16_t>(number);
}

/// Its number in textures_; -1 where the material has none.
std::int32_t AssimpMaterials::readTexture(const aiMaterial& material, Entry& entry) {
    aiString path;
    aiTextureMapMode modes[2] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
    aiTextureMapping mapping = aiTextureMapping_UV;
    const aiTextureType type = colourTypeOf(material);
    if (material.GetTexture(type, 0, &path, &mapping, &entry.channel, nullptr, nullptr, modes) !=
            AI_SUCCESS ||
        path.length == 0 || std::string_view(path.C_Str()).starts_with("$texture_dummy"))
        return -1;  // Quake's formats name none
    entry.isProjected = mapping != aiTextureMapping_UV;
    aiUVTransform transform;
    if (material.Get(AI_MATKEY_UVTRANSFORM(type, 0), transform) == AI_SUCCESS)
        entry.placeFromSource =
            format_.isGltf() ? gltfMatrixOf(transform) : matrixOf(transform, format_.extension);
    if (format_.extension == ".x3d")  // which hands on as the mode whether they repeat
        for (aiTextureMapMode& mode : modes)
            mode = mode == aiTextureMapMode_Wrap ? aiTextureMapMode_Clamp : aiTextureMapMode_Wrap;
    const aiTexture* own = scene_.GetEmbeddedTexture(path.C_Str());
    TextureSource source =
        own != nullptr ? embedded(*own, path.C_Str()) : TextureSource{path.C_Str(), {}, 0};
    const auto ends = [](aiTextureMapMode mode) {
        return mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal;
    };
    source.flags = (ends(modes[0]) ? mesh::kClampsU : 0) | (ends(modes[1]) ? mesh::kClampsV : 0);
    const auto known = std::find(textures_.begin(), textures_.end(), source);
    const auto number = static_cast<std::int32_t>(known - textures_.begin());
    if (known == textures_.end())
        textures_.push_back(std::move(source));
    squared_ += asksForSquares(material, type) ? 1 : 0;
    mirrored_ += std::ranges::count(modes, aiTextureMapMode_Mirror) > 0 ? 1 : 0;
    decals_ += std::ranges::count(modes, aiTextureMapMode_Decal) > 0 ? 1 : 0;
    return number;
}

void AssimpMaterials::countLeftOut(const aiMaterial& material) {
    bool isAny = false;
    for (int type = aiTextureType_NONE; type <= AI_TEXTURE_TYPE_MAX; ++type)
        isAny = isAny || hasOtherTexture(material, static_cast<aiTextureType>(type));
    withOthers_ += isAny ? 1 : 0;
    withOpacity_ += hasOtherTexture(material, aiTextureType_OPACITY) ? 1 : 0;
    aiColor4D own(1, 1, 1, 1), emitted(0, 0, 0, 1);
    material.Get(AI_MATKEY_COLOR_DIFFUSE, own);
    material.Get(AI_MATKEY_COLOR_EMISSIVE, emitted);
    emitting_ += emitted.r > own.r || emitted.g > own.g || emitted.b > own.b ? 1 : 0;
}

AssimpMaterials::Entry AssimpMaterials::read(const aiMaterial& material) {
    Entry entry;
    mesh::Material drawn;
    material.Get(AI_MATKEY_COLOR_DIFFUSE, entry.colour);
    material.Get(AI_MATKEY_OPACITY, entry.colour.a);
    const int sides = hasSides_ ? sidesOf(material) : 0;
    drawn.flags = sides == 2 ? mesh::kIsTwoSided : sides == 1 ? mesh::kIsOneSided : 0;
    const AlphaMode mode = alphaModeOf(material);
    if (mode == AlphaMode::Unknown && entry.colour.a <= 0) {
        takenForOpaque_ += format_.extension == ".3mf" ? 0 : 1;  // which may have none
        entry.colour.a = 1;
    }
    entry.isOpaque = mode == AlphaMode::Opaque;
    entry.cutoff = mode == AlphaMode::Mask ? cutoffOf(material) : 0;
    if (mode == AlphaMode::Blend || (mode == AlphaMode::Unknown && entry.colour.a < 1))
        drawn.flags |= mesh::kIsBlended;
    entry.withoutImage = number(drawn);
    entry.number = entry.withoutImage;
    drawn.image = readTexture(material, entry);
    entry.isUnseen =
        entry.colour.a <= 0 && (mode == AlphaMode::Blend || (entry.cutoff > 0 && drawn.hasImage()));
    if (!drawn.hasImage())
        return entry;
    drawn.alphaCutoff = entry.cutoff;
    if (mode == AlphaMode::Unknown)
        drawn.flags |= kAlphaByImage;
    const bool isBlack = entry.colour.r == 0 && entry.colour.g == 0 && entry.colour.b == 0;
    if (format_.texturesReplaceColours || (isBlack && !format_.isGltf()))
        drawn.flags |= kReplacesColour;
    entry.number = number(drawn);
    return entry;
}

const AssimpMaterials::Entry* AssimpMaterials::find(const aiMesh& mesh) const {
    return mesh.mMaterialIndex < entries_.size() ? &entries_[mesh.mMaterialIndex] : nullptr;
}

/// Of COLLADA, where a mesh has not got what the material names, its first, as Assimp guesses by a
/// digit in the name.
const aiVector3D* AssimpMaterials::placesOf(const aiMesh& mesh, const Entry& entry) const {
    const bool isGuess = format_.extension == ".dae" || format_.extension == ".zae";
    if (entry.isProjected)
        return nullptr;
    if (mesh.HasTextureCoords(entry.channel))
        return mesh.mTextureCoords[entry.channel];
    return isGuess ? mesh.mTextureCoords[0] : nullptr;
}

std::uint16_t AssimpMaterials::numberOf(const aiMesh& mesh) const {
    const Entry* entry = find(mesh);
    if (entry == nullptr)
        return 0;
    return placesOf(mesh, *entry) != nullptr ? entry->number : entry->withoutImage;
}

aiColor4D AssimpMaterials::colourOf(const aiMesh& mesh) const {
    const Entry* entry = find(mesh);
    return entry != nullptr ? entry->colour : aiColor4D(1, 1, 1, 1);
}

bool AssimpMaterials::isOpaque(const aiMesh& mesh) const {
    const Entry* entry = find(mesh);
    return entry == nullptr || entry->isOpaque;
}

bool AssimpMaterials::mayShowWhatIsBehind(const aiMesh& mesh) const {
    const mesh::Material& material = materials_[numberOf(mesh)];
    return material.isSeeThrough() || (material.flags & kAlphaByImage) != 0;
}

float AssimpMaterials::cutoffWithoutImage(const aiMesh& mesh) const {
    const Entry* entry = find(mesh);
    return entry == nullptr || materials_[numberOf(mesh)].hasImage() ? 0 : entry->cutoff;
}

/// Assimp's v goes up.
glm::vec2 AssimpMaterials::textureCoordinates(const aiMesh& mesh, unsigned int vertex) const {
    if (!materials_[numberOf(mesh)].hasImage())
        return glm::vec2(0);
    const Entry& entry = *find(mesh);
    const aiVector3D& source = placesOf(mesh, entry)[vertex];
    const glm::dvec3 place = entry.placeFromSource * glm::dvec3(source.x, source.y, 1);
    return {static_cast<float>(place.x), static_cast<float>(1 - place.y)};
}

void AssimpMaterials::moveTo(TriangleMesh& mesh) {
    if (takenForOpaque_ > 0)
        mesh.notes.push_back(fmt::format(
            "{} of {} materials have no opacity at all, and nobody would see them: they "
            "are taken for opaque",
            takenForOpaque_, entries_.size()));
    if (withOthers_ > 0)
        mesh.notes.push_back(fmt::format(
            "left out the textures of {} materials that are of something else than the diffuse "
            "colour{}",
            withOthers_,
            withOpacity_ > 0
                ? fmt::format(", among them the opacity of {}: what these make holes in has none; "
                              "give the opacity as the alpha of the colour's image",
                              withOpacity_)
                : ""));
    if (emitting_ > 0)
        mesh.notes.push_back(
            fmt::format("left out the light of {} of {} materials that emit more than they "
                        "reflect: they are darker than they ought to be",
                        emitting_, entries_.size()));
    const std::span meshes(scene_.mMeshes, scene_.mNumMeshes);
    const auto unseen = std::ranges::count_if(meshes, [this](const aiMesh* one) {
        const Entry* entry = find(*one);
        return entry != nullptr && entry->isUnseen;
    });
    if (unseen > 0)
        mesh.notes.push_back(
            fmt::format("nobody sees {} of {} meshes: their materials are see-through and have an "
                        "alpha of 0",
                        unseen, meshes.size()));
    const auto withoutPlaces = std::ranges::count_if(meshes, [this](const aiMesh* one) {
        const Entry* entry = find(*one);
        return entry != nullptr && entry->number != entry->withoutImage &&
               placesOf(*one, *entry) == nullptr;
    });
    if (withoutPlaces > 0)
        mesh.notes.push_back(
            fmt::format("left out the textures of {} of {} meshes, which have no texture "
                        "coordinates: bake projections into a UV map",
                        withoutPlaces, meshes.size()));
    if (mirrored_ > 0)
        mesh.notes.push_back(
            fmt::format("textures of {} materials ought to be mirrored where they repeat, and "
                        "repeat as they are",
                        mirrored_));
    if (decals_ > 0)
        mesh.notes.push_back(
            fmt::format("textures of {} materials ought to leave free what is beyond their edges, "
                        "and cover it with these",
                        decals_));
    if (squared_ > 0)
        mesh.notes.push_back(
            fmt::format("textures of {} materials ought to show their texels as squares (magFilter "
                        "NEAREST), and are smoothed between them",
                        squared_));
    if (!areAny())
        return;
    mesh.materials = std::move(materials_);
    mesh.textures = std::move(textures_);
}

}  // namespace eyrie::import
