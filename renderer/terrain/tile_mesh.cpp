// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/tile_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace eyrie::terrain {
namespace {

/// The first half spacing that lies `posts` posts or more from the tile's first post.
std::int32_t limit(std::int32_t posts, int shift, std::int32_t side) {
    std::int32_t half = std::min(side, posts * 2 >> shift);
    while (half < side && half << shift >> 1 < posts) ++half;
    return half;
}

}  // namespace

TileMesher::TileMesher(SourceSurface& surface, TileSamples& samples, const HeightLattice& lattice,
                       const Quadtree& quadtree)
    : surface_(surface), samples_(samples), lattice_(lattice), quadtree_(quadtree) {}

TileMesh TileMesher::mesh(const TileId& tile) {
    begin(tile);
    TileTriangulation<TileMesher>(mesh_.shape, slots_, *this).walk();
    finish();
    return std::move(mesh_);
}

void TileMesher::begin(const TileId& tile) {
    tile_ = tile;
    samples_.load(tile);
    const std::int32_t side = Quadtree::side(tile.level);
    shift_ = Quadtree::spacingShift(tile.level);
    firstColumn_ = tile.x * side;
    firstRow_ = tile.y * side;
    isCut_ = firstColumn_ + side >= quadtree_.columns() || firstRow_ + side >= quadtree_.rows();
    mesh_ = {};
    TileShape& shape = mesh_.shape;
    shape.cells = Quadtree::cells(tile.level);
    shape.finerStep = shift_ == Quadtree::spacingShift(tile.level - 1) ? 2 : 1;
    shape.limitX = limit(quadtree_.columns() - 1 - firstColumn_, shift_, 2 * shape.cells);
    shape.limitY = limit(quadtree_.rows() - 1 - firstRow_, shift_, 2 * shape.cells);
    for (int edge = 0; edge < kEdges; ++edge)
        if (tile.level > 0 && quadtree_.contains(Quadtree::neighbour(tile, edge)))
            shape.finerEdges = static_cast<std::uint8_t>(shape.finerEdges | 1 << edge);
    for (std::vector<std::uint16_t>& part : partIndices_) part.clear();
}

/// Numbers by vertex that is used, kAbsentPoint for the others, which are dropped.
std::vector<std::uint16_t> TileMesher::dropUnused() {
    std::vector<std::uint16_t> numbers(mesh_.vertices.size(), kAbsentPoint);
    for (const std::vector<std::uint16_t>& part : partIndices_)
        for (const std::uint16_t index : part) numbers[index] = 0;
    std::size_t kept = 0;
    std::size_t old = 0;
    for (std::uint8_t& isPresent : mesh_.isPresent) {
        if (isPresent == 0)
            continue;
        if (numbers[old] == kAbsentPoint) {
            isPresent = 0;
        } else {
            numbers[old] = static_cast<std::uint16_t>(kept);
            mesh_.vertices[kept++] = mesh_.vertices[old];
        }
        ++old;
    }
    mesh_.vertices.resize(kept);
    return numbers;
}

/// Puts the parts together and measures what is used.
void TileMesher::finish() {
    if (isCut_ || surface_.hasNodata()) {
        const std::vector<std::uint16_t> numbers = dropUnused();
        for (std::vector<std::uint16_t>& part : partIndices_)
            for (std::uint16_t& index : part) index = numbers[index];
    }
    for (std::size_t part = 0; part < kTileParts; ++part) {
        mesh_.parts[part] = {static_cast<std::uint32_t>(mesh_.indices.size()),
                             static_cast<std::uint32_t>(partIndices_[part].size())};
        mesh_.indices.insert(mesh_.indices.end(), partIndices_[part].begin(),
                             partIndices_[part].end());
    }
    for (const TileVertex& vertex : mesh_.vertices) {
        const TilePoint p{static_cast<std::uint32_t>(vertex.x | vertex.y << 10), 0, 0};
        const float source = samples_.height(std::min(column(p), quadtree_.columns() - 1),
                                             std::min(row(p), quadtree_.rows() - 1));
        const double drawn = vertex.q * lattice_.stepMetres;
        const double deviation = std::abs(drawn - static_cast<double>(source));
        mesh_.errorMetres = std::max(mesh_.errorMetres, deviation);
        forEachPart(vertex.x - 1, vertex.y - 1, vertex.x + 1, vertex.y + 1,
                    [&](double& error) { error = std::max(error, deviation); });
        mesh_.minHeightMetres = std::min(mesh_.minHeightMetres, drawn);
        mesh_.maxHeightMetres = std::max(mesh_.maxHeightMetres, drawn);
    }
}

bool TileMesher::isVertex(TilePoint middle, const SplitContext&) {
    const bool isNeeded = samples_.isNeeded(column(middle), row(middle), tile_.level);
    mesh_.splits.push_back(isNeeded);
    return isNeeded;
}

/// A vertex of the next finer level's tiles along this tile's border.
bool TileMesher::isFinerVertex(TilePoint middle, int) {
    const bool isNeeded = samples_.isNeeded(column(middle), row(middle), tile_.level - 1);
    mesh_.splits.push_back(isNeeded);
    return isNeeded;
}

void TileMesher::triangle(int part, TilePoint a, TilePoint b, TilePoint c) {
    measure(a, b, c, true);
    addTriangle(part, a, b, c);
}

void TileMesher::finerTriangle(int part, TilePoint apex, TilePoint from, TilePoint to,
                               bool isWhole) {
    if (!isWhole)
        measure(apex, from, to, false);
    addTriangle(part, apex, from, to);
}

Corner TileMesher::corner(TilePoint p) const {
    const std::int32_t i = std::min(column(p), quadtree_.columns() - 1);
    const std::int32_t j = std::min(row(p), quadtree_.rows() - 1);
    const float height = samples_.height(i, j);
    return {i, j,
            std::isnan(height) ? static_cast<double>(height)
                               : lattice_.quantise(height) * lattice_.stepMetres};
}

void TileMesher::measure(TilePoint a, TilePoint b, TilePoint c, bool mayBeAligned) {
    const std::int32_t width = std::max({a.x(), b.x(), c.x()}) - std::min({a.x(), b.x(), c.x()});
    const std::int32_t height = std::max({a.y(), b.y(), c.y()}) - std::min({a.y(), b.y(), c.y()});
    if (shift_ == 0 && width == 2 && height == 2)
        return;  // half a cell: all its posts are vertices, and those are measured as such
    const Triangle triangle = {corner(a), corner(b), corner(c)};
    const auto isUnmoved = [&](TilePoint p) {
        return column(p) < quadtree_.columns() && row(p) < quadtree_.rows();
    };
    const std::int32_t x0 = std::min({a.x(), b.x(), c.x()});
    const std::int32_t y0 = std::min({a.y(), b.y(), c.y()});
    DeviationGoal goal{mesh_.errorMetres};
    const auto forParts = [&](auto visit) { forEachPart(x0, y0, x0 + width, y0 + height, visit); };
    forParts([&](double error) { goal.floor = std::min(goal.floor, error); });
    double deviation = 0;
    if (mayBeAligned && (!isCut_ || (isUnmoved(a) && isUnmoved(b) && isUnmoved(c))))
        deviation = surface_.ofAligned(triangle, goal);
    else if (std::int64_t{triangle[1].i - triangle[0].i} * (triangle[2].j - triangle[0].j) !=
             std::int64_t{triangle[2].i - triangle[0].i} * (triangle[1].j - triangle[0].j))
        deviation = surface_.ofGeneral(triangle, goal);
    mesh_.errorMetres = std::max(mesh_.errorMetres, deviation);
    // A mixed triangle deviates by its longest edge.
    mesh_.mixesNodata = mesh_.mixesNodata ||
                        (surface_.hasNodata() && deviation >= surface_.longestEdgeMetres(triangle));
    forParts([&](double& error) { error = std::max(error, deviation); });
}

template <typename Visit>
void TileMesher::forEachPart(std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1,
                             Visit visit) {
    const std::int32_t side = 2 * mesh_.shape.cells / kTilePartsPerSide;
    const auto part = [&](std::int32_t at) {
        return static_cast<std::size_t>(std::clamp(at / side, 0, kTilePartsPerSide - 1));
    };
    for (std::size_t y = part(y0); y <= part(y1 - 1); ++y)
        for (std::size_t x = part(x0); x <= part(x1 - 1); ++x) visit(mesh_.partErrorMetres[y][x]);
}

void TileMesher::addTriangle(int part, TilePoint a, TilePoint b, TilePoint c) {
    if (a.isAbsent() || b.isAbsent() || c.isAbsent())
        return;
    std::vector<std::uint16_t>& indices = partIndices_[static_cast<std::size_t>(part)];
    indices.insert(indices.end(), {a.number, b.number, c.number});
}

std::uint16_t TileMesher::add(TilePoint p) {
    const float source = samples_.height(std::min(column(p), quadtree_.columns() - 1),
                                         std::min(row(p), quadtree_.rows() - 1));
    mesh_.isPresent.push_back(!std::isnan(source));
    if (std::isnan(source))
        return kAbsentPoint;
    mesh_.vertices.push_back({p.x(), p.y(), lattice_.quantise(source)});
    return static_cast<std::uint16_t>(mesh_.vertices.size() - 1);
}

}  // namespace eyrie::terrain
