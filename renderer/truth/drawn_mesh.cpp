// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/drawn_mesh.h"

#include "fabric/status.h"
#include "renderer/draw/mesh_cut.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::truth {

absl::StatusOr<std::vector<Triangle>> drawnTriangles(const mesh::EymFile& file,
                                                     const lod::View& view, double tauPixels,
                                                     const fabric::Mat4& worldFromObject) {
    std::vector<Triangle> triangles;
    const lod::ObjectView objectView(view, worldFromObject);
    const auto isThere = [](std::uint32_t) { return true; };
    for (const draw::CutNode& one : draw::cutOf(file, objectView, tauPixels, isThere).drawn) {
        ASSIGN_OR_RETURN(const mesh::NodeGeometry geometry, file.geometry(one.node));
        const auto corner = [&](std::size_t k) {
            const glm::uvec3 place = mesh::unpackPosition(geometry.positions[geometry.indices[k]]);
            return fabric::Vec3(worldFromObject * fabric::Vec4(file.lattice().metres(place), 1.0));
        };
        for (std::size_t k = 0; k + 2 < geometry.indices.size(); k += 3)
            triangles.push_back({corner(k), corner(k + 1), corner(k + 2)});
    }
    return triangles;
}

}  // namespace eyrie::truth
