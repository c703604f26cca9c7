// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/progress.h"
#include "renderer/terrain/deviation.h"
#include "renderer/terrain/deviation_scale.h"
#include "renderer/terrain/tiled_raster.h"

namespace eyrie::terrain {

/// Which posts which level needs as vertices.
///
/// The grid, padded to a square whose side is a power of two, carries one right-triangulated
/// irregular network (Evans, Kirkpatrick, Townsend 2001; the restricted quadtree): each vertex v
/// but the first splits the two triangles whose common hypotenuse it is the midpoint of. Its error
/// is the greatest exact deviation of those two triangles from the source, and not below that of
/// the vertices that split their halves. The vertices whose error exceeds a threshold then form a
/// triangulation without T-junctions whose triangles deviate by no more than that threshold; a
/// lower threshold's vertices contain a higher one's; and since errors belong to vertices and not
/// to tiles, neighbours agree along their borders.
///
/// Posts past the last column or row stand on it (their indices are clamped). Vertices there
/// matter where their triangles reach back into the grid.
///
/// What is kept of an error is a byte of DeviationScale: the thresholds that it exceeds, and how
/// far the vertex's own two triangles deviate. One a post, on scratch; for every 16th column and
/// row also in memory.
///
/// A triangle up to 128 cells wide lies in one tile of the raster, so three steps find them all:
/// `measure` takes each tile by itself, with the vertices inside of it that it knows; `join`
/// brings the tiles' answers together where a vertex's children lie beyond a border; `finish`
/// does the wider triangles, each in memory but for the blocks that are in doubt.
class VertexLevels {
public:
    /// Reserves its room on `scratch`; keeps a reference to `model`.
    VertexLevels(const ElevationModel& model, Scratch& scratch);

    /// Ascending, one a level; before the steps.
    void setThresholds(std::vector<double> metres);

    // In this order; each is parallel. Errors: Cancelled, the scratch's.
    //
    // For a part of the model: `measure` and `join` with `needed` tiles, of which the model must
    // have the heights, and `finish` up to kTileSpacing then make whatever tiles of up to 128 cells
    // ask for, as long as they and all tiles beside them are needed.

    absl::Status measure(const import::ImportControl& control, const TileFilter& needed = {});
    absl::Status join(const import::ImportControl& control, const TileFilter& needed = {});
    absl::Status finish(const import::ImportControl& control,
                        std::int32_t endSpacing = std::numeric_limits<std::int32_t>::max());
    static constexpr std::int32_t kTileSpacing = kRasterTileCells;

    /// What `measure` has found in a tile; and the same put in its place. Any thread.
    TiledRaster<std::uint8_t>::Tile measured(std::int32_t x, std::int32_t y) const {
        return measured_.tile(x, y);
    }
    void setMeasured(std::int32_t x, std::int32_t y, std::shared_ptr<std::uint8_t[]> codes) {
        measured_.write(x, y, std::move(codes));
    }
    /// Once `join` is done and nobody asks for it.
    void forgetMeasured() { measured_.forget(); }

    const DeviationScale& scale() const { return scale_; }
    /// Bytes of `scale`: vertex (i, j) is needed by all levels below the number of thresholds
    /// exceeded. `rect` counts posts 2^layer apart; `out` gets its bytes row by row.
    void read(int layer, const PostRect& rect, std::uint8_t* out) const;

    /// What the steps leave in memory, and the same brought back; false for what is not of this
    /// model.
    std::vector<std::byte> state() const;
    bool restore(std::span<const std::byte> state);

private:
    struct Point {  ///< of the padded square
        std::int32_t i;
        std::int32_t j;
    };
    struct Found {
        std::uint64_t key;
        std::uint64_t code;
    };
    class TileMeasure;
    class GroupJoin;

    static constexpr int kLayers = 4;  ///< on scratch; from layer 4 on memory has all
    static constexpr std::int32_t kCoarseSpacing = 1 << kLayers;

    int exceededByTriangle(SourceSurface& surface, const Point& p, const Point& apex,
                           const Point& q, int known) const;
    int exceededBySplit(SourceSurface& surface, std::int32_t i, std::int32_t j, std::int32_t s,
                        bool isCentre, int known) const;
    std::uint8_t codeAt(std::int32_t i, std::int32_t j) const;
    int exceeded(std::int32_t i, std::int32_t j) const {
        return DeviationScale::exceeded(codeAt(i, j));
    }
    int exceededByChildren(std::int32_t i, std::int32_t j, std::int32_t s, bool isCentre) const;
    std::uint8_t raised(std::int32_t i, std::int32_t j, std::int32_t s, bool isCentre) const;
    std::uint8_t split(SourceSurface& surface, std::int32_t i, std::int32_t j, std::int32_t s,
                       bool isCentre) const;
    void finishClass(std::int32_t s, bool isCentre);
    bool isCovered(std::int32_t i, std::int32_t j) const {
        return i <= coveredI_ && j <= coveredJ_;
    }
    std::size_t coarseIndex(std::int32_t i, std::int32_t j) const {
        return static_cast<std::size_t>(j / kCoarseSpacing) *
                   static_cast<std::size_t>(coarseColumns_) +
               static_cast<std::size_t>(i / kCoarseSpacing);
    }
    static std::uint64_t key(std::int32_t i, std::int32_t j) {
        return static_cast<std::uint64_t>(j) << 32 | static_cast<std::uint32_t>(i);
    }

    const ElevationModel& model_;
    Scratch& scratch_;
    DeviationScale scale_;
    std::int32_t columns_;
    std::int32_t rows_;
    std::int32_t side_;      ///< cells a side of the padded square
    std::int32_t coveredI_;  ///< last column and row of the raster's tiles
    std::int32_t coveredJ_;
    std::int32_t coarseColumns_;
    TiledRaster<std::uint8_t> measured_;                     ///< by `measure`; borders differ
    std::array<TiledRaster<std::uint8_t>, kLayers> joined_;  ///< without the coarse vertices
    std::vector<std::uint8_t> coarse_;
    std::unordered_map<std::uint64_t, std::uint8_t> outside_;  ///< of the tiles
};

}  // namespace eyrie::terrain
