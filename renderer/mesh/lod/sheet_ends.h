// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <glm/vector_relational.hpp>

#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// Where sheets of a mesh end: edges that one triangle has alone, whichever corners share a
/// position. To look for what touches them: a tree of boxes, halved at the median of the longest
/// axis, in place.
class SheetEnds {
public:
    struct End {
        glm::vec3 from;  ///< lattice coordinates, which floats hold
        glm::vec3 to;
        std::uint32_t triangle;
    };

    /// Not those between two vertices of `goesOnAt`, where the mesh goes on beyond what is given.
    explicit SheetEnds(const PackedMesh& mesh, std::span<const std::uint32_t> goesOnAt = {});

    std::span<const End> all() const { return ends_; }

    /// Whether `isSuch` of one whose box comes within `reach` lattice steps of what lies between
    /// `low` and `high`.
    template <typename IsSuch>
    bool anyNear(const glm::vec3& low, const glm::vec3& high, float reach,
                 const IsSuch& isSuch) const {
        return !nodes_.empty() && search(0, {low - reach, high + reach}, isSuch);
    }

private:
    struct Box {
        glm::vec3 low;
        glm::vec3 high;

        bool meets(const Box& other) const {
            return glm::all(glm::lessThanEqual(low, other.high)) &&
                   glm::all(glm::greaterThanEqual(high, other.low));
        }
    };

    static Box boxOf(const End& end) {
        return {glm::min(end.from, end.to), glm::max(end.from, end.to)};
    }
    std::uint32_t build(std::uint32_t begin, std::uint32_t end);

    struct Node {
        Box box;
        std::uint32_t begin;  ///< of its ends
        std::uint32_t end;
        std::uint32_t right;  ///< 0 for a leaf; the left one comes right after it
    };

    template <typename IsSuch>
    bool search(std::uint32_t index, const Box& where, const IsSuch& isSuch) const {
        const Node& node = nodes_[index];
        if (!node.box.meets(where))
            return false;
        if (node.right != 0)
            return search(index + 1, where, isSuch) || search(node.right, where, isSuch);
        for (std::uint32_t i = node.begin; i < node.end; ++i)
            if (boxOf(ends_[i]).meets(where) && isSuch(ends_[i]))
                return true;
        return false;
    }

    std::vector<End> ends_;
    std::vector<Node> nodes_;
};

/// Of each vertex, whether a sheet ends there, or it is a corner of a triangle that another sheet
/// ends at, to within what roundings of the source and of the lattice may part: 1, else 0. Were it
/// moved, one could see through between the two. Triangles with thousands of ends around them count
/// as touched.
std::vector<std::uint8_t> whereOthersEnd(const PackedMesh& mesh, const SheetEnds& ends);

}  // namespace eyrie::mesh
