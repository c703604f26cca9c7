// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fabric/box.h"
#include "renderer/truth/reference_surface.h"

namespace eyrie::truth {

/// Triangles in world space: positions in metres, three vertex indices a triangle.
struct TriangleMesh {
    std::vector<fabric::Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Casts rays at the full-resolution triangles, both sides of which are seen; a ray through a
/// shared edge or vertex never slips between the triangles.
class MeshRayCaster final : public ReferenceSurface {
public:
    /// Precondition: at least one triangle, indices within positions, positions finite.
    explicit MeshRayCaster(TriangleMesh mesh);

    /// The ray's parameter at its first hit, or kNoHit.
    double firstHit(const Ray& ray) const;
    HitRange hitRange(const Ray& ray) const override {
        const double hit = firstHit(ray);
        return {hit, hit};
    }
    /// The closest point of the mesh.
    std::optional<fabric::Vec3> counterpart(const fabric::Vec3& point) const override;

    /// Its triangles in an order of its own.
    const TriangleMesh& mesh() const { return mesh_; }

    /// Bytes that `triangles` with `vertices` take here.
    static constexpr std::uint64_t bytesFor(std::uint64_t vertices, std::uint64_t triangles) {
        return vertices * sizeof(fabric::Vec3) +
               triangles * (sizeof(Node) + sizeof(std::array<std::uint32_t, 3>));
    }

private:
    struct Node {
        fabric::Box bounds;
        std::uint32_t begin = 0;  ///< of its triangles
        std::uint32_t end = 0;
        std::uint32_t right = 0;  ///< second child; the first follows its parent. 0 in leaves
    };

    std::uint32_t build(std::uint32_t begin, std::uint32_t end);
    fabric::Box boundsOf(std::uint32_t begin, std::uint32_t end) const;

    TriangleMesh mesh_;
    std::vector<Node> nodes_;
};

}  // namespace eyrie::truth
