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
        return search(0, ends_.size(), {low - reach, high + reach}, isSuch);
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
    void build(std::size_t begin, std::size_t end);

    template <typename IsSuch>
    bool search(std::size_t begin, std::size_t end, const Box& where, const IsSuch& isSuch) const {
        if (begin == end)
            return false;
        const std::size_t middle = begin + (end - begin) / 2;
        if (!boxes_[middle].meets(where))
            return false;
        const End& here = ends_[middle];
        return (boxOf(here).meets(where) && isSuch(here)) || search(begin, middle, where, isSuch) ||
               search(middle + 1, end, where, isSuch);
    }

    std::vector<End> ends_;   ///< that of a tree [begin, end) is in its middle
    std::vector<Box> boxes_;  ///< around all of that tree
};

/// Of each vertex, whether it is a corner of a triangle that another sheet ends at, to within what
/// roundings of the source and of the lattice may part: 1, else 0. Were it moved, one could see
/// through between the two.
std::vector<std::uint8_t> whereOthersEnd(const PackedMesh& mesh, const SheetEnds& ends);

}  // namespace eyrie::mesh
