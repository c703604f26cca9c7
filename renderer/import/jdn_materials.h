// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include <glm/vec2.hpp>

#include "renderer/import/triangle_mesh.h"

/// What a .jdn scene (jdn_reader.h) says of materials.
namespace eyrie::import {

struct JdnMaterial {
    fabric::Rgba colour{204, 204, 204, 255};  ///< alpha: the opacity
    std::int32_t texture = -1;                ///< in TriangleMesh::textures
};

/// The materials of a scene, by the numbers that it gives them; its texture stands for a material's
/// colour.
class JdnMaterials {
public:
    /// Begins the next material. What follows is of it.
    void begin() {
        ++count_;
        isNumbered_ = false;
        current_ = {};
    }
    void setColour(const fabric::Rgba& colour);
    void setOpacity(std::uint8_t opacity);
    void setId(std::int64_t id);
    /// `path` may be empty. Textures are added to `mesh`, always the same one, each once.
    void setTexture(std::string_view path, TriangleMesh& mesh);

    std::uint64_t count() const { return count_; }
    /// Null when there is none of this number.
    const JdnMaterial* find(std::int64_t id) const;

private:
    void keep();

    std::uint64_t count_ = 0;
    JdnMaterial current_;
    bool isNumbered_ = false;
    std::int64_t id_ = 0;
    std::map<std::int64_t, JdnMaterial> materials_;
    std::map<std::string, std::int32_t> textures_;  ///< their places in the mesh, by path
};

/// Gives the vertices from `firstVertex` on a material, and those of triangles from `firstTriangle`
/// on texture coordinates: `places`, of which `corners` has three a triangle. Vertices with several
/// become as many. Without `corners` the material has no texture.
/// Preconditions: the mesh has colours and normals of all positions; corners.size() is that of the
/// triangles, or 0, each below places.size(); no triangle has vertices before firstVertex.
void addJdnMaterial(const JdnMaterial& material, std::size_t firstVertex, std::size_t firstTriangle,
                    std::span<const glm::vec2> places,
                    std::span<const std::array<std::uint32_t, 3>> corners, TriangleMesh& mesh);

}  // namespace eyrie::import
