// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/truth/reference_surface.h"

namespace eyrie::truth {

/// Posts of an elevation model: `columns` x `rows`, row-major. Post (i, j) stands at world
/// (x, y) = origin + i * perColumn + j * perRow and is heights[j * columns + i] metres high; NaN
/// means no data, which makes a hole.
struct HeightGrid {
    int columns = 0;
    int rows = 0;
    std::vector<float> heights;
    fabric::Vec2 origin{0, 0};
    fabric::Vec2 perColumn{1, 0};
    fabric::Vec2 perRow{0, -1};
};

/// Posts say nothing about the ground between them. These are the three usual readings of a cell;
/// they agree on its edges.
enum class CellSurface { MainDiagonal, OtherDiagonal, Bilinear };
inline constexpr int kCellSurfaces = 3;

/// Casts rays at the full-resolution posts.
class TerrainRayCaster final : public ReferenceSurface {
public:
    /// Precondition: columns, rows >= 2, heights has columns * rows entries, the steps are
    /// independent.
    explicit TerrainRayCaster(HeightGrid grid);

    /// First hit with each reading, indexed by CellSurface; kNoHit where there is none.
    /// MainDiagonal splits each cell from post (i, j) to (i + 1, j + 1), OtherDiagonal from
    /// (i + 1, j) to (i, j + 1).
    std::array<double, kCellSurfaces> firstHits(const Ray& ray) const;

    /// Heights of each reading over a world (x, y); NaN outside the posts and in holes.
    std::array<double, kCellSurfaces> heightsAt(double x, double y) const;

    /// From the first hit with any reading to where the ray first has gone through both diagonals
    /// of one cell, and so through its whole tetrahedron: any surface that reads each cell in some
    /// way of its own is hit in there. (Not at the first hits with the upper and the lower sides of
    /// all cells: through a hole a ray gets below the ground, and meets the lower side first.)
    HitRange hitRange(const Ray& ray) const override;
    /// Asked about are posts beside nodata or at the rim.
    bool endsWithin(const fabric::Vec3& point, double reach,
                    const std::function<bool(const fabric::Vec3&)>& isThere) const override;
    /// The point of the same column; of the readings, the nearest.
    std::optional<fabric::Vec3> counterpart(const fabric::Vec3& point) const override;

    const HeightGrid& grid() const { return grid_; }

    /// Bytes that so many posts take here: heights, and the pyramid over them.
    static constexpr std::uint64_t bytesFor(std::uint64_t posts) {
        return posts * sizeof(float) + posts / 16 * sizeof(Extent) + posts / 64;
    }

private:
    struct Extent {  ///< of the heights in a block; empty (min > max) without data
        float min;
        float max;
    };
    struct Level {
        int columns;
        int rows;
        std::vector<Extent> blocks;

        std::size_t index(int column, int row) const {
            return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(column);
        }
    };
    struct Traversal;

    double post(int i, int j) const;
    /// Whether there is a post, with data, beside one that is not or has none.
    bool isEnd(int i, int j) const;
    Extent blockExtent(int column, int row) const;
    bool hasNodata(int column, int row) const;
    /// Whether a post of a block of levels_[0] may be an end.
    bool mayHaveEnd(int column, int row) const;
    void buildLevels();
    void visit(Traversal& traversal, int level, int column, int row) const;
    void visitCells(Traversal& traversal, int column, int row) const;
    void visitCell(Traversal& traversal, int i, int j) const;
    Traversal cast(const Ray& ray) const;
    Ray toGrid(const Ray& ray) const;
    fabric::Vec2 toGrid(double x, double y) const;

    HeightGrid grid_;
    std::vector<Level> levels_;  ///< [0] has blocks of kBlockCells^2 cells, each next twice that
    std::vector<std::uint8_t> hasNodata_;  ///< of each block of levels_[0], 0 or 1
};

}  // namespace eyrie::truth
