// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/ply_textures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/import/mesh_reader.h"
#include "renderer/mesh/material.h"

namespace eyrie::import {
namespace {

/// In TriangleMesh::materialOf: of a vertex that no corner has had yet.
constexpr std::uint16_t kNotYet = std::numeric_limits<std::uint16_t>::max();
static_assert(kNotYet >= mesh::kMaxMaterials, "no material has this number");

/// The first material is plain.
constexpr std::size_t kMostImages = mesh::kMaxMaterials - 1;

bool isNumber(const glm::vec2& place) { return std::isfinite(place.x) && std::isfinite(place.y); }

/// A file that has colours beside textures has those of its scan: they are of use where an image is
/// missing.
void addMaterials(TriangleMesh& mesh, std::vector<std::string> names) {
    names.resize(std::min(names.size(), kMostImages));
    mesh.materials.emplace_back();
    for (std::string& name : names) {
        mesh.materials.push_back({.image = static_cast<std::int32_t>(mesh.textures.size()),
                                  .flags = kAlphaByImage | kReplacesColour});
        mesh.textures.push_back({std::move(name), {}, 0});
    }
    if (mesh.colours.empty())
        mesh.colours.assign(mesh.positions.size(), kPlainColour);
}

}  // namespace

std::vector<std::string> textureNames(const PlyHeader& header, const std::string& path) {
    static constexpr std::string_view kThis = "<this>";
    const std::string own = std::filesystem::path(path).stem().string();
    std::vector<std::string> names = header.textureFiles;
    for (std::string& name : names)
        if (const std::size_t at = name.find(kThis); at != std::string::npos)
            name.replace(at, kThis.size(), own);
    return names;
}

glm::vec2 placeFrom(double u, double v) {
    return {static_cast<float>(u), static_cast<float>(1 - v)};
}

PlyTextures::Look PlyTextures::plain() const {
    return {static_cast<std::uint16_t>(layout_.ofFaces == nullptr ? 1 : 0), glm::vec2(0)};
}

/// None where the file says so by a number below 0.
std::uint16_t PlyTextures::materialOf(std::uint64_t index, double number) {
    if (number < 0)
        return 0;
    if (number < static_cast<double>(std::min(layout_.images, kMostImages)))
        return static_cast<std::uint16_t>(number + 1);
    wrongNumbers_.add(index);
    return 0;
}

void PlyTextures::addFace(std::uint64_t index, std::uint64_t corners,
                          std::span<const double> places, double number, std::size_t triangles) {
    if (corners < 3)
        return;
    std::vector<Look>& looks = corners == 3 ? ofTriangles_ : ofPolygons_;
    if (corners == 3)
        looks.resize(3 * triangles, plain());
    const bool isOfFaces = layout_.ofFaces != nullptr;
    const bool isWrong = isOfFaces && !places.empty() && places.size() != 2 * corners;
    if (isWrong)
        wrongLengths_.add(index);
    const bool hasNone = isWrong || (isOfFaces && places.empty());
    const std::uint16_t material = hasNone ? std::uint16_t{0} : materialOf(index, number);
    for (std::uint64_t i = 0; i < corners; ++i) {
        Look look{material, glm::vec2(0)};
        if (isOfFaces && material != 0)
            look.place = placeFrom(places[2 * i], places[2 * i + 1]);
        if (!isNumber(look.place)) {
            ++noNumbers_;
            look.place = glm::vec2(0);
        }
        looks.push_back(look);
    }
}

/// Gives each corner a vertex of its look: the first takes the vertex that is there, the others
/// copies.
class PlyTextures::Splitter {
public:
    Splitter(TriangleMesh& mesh, bool placesAreOfFaces)
        : mesh_(mesh), placesAreOfFaces_(placesAreOfFaces) {
        mesh_.materialOf.assign(mesh_.positions.size(), kNotYet);
        mesh_.textureCoordinates.resize(mesh_.positions.size(), glm::vec2(0));
    }

    /// False where there would be too many vertices.
    bool place(std::uint32_t& corner, const Look& look) {
        if (mesh_.materialOf[corner] == kNotYet) {
            give(corner, look);
            return true;
        }
        if (has(corner, look))
            return true;
        const auto [copy, isNew] =
            copies_.try_emplace({corner, look.material, look.place.x, look.place.y}, 0);
        if (isNew) {
            if (mesh_.positions.size() >= std::numeric_limits<std::uint32_t>::max() - 1)
                return false;
            copy->second = copyOf(corner);
            give(copy->second, look);
        }
        corner = copy->second;
        return true;
    }

private:
    bool has(std::uint32_t vertex, const Look& look) const {
        return mesh_.materialOf[vertex] == look.material &&
               (!placesAreOfFaces_ || mesh_.textureCoordinates[vertex] == look.place);
    }

    void give(std::uint32_t vertex, const Look& look) {
        mesh_.materialOf[vertex] = look.material;
        if (placesAreOfFaces_)
            mesh_.textureCoordinates[vertex] = look.place;
    }

    std::uint32_t copyOf(std::uint32_t vertex) {
        const auto copy = static_cast<std::uint32_t>(mesh_.positions.size());
        const auto again = [vertex](auto& array) {
            if (array.empty())
                return;
            const auto value = array[vertex];
            array.push_back(value);
        };
        again(mesh_.positions);
        again(mesh_.normals);
        again(mesh_.colours);
        again(mesh_.textureCoordinates);
        again(mesh_.materialOf);
        return copy;
    }

    TriangleMesh& mesh_;
    bool placesAreOfFaces_;
    std::map<std::tuple<std::uint32_t, std::uint16_t, float, float>, std::uint32_t> copies_;
};

absl::Status PlyTextures::split(TriangleMesh& mesh, std::vector<std::uint32_t>& polygonCorners) {
    ofTriangles_.resize(3 * mesh.triangles.size(), plain());
    Splitter splitter(mesh, layout_.ofFaces != nullptr);
    bool fits = true;
    for (std::size_t i = 0; i < ofTriangles_.size(); ++i)
        fits = fits && splitter.place(mesh.triangles[i / 3][i % 3], ofTriangles_[i]);
    for (std::size_t i = 0; i < ofPolygons_.size(); ++i)
        fits = fits && splitter.place(polygonCorners[i], ofPolygons_[i]);
    if (!fits)
        return absl::InvalidArgumentError(
            "found more than 2^32 vertices where those along the seams of textures count once a "
            "side, expected fewer; split the mesh");
    std::replace(mesh.materialOf.begin(), mesh.materialOf.end(), kNotYet, std::uint16_t{0});
    return absl::OkStatus();
}

absl::Status PlyTextures::applyTo(TriangleMesh& mesh, std::vector<std::uint32_t>& polygonCorners,
                                  std::vector<std::string> names) {
    addMaterials(mesh, std::move(names));
    for (glm::vec2& place : mesh.textureCoordinates)
        if (!isNumber(place)) {
            ++noNumbers_;
            place = glm::vec2(0);
        }
    if (layout_.isByFace())
        RETURN_IF_ERROR(split(mesh, polygonCorners));
    else
        mesh.materialOf.assign(mesh.positions.size(), plain().material);
    addNotes(mesh);
    return absl::OkStatus();
}

void PlyTextures::addNotes(TriangleMesh& mesh) const {
    if (wrongLengths_.count > 0)
        mesh.notes.push_back(
            fmt::format("{} faces have a texcoord that is not two numbers a corner, and no texture "
                        "for that; the first is face {}",
                        wrongLengths_.count, wrongLengths_.first));
    if (wrongNumbers_.count > 0)
        mesh.notes.push_back(
            fmt::format("{} faces have a texnumber that none of the {} textures has, and no "
                        "texture for that; the first is face {}",
                        wrongNumbers_.count, layout_.images, wrongNumbers_.first));
    if (noNumbers_ > 0)
        mesh.notes.push_back(fmt::format(
            "{} texture coordinates are no finite numbers, and are taken for 0", noNumbers_));
}

}  // namespace eyrie::import
