// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "renderer/terrain/deviation.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/quadtree.h"
#include "renderer/terrain/tile_samples.h"
#include "renderer/terrain/vertex_packing.h"

namespace eyrie::terrain {

/// One tile's triangulation, measured.
struct TileMesh {
    std::vector<TileVertex> vertices;
    std::vector<std::uint16_t> indices;  ///< by parts, see kTileParts
    std::array<IndexRange, kTileParts> parts;
    /// Greatest deviation of any triangle of any part from the source, nodata included.
    double errorMetres = 0;
    double minHeightMetres = std::numeric_limits<double>::infinity();  ///< of the vertices
    double maxHeightMetres = -std::numeric_limits<double>::infinity();

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
    /// touch nodata.
    TileMesh mesh(const TileId& tile);

private:
    /// A lattice point in half sample spacings from the tile's first post.
    struct Point {
        std::int32_t x;
        std::int32_t y;
    };

    std::int32_t column(const Point& p) const { return firstColumn_ + (p.x << shift_ >> 1); }
    std::int32_t row(const Point& p) const { return firstRow_ + (p.y << shift_ >> 1); }
    bool isVertex(const Point& p) const;
    int borderEdge(const Point& a, const Point& b) const;
    void refine(const Point& apex, const Point& left, const Point& right);
    void addLeaf(const Point& a, const Point& b, const Point& c);
    void addFan(int edge, const Point& apex, const Point& from, const Point& to);
    bool isFinerVertex(const Point& p) const;
    Corner corner(const Point& p) const;
    void measure(const Point& a, const Point& b, const Point& c, bool mayBeAligned);
    void addTriangle(int part, const Point& a, const Point& b, const Point& c);
    std::uint16_t vertex(const Point& p);

    SourceSurface& surface_;
    TileSamples& samples_;
    const HeightLattice& lattice_;
    const Quadtree& quadtree_;

    TileId tile_;
    int shift_ = 0;               ///< of the level's sample spacing
    std::int32_t side_ = 0;       ///< of the tile, in half spacings
    std::int32_t finerStep_ = 1;  ///< half spacings between samples of the finer level
    std::int32_t firstColumn_ = 0;
    std::int32_t firstRow_ = 0;
    bool isCut_ = false;  ///< reaches past the last column or row
    std::array<bool, kEdges> hasNeighbour_{};
    TileMesh mesh_;
    std::array<std::vector<std::uint16_t>, kTileParts> partIndices_;
    std::vector<std::uint16_t> slots_;  ///< vertex number by point, kNoSlot where there is none
};

}  // namespace eyrie::terrain
