// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "renderer/terrain/bounded_list.h"
#include "renderer/terrain/codec/tile_model.h"
#include "renderer/terrain/deviation.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/outline_error.h"
#include "renderer/terrain/part_errors.h"
#include "renderer/terrain/quadtree.h"
#include "renderer/terrain/tile_samples.h"
#include "renderer/terrain/tile_triangulation.h"
#include "renderer/terrain/vertex_packing.h"

namespace eyrie::terrain {

/// What TileTriangulation asked or told on its walk of a tile: a flag, or a point added.
struct WalkStep {
    enum class Kind : std::uint8_t { FlagNo, FlagYes, Corner, AbsentCorner, Point, AbsentPoint };

    static WalkStep flag(int context, bool value) {
        return {value ? Kind::FlagYes : Kind::FlagNo, static_cast<std::uint8_t>(context)};
    }
    Kind absentKind() const { return isCorner() ? Kind::AbsentCorner : Kind::AbsentPoint; }
    bool isFlag() const { return kind <= Kind::FlagYes; }
    bool isCorner() const { return kind == Kind::Corner || kind == Kind::AbsentCorner; }
    bool isVertex() const { return kind == Kind::Corner || kind == Kind::Point; }

    Kind kind = Kind::FlagNo;
    std::uint8_t context = 0;  ///< of the flag or the height, see tile_model.h
    std::uint16_t apex = 0;    ///< of a Point, numbers of those it lies between
    std::uint16_t left = 0;
    std::uint16_t right = 0;
};
static_assert(sizeof(WalkStep) == 8);

/// One tile's triangulation, measured. Vertices and triangles are in TileTriangulation's order.
struct TileMesh {
    BoundedList<TileVertex> vertices{kMaxTileVertices};
    std::vector<std::uint16_t> indices;  ///< by parts, see kTileParts
    std::array<IndexRange, kTileParts> parts;
    /// The walk, so that the encoder need not repeat it. Points that no triangle uses are no
    /// vertices, nor is nodata.
    TileShape shape;
    BoundedList<WalkStep> walk{2 * kMaxTileVertices};  ///< as many flags as points, at most
    bool isSparse = false;                             ///< some point of the walk is no vertex
    /// Greatest vertical deviations of any triangle of any part from the source, nodata left out.
    PartErrors errors;
    /// Of triangles, dropped or not, that are split no further and cover both data and nodata.
    double outlineMetres = 0;
    std::uint16_t nodataParts = 0;  ///< where data and nodata meet, see TileRecord
    double minHeightMetres = std::numeric_limits<double>::infinity();  ///< of the vertices
    double maxHeightMetres = -std::numeric_limits<double>::infinity();

    /// Keeps the memory. Shape and parts are of no meaning then.
    void clear();
    std::uint32_t ownTriangles() const { return (parts[kFinerPart].first) / 3; }
};

/// Cuts one tile after the other out of the global triangulation that VertexLevels chose.
///
/// A tile's corners and centre are always vertices. So a diagonal ends in every corner, no triangle
/// has sides on two borders, and each border can be exchanged on its own for the form that meets a
/// finer neighbour: every border triangle becomes a fan, from the corner off the border, over the
/// vertices that the finer level has there. Both sides of a border then draw the same vertices, at
/// the same heights, since a post's height is quantised the same in all levels.
///
/// Keeps scratch memory: one object per thread. Keeps references to what it is made from.
class TileMesher {
public:
    TileMesher(SourceSurface& surface, TileSamples& samples, const HeightLattice& lattice,
               const Quadtree& quadtree);

    /// Loads the tile's samples. Without the triangles that clamping squeezed to nothing or that
    /// touch nodata. Valid until the next call.
    const TileMesh& mesh(const TileId& tile);

private:
    friend class TileTriangulation<TileMesher>;

    std::int32_t column(TilePoint p) const { return firstColumn_ + (p.x() << shift_ >> 1); }
    std::int32_t row(TilePoint p) const { return firstRow_ + (p.y() << shift_ >> 1); }
    void begin(const TileId& tile);
    void finish();

    // What TileTriangulation asks and tells.
    bool isVertex(TilePoint middle, const SplitContext& context);
    bool isFinerVertex(TilePoint middle, int length);
    std::uint16_t addCorner(TilePoint p, TilePoint);
    std::uint16_t addMiddle(TilePoint p, TilePoint apex, TilePoint left, TilePoint right,
                            int steps);
    std::uint16_t addFinerMiddle(TilePoint p, TilePoint apex, TilePoint from, TilePoint to, int);
    void triangle(int part, TilePoint a, TilePoint b, TilePoint c);
    void finerTriangle(int part, TilePoint apex, TilePoint from, TilePoint to, bool isWhole);

    std::uint16_t add(TilePoint p, WalkStep step);
    void addTriangle(int part, TilePoint a, TilePoint b, TilePoint c);
    void measureDropped();
    Corner corner(const TileVertex& vertex) const;
    Corner corner(TilePoint p) const;
    bool isHalfCell(const PartErrors::Rectangle& covered) const;
    bool mayBeWorst(const PartErrors::Rectangle& covered, TilePoint apex, TilePoint left,
                    TilePoint right) const;
    void measure(const PartErrors::Rectangle& covered, TilePoint a, TilePoint b, TilePoint c,
                 bool mayBeAligned);
    float sourceHeight(TilePoint p) const;
    void markNodata(const PartErrors::Rectangle& covered);
    void countVertex(const TileVertex& vertex, double movedMetres);
    std::vector<std::uint16_t> dropUnused();
    void measureVertices(const std::vector<std::uint16_t>& numbers);

    SourceSurface& surface_;
    OutlineError outline_;
    TileSamples& samples_;
    const double stepMetres_;
    const double stepsPerMetre_;
    const Quadtree& quadtree_;

    TileId tile_;
    int shift_ = 0;  ///< of the level's sample spacing
    std::int32_t firstColumn_ = 0;
    std::int32_t firstRow_ = 0;
    bool isCut_ = false;  ///< reaches past the last column or row
    bool mayHaveUnused_ = false;
    TileMesh mesh_;
    std::vector<BoundedList<std::uint16_t>> partIndices_;
    BoundedList<double> moved_;  ///< by how many metres each vertex added was, for the lattice
    std::vector<std::uint16_t> slots_;
    /// That mixes data and nodata.
    struct DroppedTriangle {
        Triangle triangle;
        std::array<std::uint16_t, 3> numbers;  ///< of vertices
    };
    std::vector<DroppedTriangle> dropped_;
};

}  // namespace eyrie::terrain
