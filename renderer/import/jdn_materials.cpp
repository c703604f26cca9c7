// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/jdn_materials.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace eyrie::import {
namespace {

constexpr std::uint32_t kNoPlace = std::numeric_limits<std::uint32_t>::max();

/// 0, the plain one, where there are too many.
std::uint16_t numberOf(const mesh::Material& material, TriangleMesh& mesh) {
    if (mesh.materials.empty())
        mesh.materials.emplace_back();
    const auto known = std::find(mesh.materials.begin(), mesh.materials.end(), material);
    const auto number = static_cast<std::size_t>(known - mesh.materials.begin());
    if (number == mesh::kMaxMaterials)
        return 0;
    if (known == mesh.materials.end())
        mesh.materials.push_back(material);
    return static_cast<std::uint16_t>(number);
}

/// A copy of a vertex.
std::uint32_t copyOf(std::uint32_t vertex, TriangleMesh& mesh) {
    const auto copy = static_cast<std::uint32_t>(mesh.positions.size());
    const auto again = [vertex](auto& array) {
        const auto value = array[vertex];
        array.push_back(value);
    };
    again(mesh.positions);
    again(mesh.normals);
    again(mesh.colours);
    again(mesh.textureCoordinates);
    return copy;
}

}  // namespace

void JdnMaterials::keep() {
    if (isNumbered_)
        materials_[id_] = current_;
}

void JdnMaterials::setColour(const fabric::Rgba& colour) {
    current_.colour = {colour.r, colour.g, colour.b, current_.colour.a};
    keep();
}

void JdnMaterials::setOpacity(std::uint8_t opacity) {
    current_.colour.a = opacity;
    keep();
}

void JdnMaterials::setId(std::int64_t id) {
    id_ = id;
    isNumbered_ = true;
    keep();
}

void JdnMaterials::setTexture(std::string_view path, TriangleMesh& mesh) {
    if (path.empty())
        return;
    const auto [known, isNew] =
        textures_.try_emplace(std::string(path), static_cast<std::int32_t>(mesh.textures.size()));
    current_.texture = known->second;
    if (isNew)
        mesh.textures.push_back({known->first, {}, 0});
    keep();
}

const JdnMaterial* JdnMaterials::find(std::int64_t id) const {
    const auto found = materials_.find(id);
    return found == materials_.end() ? nullptr : &found->second;
}

void addJdnMaterial(const JdnMaterial& material, std::size_t firstVertex, std::size_t firstTriangle,
                    std::span<const glm::vec2> places,
                    std::span<const std::array<std::uint32_t, 3>> corners, TriangleMesh& mesh) {
    mesh::Material drawn;
    drawn.flags = material.colour.a < 255 ? mesh::kIsBlended : 0;
    if (!corners.empty() && material.texture >= 0) {
        drawn.image = material.texture;
        drawn.flags |= kAlphaByImage | kReplacesColour;
    }
    mesh.textureCoordinates.resize(mesh.positions.size(), glm::vec2(0));
    if (drawn.hasImage()) {
        std::vector<std::uint32_t> placeOf(mesh.positions.size() - firstVertex, kNoPlace);
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> copies;
        for (std::size_t i = 0; i < 3 * corners.size(); ++i) {
            std::uint32_t& vertex = mesh.triangles[firstTriangle + i / 3][i % 3];
            const std::uint32_t place = corners[i / 3][i % 3];
            std::uint32_t& known = placeOf[vertex - firstVertex];
            if (known != kNoPlace && known != place) {
                const auto [copy, isNew] = copies.try_emplace({vertex, place}, 0);
                if (isNew)
                    copy->second = copyOf(vertex, mesh);
                vertex = copy->second;
            } else {
                known = place;
            }
            mesh.textureCoordinates[vertex] = places[place];
        }
    }
    mesh.materialOf.resize(mesh.positions.size(), numberOf(drawn, mesh));
}

}  // namespace eyrie::import
