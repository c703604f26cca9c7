// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/terrain/tiled_raster.h"

namespace eyrie::terrain {

/// z over the lattice: z0 + perColumn * (i - i0) + perRow * (j - j0).
struct Plane {
    std::int32_t i0 = 0;
    std::int32_t j0 = 0;
    double z0 = 0;
    double perColumn = 0;
    double perRow = 0;

    double at(std::int32_t i, std::int32_t j) const {
        return (z0 + perRow * (j - j0)) + perColumn * (i - i0);
    }
};

/// What is kept in memory of each square block of posts, borders included: a plane near them, and
/// how far they lie below and above it. Tells how far any other plane is from them at most, so
/// that most blocks under a large triangle need not be looked at.
class ReliefSummary {
public:
    ReliefSummary() = default;
    /// Of a raster of so many posts. Blocks are 32 cells a side, more on grids of over 1.5 G posts.
    ReliefSummary(std::int32_t columns, std::int32_t rows);

    std::int32_t blockCells() const { return blockCells_; }
    /// Summarises the blocks of tile (x, y); different tiles from different threads.
    void add(std::int32_t x, std::int32_t y, const float* tile);

    /// Not below the distance of any post of block (x, y) with data, and of any point between them
    /// however a cell is read, from `plane`. Not less because of rounding.
    double farthest(std::int32_t x, std::int32_t y, const Plane& plane) const;
    bool hasData(std::int32_t x, std::int32_t y) const { return at(x, y).low <= at(x, y).high; }
    bool hasNodata(std::int32_t x, std::int32_t y) const { return at(x, y).hasNodata != 0; }

    std::vector<std::byte> bytes() const;
    /// Takes what bytes() gave for a raster of the same size; false for anything else.
    bool restore(std::span<const std::byte> bytes);

private:
    struct Block {
        float z0;
        float perColumn;
        float perRow;
        float low;  ///< above high: no data at all
        float high;
        std::uint32_t hasNodata;
    };

    const Block& at(std::int32_t x, std::int32_t y) const {
        return blocks_[static_cast<std::size_t>(y) * static_cast<std::size_t>(across_) +
                       static_cast<std::size_t>(x)];
    }

    std::int32_t blockCells_ = 32;
    std::int32_t across_ = 0;
    std::vector<Block> blocks_;
};

}  // namespace eyrie::terrain
