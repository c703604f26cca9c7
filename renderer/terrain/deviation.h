// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/terrain/height_grid.h"
#include "renderer/terrain/relief_summary.h"
#include "renderer/terrain/tiled_raster.h"

namespace eyrie::terrain {

/// A corner of a triangle: a post, and the height it is drawn at (NaN at nodata posts).
struct Corner {
    std::int32_t i = 0;
    std::int32_t j = 0;
    double z = 0;
};
using Triangle = std::array<Corner, 3>;

/// An elevation model as it lies on scratch. Immutable; any thread may read it.
struct ElevationModel {
    GridFrame frame;
    HeightStatistics statistics;
    TiledRaster<float> heights;  ///< tiles repeat the grid's last column and row past it
    ReliefSummary relief;

    bool hasNodata() const { return statistics.nodataPosts > 0; }

    /// What is not on scratch, and the same brought back; false for what is not of this frame.
    std::vector<std::byte> state() const;
    bool restore(std::span<const std::byte> state);
};

/// How much of a deviation someone wants to know: one that is not above `floor` may be told as
/// `floor`. With `steps`, ascending, the answer only has to lie between the same two steps.
struct DeviationGoal {
    double floor = 0;
    std::span<const double> steps = {};

    /// What a block must exceed to matter once `worst` is known.
    double bar(double worst) const;
};

/// Part of a height raster in memory: posts (i0, j0) to (i1, j1), all included.
struct HeightPatch {
    const float* posts = nullptr;  ///< of (i0, j0)
    std::ptrdiff_t stride = 0;
    std::int32_t i0 = 0;
    std::int32_t j0 = 0;
    std::int32_t i1 = -1;
    std::int32_t j1 = -1;

    const float* row(std::int32_t j) const { return posts + stride * (j - j0); }
    float at(std::int32_t i, std::int32_t j) const { return row(j)[i - i0]; }
    bool has(std::int32_t i, std::int32_t j) const {
        return i >= i0 && i <= i1 && j >= j0 && j <= j1;
    }
    /// The posts that both have.
    HeightPatch clipped(std::int32_t fromI, std::int32_t fromJ, std::int32_t toI,
                        std::int32_t toJ) const;
};

/// Greatest vertical distance between drawn triangles and the full-resolution source, in metres.
///
/// The source between posts is whatever the reader of a DEM takes it for: a cell split along
/// either diagonal, or bilinear (which lies between those two). Each of the three is piecewise
/// linear or bounded by such, so the greatest distance lies at a post, or where an edge of the
/// triangle crosses a grid line or a cell's diagonal: those points are all looked at, none
/// sampled. One exception: where all posts of an aligned triangle lie on it, to within
/// postToleranceMetres, the drawing follows such a reading, and only its distance at posts counts.
///
/// Triangles wider than a tile of the raster are looked at block by block, and only blocks of which
/// ReliefSummary says that they may change the answer.
///
/// Triangles that hold both data and nodata count as their longest edge: that is how far what
/// is drawn may reach into a hole, or a hole into what should be drawn. All nodata counts as 0.
///
/// Computed in double from float heights: rounding stays below 2^-40 of the greatest height, see
/// kDeviationRounding.
///
/// Holds the tile looked at last: one object per thread.
class SourceSurface {
public:
    /// Keeps a reference to `model`.
    explicit SourceSurface(const ElevationModel& model);

    /// Of a right isosceles triangle with legs or hypotenuse along the axes, corners on posts, the
    /// right angle first; never less than goal.floor.
    double ofAligned(const Triangle& triangle, const DeviationGoal& goal = {});
    /// Of any triangle with corners on posts. Counts cells' diagonals even on planes.
    double ofGeneral(const Triangle& triangle, const DeviationGoal& goal = {});

    /// Of an aligned triangle that lies in one tile of the raster, without nodata.
    struct Inside {
        double deviation = 0;  ///< as ofAligned, but for what is not above `floor`
        double greatest = 0;   ///< at posts and at edges, whether it lies on its posts or not
    };
    Inside inside(const Triangle& triangle, double floor);

    float heightAt(std::int32_t i, std::int32_t j) {
        return patch_.has(i, j) ? patch_.at(i, j) : farHeightAt(i, j);
    }
    const GridFrame& frame() const { return model_.frame; }
    bool hasNodata() const { return model_.hasNodata(); }
    /// On the ground.
    double metresAside(const Corner& a, const Corner& b) const;
    double longestEdgeMetres(const Triangle& triangle) const;
    /// Whether it counts as one: it holds both data and nodata or, not being aligned,
    /// has an edge that crosses a cell with nodata.
    bool mixes(const Triangle& triangle, bool isAligned);
    /// 1/2048 of a post, 5 cm at most: far below what any level's threshold resolves.
    double postToleranceMetres() const { return postTolerance_; }

private:
    enum class Contents { Data, Nodata, Mixed };

    const HeightPatch& tilePatch(std::int32_t x, std::int32_t y);
    const HeightPatch* onlyTile(const Triangle& triangle);
    float farHeightAt(std::int32_t i, std::int32_t j);
    template <typename Visit>
    void forEachBlock(const Triangle& triangle, Visit visit);
    double scanBlocks(const Triangle& triangle, const Plane& plane, const DeviationGoal& goal,
                      double worst);
    Contents contents(const Triangle& triangle);
    bool liesOnItsPosts(const Triangle& triangle);

    const ElevationModel& model_;
    double postTolerance_;
    TiledRaster<float>::Tile tile_;
    HeightPatch patch_;  ///< all of tile_
};

/// Share of the greatest height that rounding may take off a computed deviation.
inline constexpr double kDeviationRounding = 1.0 / (1LL << 40);

}  // namespace eyrie::terrain
