// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/terrain/bounded_list.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/outline_error.h"

namespace eyrie::terrain {

/// What a tile draws whatever its neighbours are: sides and vertices of its interior's triangles,
/// and of its borders' those that all forms of a border have.
class AlwaysDrawn {
public:
    /// `parts`: indices of vertices by part, three a triangle; of `finerEdges` there is a finer
    /// form. `corners`: by vertex.
    AlwaysDrawn(std::span<const BoundedList<std::uint16_t>> parts, std::uint8_t finerEdges,
                std::vector<Corner> corners);

    bool empty() const { return vertices_.empty(); }
    /// Sides and corners of a triangle of such vertices or of kAbsentPoint; may be none.
    std::vector<DrawnSide> of(const std::array<std::uint16_t, 3>& triangle) const;
    /// What is about as near a triangle as anything: sides between the few vertices nearest to it,
    /// and those vertices. Empty only if this is.
    std::vector<DrawnSide> around(const Triangle& triangle) const;

private:
    using Side = std::array<std::uint16_t, 2>;  ///< the lesser number first

    void setVertices(std::span<const BoundedList<std::uint16_t>> parts, std::uint8_t finerEdges);
    void setBins();
    std::size_t binOf(std::int32_t i, std::int32_t j) const;
    std::vector<std::uint16_t> near(std::int32_t i, std::int32_t j) const;
    void setSides(std::span<const BoundedList<std::uint16_t>> parts, std::uint8_t finerEdges);
    std::span<const std::uint16_t> sidesFrom(std::uint16_t vertex) const {
        return {ends_.data() + first_[vertex], first_[vertex + 1U] - first_[vertex]};
    }
    bool isSide(std::uint16_t a, std::uint16_t b) const;

    std::vector<Corner> corners_;
    std::vector<bool> isDrawn_;              ///< by vertex
    std::vector<std::uint16_t> vertices_;    ///< those that are, by bin
    std::vector<std::uint32_t> firstOfBin_;  ///< by row and column of bins, in vertices_
    std::int32_t i0_ = 0;                    ///< of the first bin
    std::int32_t j0_ = 0;
    std::int32_t binPosts_ = 1;         ///< side of a bin
    std::vector<std::uint32_t> first_;  ///< by a side's first vertex, in ends_
    std::vector<std::uint16_t> ends_;
};

}  // namespace eyrie::terrain
