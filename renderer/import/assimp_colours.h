// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <assimp/color4.h>

#include "renderer/import/assimp_formats.h"

struct aiMesh;
struct aiScene;

namespace eyrie::import {

/// Colours of vertices as the file means them, of 0 to 1, which is not always what Assimp gives.
class AssimpColours {
public:
    /// Refers to `scene`.
    AssimpColours(const aiScene& scene, const AssimpFormat& format);

    /// Whether the vertices of a mesh, counted as the scene does, have any.
    bool areAnyOf(unsigned int mesh) const { return ofMeshes_[mesh].colours != nullptr; }
    bool areAny() const;
    /// White where they have none.
    aiColor4D of(unsigned int mesh, unsigned int vertex) const;

    /// For TriangleMesh::notes.
    std::vector<std::string> notes() const;

private:
    struct OfMesh {
        const aiColor4D* colours = nullptr;  ///< one a vertex, or null
        bool areOpaque = false;              ///< whatever their alpha
        bool areShifted = false;             ///< behind a number that is none of theirs
        std::optional<aiColor4D> ofAll{};    ///< in their place
    };

    OfMesh look(const aiMesh& mesh);

    const AssimpFormat& format_;
    std::vector<OfMesh> ofMeshes_;
    std::size_t wrong_ = 0;  ///< meshes of which they are left out
    bool areBytes_ = false;
};

}  // namespace eyrie::import
