// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <absl/status/status.h>
#include <glm/vec2.hpp>

#include "renderer/import/ply_header.h"
#include "renderer/import/ply_layout.h"
#include "renderer/import/triangle_mesh.h"

namespace eyrie::import {

/// The images that the PLY file at `path` names, as it would have them: MeshLab writes `<this>` for
/// the file's own name without its ending.
std::vector<std::string> textureNames(const PlyHeader& header, const std::string& path);

/// A texture coordinate of PLY, whose v goes up.
glm::vec2 placeFrom(double u, double v);

/// Gathers how the faces of a PLY file lie in its images, and in the end gives its vertices
/// materials and places: those whose corners have several become as many.
class PlyTextures {
public:
    /// Precondition: layout.isUsed(), and outlives this.
    explicit PlyTextures(const TextureLayout& layout) : layout_(layout) {}

    /// Takes a face: its corners, of which fewer than three are dropped, what its texcoord has if
    /// there is that property, and its texnumber. `triangles` are those before it, of strips too.
    void addFace(std::uint64_t index, std::uint64_t corners, std::span<const double> places,
                 double number, std::size_t triangles);

    /// Gives `mesh` its materials, with a note of what was odd. Its triangles and `polygonCorners`,
    /// of the faces of more than three corners, are numbered anew where vertices are split.
    /// Errors: InvalidArgument (more than 2^32 vertices).
    absl::Status applyTo(TriangleMesh& mesh, std::vector<std::uint32_t>& polygonCorners,
                         std::vector<std::string> names);

private:
    struct Look {
        std::uint16_t material = 0;
        glm::vec2 place{0};
    };
    /// Faces that have no texture because something about it is wrong.
    struct Wrong {
        void add(std::uint64_t index) { first = count++ == 0 ? index : first; }

        std::uint64_t count = 0;
        std::uint64_t first = 0;
    };
    class Splitter;

    absl::Status split(TriangleMesh& mesh, std::vector<std::uint32_t>& polygonCorners);
    std::uint16_t materialOf(std::uint64_t index, double number);
    /// Of corners that no face has: strips lie in the first image where vertices have places.
    Look plain() const;
    void addNotes(TriangleMesh& mesh) const;

    const TextureLayout& layout_;
    std::vector<Look> ofTriangles_;  ///< three each
    std::vector<Look> ofPolygons_;   ///< one a corner of those of more than three
    Wrong wrongLengths_;
    Wrong wrongNumbers_;
    std::uint64_t noNumbers_ = 0;  ///< places
};

}  // namespace eyrie::import
