// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// The triangles of a surface, linked where they meet, while points of it are moved onto their
/// neighbours. Vertices at one position are one point of the surface.
class LinkedFaces {
public:
    struct Corner {
        std::uint32_t vertex;  ///< the mesh's own
        std::uint32_t point;
    };
    struct Face {
        std::array<Corner, 3> corners;
        bool isThere = true;
    };
    /// Of a point, in one of the faces around it.
    struct Neighbour {
        std::uint32_t point;
        std::uint32_t next;    ///< the neighbour after it
        std::uint32_t face;    ///< between it and the next neighbour
        std::uint32_t vertex;  ///< its own in that face
    };

    LinkedFaces(const PackedMesh& mesh, std::span<const Triangle> triangles);

    const std::vector<Face>& faces() const { return faces_; }  ///< those that are gone, too
    std::size_t points() const { return places_.size(); }
    const glm::dvec3& placeOf(std::uint32_t point) const { return places_[point]; }
    /// That which was met first.
    std::uint32_t firstVertexOf(std::uint32_t point) const { return firstVertices_[point]; }

    /// Looks at a point: what follows is said of it. False when its faces are no closed ring, or it
    /// has several vertices: it has to stay.
    bool gatherRing(std::uint32_t point);
    std::span<const Neighbour> ring() const { return ring_; }  ///< in turn, if closed
    bool isRing() const { return isRing_; }                    ///< whether it is closed
    /// Whether one of the neighbours, in no particular order, shares but one face with the point.
    bool isOpen() const;
    /// Whether the point and ring()[target] have but two neighbours in common, so that no two faces
    /// fall onto each other, and the target looks the same from both sides of the edge between
    /// them. Precondition: isRing().
    bool isSimple(std::size_t target);

    void remove(std::uint32_t face) { faces_[face].isThere = false; }
    /// Corners at `from` become corners at `onto`, of its `vertex`, before those that are there.
    void moveCorners(std::uint32_t from, std::uint32_t onto, std::uint32_t vertex);

private:
    /// A face and which of its corners, as one number.
    struct CornerId {
        std::uint32_t id;
        CornerId(std::uint32_t face, std::uint32_t corner) : id(face << 2 | corner) {}
        std::uint32_t face() const { return id >> 2; }
        std::uint32_t corner() const { return id & 3; }
    };
    /// Where the corners at a point are in `corners_`. Side by side, not linked: so that their
    /// faces are fetched from memory at the same time, which is where the time goes.
    struct Corners {
        std::size_t begin = 0;
        std::uint32_t count = 0;
    };

    void numberPoints(const PackedMesh& mesh);
    void gatherCorners();
    bool sortRing();
    template <typename Visit>
    void forCorners(std::uint32_t point, const Visit& visit);

    std::vector<Face> faces_;
    std::vector<glm::dvec3> places_;            ///< of points
    std::vector<std::uint32_t> firstVertices_;  ///< of a point
    std::vector<CornerId> corners_;             ///< of all points; what was replaced is left behind
    std::vector<Corners> around_;               ///< of a point; some may be of faces that are gone
    std::vector<std::uint32_t> mark_;
    std::uint32_t marking_ = 0;
    std::vector<Neighbour> ring_;
    bool isRing_ = false;
};

}  // namespace eyrie::mesh
