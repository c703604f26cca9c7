// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "renderer/terrain/quadtree.h"
#include "renderer/terrain/vertex_packing.h"

namespace eyrie::pick {

/// How high one tile of the finest level is drawn at each of its posts, and so how far apart the
/// usual readings of a cell are: its posts are known, its diagonal is anybody's choice. Vertices
/// are given by post, x and y being column and row of the grid.
class DrawnPosts {
public:
    /// Nothing is drawn of the tile with that first post.
    void begin(std::int32_t column, std::int32_t row);

    /// A triangle of it.
    void cover(const terrain::TileVertex& a, const terrain::TileVertex& b,
               const terrain::TileVertex& c);

    /// Once all triangles are known: in the cells that this one may lie in, the most that the two
    /// diagonals of a cell lie apart, in steps of height. Cells that are not drawn whole have none.
    double twist(const terrain::TileVertex& a, const terrain::TileVertex& b,
                 const terrain::TileVertex& c) const;

private:
    static constexpr std::int32_t kPosts = terrain::kFinestTileCells + 1;

    double& at(std::int32_t column, std::int32_t row) {
        return heights_[static_cast<std::size_t>((row - row_) * kPosts + column - column_)];
    }
    double at(std::int32_t column, std::int32_t row) const {
        return heights_[static_cast<std::size_t>((row - row_) * kPosts + column - column_)];
    }
    void fill(const terrain::TileVertex& a, const terrain::TileVertex& b,
              const terrain::TileVertex& c);

    std::int32_t column_ = 0;
    std::int32_t row_ = 0;
    std::array<double, kPosts * kPosts> heights_{};  ///< steps; NaN: not drawn
};

}  // namespace eyrie::pick
