// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "renderer/import/assimp_formats.h"
#include "renderer/import/triangle_mesh.h"

namespace eyrie::import {

/// The materials of an Assimp scene as TriangleMesh has them. Scene and format outlive this.
class AssimpMaterials {
public:
    AssimpMaterials(const aiScene& scene, const AssimpFormat& format);

    /// Whether any mesh has a material that is more than a colour.
    bool areAny() const { return materials_.size() > 1; }
    bool hasTextures() const { return !textures_.empty(); }

    /// In TriangleMesh::materials.
    std::uint16_t numberOf(const aiMesh& mesh) const;
    /// Diffuse, and as alpha the opacity; not yet as displayed.
    aiColor4D colourOf(const aiMesh& mesh) const;
    /// Whether alpha is of no account, whatever it is.
    bool isOpaque(const aiMesh& mesh) const;
    /// Whether what is behind a surface may show by what its alpha lacks.
    bool mayShowWhatIsBehind(const aiMesh& mesh) const;
    /// Of surfaces without an image, those whose alpha is less are not there at all.
    float cutoffWithoutImage(const aiMesh& mesh) const;
    glm::vec2 textureCoordinates(const aiMesh& mesh, unsigned int vertex) const;

    /// Hands materials and textures over, with a note of what was odd; nothing else may be asked
    /// from then on.
    void moveTo(TriangleMesh& mesh);

private:
    /// What an aiMaterial comes to.
    struct Entry {
        aiColor4D colour{1, 1, 1, 1};
        std::uint16_t number = 0;        ///< in materials_
        std::uint16_t withoutImage = 0;  ///< for meshes without texture coordinates
        bool isOpaque = true;
        bool isUnseen = false;     ///< whatever its image has
        float cutoff = 0;          ///< of alpha
        unsigned int channel = 0;  ///< of texture coordinates
        bool isProjected = false;  ///< onto meshes, whatever coordinates these have
        glm::dmat3 placeFromSource{1.0};
    };

    const Entry* find(const aiMesh& mesh) const;
    /// On its texture, a place for each vertex; null where the mesh has none.
    const aiVector3D* placesOf(const aiMesh& mesh, const Entry& entry) const;
    Entry read(const aiMaterial& material);
    void countLeftOut(const aiMaterial& material);
    std::int32_t readTexture(const aiMaterial& material, Entry& entry);
    std::uint16_t number(const mesh::Material& material);

    const aiScene& scene_;
    const AssimpFormat& format_;
    /// Where a scene says of some materials that they have two sides, those of which it says that
    /// they have not are seen from one only: outlines are such hulls, turned inside out. Where it
    /// says that of all, it means nothing by it.
    bool hasSides_;
    /// Exporters disagree on whether 0 is opaque or nothing; but for glTF's it is opaque.
    std::size_t takenForOpaque_ = 0;
    std::size_t withOthers_ = 0;   ///< materials with textures that are left out
    std::size_t withOpacity_ = 0;  ///< of these, those where one is the opacity
    std::size_t emitting_ = 0;     ///< materials that emit more than they reflect
    std::size_t mirrored_ = 0;     ///< materials whose texture is to be mirrored where it repeats
    std::size_t decals_ = 0;       ///< materials whose texture is to cover its own place only
    std::size_t squared_ = 0;      ///< materials whose texture is not to be filtered
    std::vector<Entry> entries_;
    std::vector<mesh::Material> materials_{mesh::Material()};
    std::vector<TextureSource> textures_;
};

}  // namespace eyrie::import
