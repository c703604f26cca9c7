// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_colours.h"

#include <algorithm>
#include <array>
#include <span>

#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "renderer/import/byte_colours.h"
#include "renderer/import/dxf_colours.h"

namespace eyrie::import {
namespace {

bool isBelowZero(const aiColor4D& colour) {
    return !(colour.r >= 0 && colour.g >= 0 && colour.b >= 0 && colour.a >= 0);
}

bool isNothing(const aiColor4D& colour) { return colour == aiColor4D(0, 0, 0, 0); }

/// Assimp's of facets of STL without a colour, beside others that have one.
bool isNoneOfStl(const aiColor4D& colour) { return colour == aiColor4D(0.6F, 0.6F, 0.6F, 0.6F); }

}  // namespace

AssimpColours::AssimpColours(const aiScene& scene, const AssimpFormat& format) : format_(format) {
    constexpr std::array kMayBeBytes = {".obj", ".off"};
    for (const aiMesh* mesh : std::span(scene.mMeshes, scene.mNumMeshes))
        ofMeshes_.push_back(look(*mesh));
    if (std::ranges::count(kMayBeBytes, format.extension) == 0)
        return;
    bool areBytes = false;
    for (unsigned int mesh = 0; mesh < scene.mNumMeshes; ++mesh)
        for (unsigned int i = 0; i < scene.mMeshes[mesh]->mNumVertices && !areBytes; ++i) {
            const aiColor4D colour = of(mesh, i);
            areBytes = std::max({colour.r, colour.g, colour.b}) > kMostOfFractions;
        }
    areBytes_ = areBytes;
}

/// Assimp gives AMF's vertices the colour 0, 0, 0, 0 where the file has none, takes Blender's bytes
/// for signed ones, and begins to read colours of OFF with the z of a normal before them. glTF's
/// mean what they say. Where the file has no alpha, it is 0 of some formats', and another of DXF's,
/// the colours of which it takes from another table (dxf_colours.h).
AssimpColours::OfMesh AssimpColours::look(const aiMesh& mesh) {
    if (mesh.mColors[0] == nullptr)
        return {};
    if (const auto colour =
            format_.extension == ".dxf" ? colourOfDxfLayer(mesh.mName.C_Str()) : std::nullopt)
        return {mesh.mColors[0], true, false,
                aiColor4D(static_cast<float>(colour->r) / 255, static_cast<float>(colour->g) / 255,
                          static_cast<float>(colour->b) / 255, 1)};
    const std::span colours(mesh.mColors[0], mesh.mNumVertices);
    const bool haveNoAlpha =
        format_.extension == ".dxf" ||
        std::ranges::all_of(colours, [](const aiColor4D& colour) { return colour.a == 0; });
    if (format_.hasLinearColours)
        return {mesh.mColors[0], haveNoAlpha, false};
    const bool isShifted = format_.extension == ".off" && mesh.mNormals != nullptr;
    const bool isWrong = !isShifted && std::ranges::any_of(colours, isBelowZero);
    wrong_ += isWrong ? 1 : 0;
    if (isWrong || std::ranges::all_of(colours, isNothing))
        return {};
    return {mesh.mColors[0], isShifted || haveNoAlpha, isShifted};
}

bool AssimpColours::areAny() const {
    return std::ranges::any_of(ofMeshes_,
                               [](const OfMesh& mesh) { return mesh.colours != nullptr; });
}

aiColor4D AssimpColours::of(unsigned int mesh, unsigned int vertex) const {
    const OfMesh& ofMesh = ofMeshes_[mesh];
    if (ofMesh.colours == nullptr)
        return {1, 1, 1, 1};
    if (ofMesh.ofAll)
        return *ofMesh.ofAll;
    aiColor4D colour = ofMesh.colours[vertex];
    if (format_.extension == ".stl" && isNoneOfStl(colour))
        colour.a = 1;
    if (format_.extension == ".amf" && isNothing(colour))
        return {1, 1, 1, 1};
    if (ofMesh.areShifted)
        colour = {colour.g, colour.b, colour.a, 1};
    if (ofMesh.areOpaque)
        colour.a = 1;
    if (areBytes_)  // where the alpha is 1 if the file has none
        colour = {colour.r / 255, colour.g / 255, colour.b / 255,
                  colour.a > 1 ? colour.a / 255 : colour.a};
    return colour;
}

std::vector<std::string> AssimpColours::notes() const {
    std::vector<std::string> notes;
    if (wrong_ > 0)
        notes.push_back(
            fmt::format("left out vertices' colours of {} of {} meshes, which are below 0", wrong_,
                        ofMeshes_.size()));
    if (areBytes_)
        notes.emplace_back(kColoursAreBytes);
    return notes;
}

}  // namespace eyrie::import
