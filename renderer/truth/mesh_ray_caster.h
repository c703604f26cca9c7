// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fabric/box.h"
#include "renderer/truth/reference_surface.h"

namespace eyrie::truth {

/// How surely a triangle is seen where nothing is before it.
enum class Sight : std::uint8_t {
    Sure,
    SureFromFront,  ///< counter-clockwise; from behind it may be seen or not
    Unsure,         ///< an image or a veil decides, which the truth does not look at
};

/// Triangles in world space: positions in metres, three vertex indices a triangle.
struct TriangleMesh {
    std::vector<fabric::Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Sight> sights = {};  ///< each triangle's; empty: all are sure
};

/// Casts rays at the full-resolution triangles; a ray through a shared edge or vertex never slips
/// between the triangles.
class MeshRayCaster final : public ReferenceSurface {
public:
    /// Precondition: at least one triangle, indices within positions, positions finite.
    explicit MeshRayCaster(TriangleMesh mesh);

    /// The ray's parameter at its first hit, seen or not, or kNoHit.
    double firstHit(const Ray& ray) const { return hitRange(ray).first; }
    /// From there to where something is surely seen.
    HitRange hitRange(const Ray& ray) const override { return cast(ray, 0); }
    /// Goes through all triangles for each edge that may be a seam. Those without area, which some
    /// modellers put where an edge ends inside another, close none.
    HitRange throughSeams(const Ray& ray, double reach) const override { return cast(ray, reach); }
    /// It ends at edges of one triangle alone; asked about are points of these within `reach`, no
    /// farther apart than a sixteenth of it.
    bool endsWithin(const fabric::Vec3& point, double reach,
                    const std::function<bool(const fabric::Vec3&)>& isThere) const override;
    /// The closest point of the mesh.
    std::optional<fabric::Vec3> counterpart(const fabric::Vec3& point) const override;

    /// Its triangles in an order of its own.
    const TriangleMesh& mesh() const { return mesh_; }

    /// Bytes that `triangles` with `vertices` take here.
    static constexpr std::uint64_t bytesFor(std::uint64_t vertices, std::uint64_t triangles) {
        return vertices * sizeof(fabric::Vec3) +
               triangles * (sizeof(Node) + sizeof(std::array<std::uint32_t, 3>) +
                            sizeof(std::uint32_t) + sizeof(Sight));
    }

private:
    struct Node {
        fabric::Box bounds;
        std::uint32_t begin = 0;  ///< of its triangles
        std::uint32_t end = 0;
        std::uint32_t right = 0;  ///< second child; the first follows its parent. 0 in leaves
    };

    /// Of triangles in the order of their numbers.
    using Order = std::vector<std::uint32_t>;
    std::uint32_t build(Order& order, std::uint32_t begin, std::uint32_t end);
    fabric::Box boundsOf(const Order& order, std::uint32_t begin, std::uint32_t end) const;
    void putInOrder(const Order& order);
    HitRange cast(const Ray& ray, double reach) const;
    std::vector<std::array<fabric::Vec3, 2>> edgesWithin(const fabric::Vec3& point,
                                                         double reach) const;
    bool isSure(std::size_t triangle, const Ray& ray) const;
    bool isAtSeam(std::size_t triangle, const Ray& ray, double hit, double reach) const;
    bool hasNoArea(const std::array<fabric::Vec3, 3>& triangle) const;
    bool goesOn(const fabric::Vec3& a, const fabric::Vec3& b, const fabric::Vec3& eye) const;
    bool goesOnAround(const fabric::Vec3& corner, const fabric::Vec3& eye) const;

    TriangleMesh mesh_;
    std::vector<Node> nodes_;
};

}  // namespace eyrie::truth
