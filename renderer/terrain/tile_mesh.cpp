// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/tile_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

void TileMesh::clear() {
    vertices.clear();
    indices.clear();
    splits.clear();
    isPresent.clear();
    errorMetres = 0;
    partErrorMetres = {};
    mixesNodata = false;
    minHeightMetres = std::numeric_limits<double>::infinity();
    maxHeightMetres = -std::numeric_limits<double>::infinity();
}

TileMesher::TileMesher(SourceSurface& surface, TileSamples& samples, const HeightLattice& lattice,
                       const Quadtree& quadtree)
    : surface_(surface), samples_(samples), lattice_(lattice), quadtree_(quadtree) {}

const TileMesh& TileMesher::mesh(const TileId& tile) {
    begin(tile);
    TileTriangulation<TileMesher>(mesh_.shape, slots_, *this).walk();
    finish();
    return mesh_;
}

void TileMesher::begin(const TileId& tile) {
    tile_ = tile;
    samples_.load(tile);
    const std::int32_t side = Quadtree::side(tile.level);
    shift_ = Quadtree::spacingShift(tile.level);
    firstColumn_ = tile.x * side;
    firstRow_ = tile.y * side;
    isCut_ = firstColumn_ + side >= quadtree_.columns() || firstRow_ + side >= quadtree_.rows();
    mesh_.clear();
    mesh_.shape = {};
    TileShape& shape = mesh_.shape;
    shape.cells = Quadtree::cells(tile.level);
    shape.finerStep = shift_ == Quadtree::spacingShift(tile.level - 1) ? 2 : 1;
    shape.limitX = limit(quadtree_.columns() - 1 - firstColumn_, shift_, 2 * shape.cells);
    shape.limitY = limit(quadtree_.rows() - 1 - firstRow_, shift_, 2 * shape.cells);
    for (int edge = 0; edge < kEdges; ++edge)
        if (tile.level > 0 && quadtree_.contains(Quadtree::neighbour(tile, edge)))
            shape.finerEdges = static_cast<std::uint8_t>(shape.finerEdges | 1 << edge);
    for (std::vector<std::uint16_t>& part : partIndices_) part.clear();
    moved_.clear();
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
    std::vector<std::uint16_t> numbers;
    if (mayHaveUnused()) {
        numbers = dropUnused();
        for (std::vector<std::uint16_t>& part : partIndices_)
            for (std::uint16_t& index : part) index = numbers[index];
    }
    for (std::size_t part = 0; part < kTileParts; ++part) {
        mesh_.parts[part] = {static_cast<std::uint32_t>(mesh_.indices.size()),
                             static_cast<std::uint32_t>(partIndices_[part].size())};
        mesh_.indices.insert(mesh_.indices.end(), partIndices_[part].begin(),
                             partIndices_[part].end());
    }
    measureVertices(numbers);
}

/// `numbers` is what dropUnused gave; empty where all vertices have been counted.
void TileMesher::measureVertices(const std::vector<std::uint16_t>& numbers) {
    for (std::size_t k = 0; k < numbers.size(); ++k)
        if (numbers[k] != kAbsentPoint)
            countVertex(mesh_.vertices[numbers[k]], moved_[k]);
    if (mesh_.vertices.empty())
        return;
    std::int32_t lowest = mesh_.vertices.front().q;
    std::int32_t highest = lowest;
    for (const TileVertex& vertex : mesh_.vertices) {
        lowest = std::min(lowest, vertex.q);
        highest = std::max(highest, vertex.q);
    }
    mesh_.minHeightMetres = lowest * lattice_.stepMetres;
    mesh_.maxHeightMetres = highest * lattice_.stepMetres;
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
    // Its hypotenuse tells half a cell.
    if (!isHalfCell(b, c, c) && mayBeWorst(a, b, c))
        measure(a, b, c, true);
    addTriangle(part, a, b, c);
}

void TileMesher::finerTriangle(int part, TilePoint apex, TilePoint from, TilePoint to,
                               bool isWhole) {
    if (!isWhole && !isHalfCell(apex, from, to))
        measure(apex, from, to, false);
    addTriangle(part, apex, from, to);
}

Corner TileMesher::corner(TilePoint p) const {
    return {std::min(column(p), quadtree_.columns() - 1), std::min(row(p), quadtree_.rows() - 1),
            p.isAbsent() ? std::numeric_limits<double>::quiet_NaN()
                         : mesh_.vertices[p.number].q * lattice_.stepMetres};
}

TileMesher::Rectangle TileMesher::extent(TilePoint a, TilePoint b, TilePoint c) {
    return {std::min({a.x(), b.x(), c.x()}), std::min({a.y(), b.y(), c.y()}),
            std::max({a.x(), b.x(), c.x()}), std::max({a.y(), b.y(), c.y()})};
}

/// Whether all posts of a triangle are its vertices, which are measured as such.
bool TileMesher::isHalfCell(TilePoint a, TilePoint b, TilePoint c) const {
    if (shift_ != 0)
        return false;
    const Rectangle covered = extent(a, b, c);
    return covered.x1 - covered.x0 == 2 && covered.y1 - covered.y0 == 2;
}

template <typename Visit>
void TileMesher::forEachPart(const Rectangle& covered, Visit visit) {
    const std::int32_t side = 2 * mesh_.shape.cells / kTilePartsPerSide;
    const auto part = [&](std::int32_t at) {
        return static_cast<std::size_t>(std::clamp(at / side, 0, kTilePartsPerSide - 1));
    };
    for (std::size_t y = part(covered.y0); y <= part(covered.y1 - 1); ++y)
        for (std::size_t x = part(covered.x0); x <= part(covered.x1 - 1); ++x)
            visit(mesh_.partErrorMetres[y][x]);
}

double TileMesher::leastPartError(const Rectangle& covered) {
    double least = mesh_.errorMetres;
    forEachPart(covered, [&](double error) { least = std::min(least, error); });
    return least;
}

void TileMesher::countError(const Rectangle& covered, double deviationMetres) {
    mesh_.errorMetres = std::max(mesh_.errorMetres, deviationMetres);
    forEachPart(covered, [&](double& error) { error = std::max(error, deviationMetres); });
}

/// A vertex belongs to all triangles around it.
void TileMesher::countVertex(const TileVertex& vertex, double movedMetres) {
    countError({vertex.x - 1, vertex.y - 1, vertex.x + 1, vertex.y + 1}, movedMetres);
}

/// Whether a triangle of the global triangulation may deviate more than any so far of the parts
/// that it lies in. VertexLevels has measured it with the source's heights; here its corners have
/// moved to the lattice.
bool TileMesher::mayBeWorst(TilePoint apex, TilePoint left, TilePoint right) {
    if (mayHaveUnused() || apex.isAbsent() || left.isAbsent() || right.isAbsent())
        return true;  // nodata has to be seen
    const TilePoint middle{(left.position + right.position) / 2, 0, 0};
    const double moved = std::max({moved_[apex.number], moved_[left.number], moved_[right.number]});
    return samples_.greatestDeviationMetres(column(middle), row(middle)) + moved >=
           leastPartError(extent(apex, left, right));
}

void TileMesher::measure(TilePoint a, TilePoint b, TilePoint c, bool mayBeAligned) {
    const Triangle triangle = {corner(a), corner(b), corner(c)};
    const auto isUnmoved = [&](TilePoint p) {
        return column(p) < quadtree_.columns() && row(p) < quadtree_.rows();
    };
    const Rectangle covered = extent(a, b, c);
    const DeviationGoal goal{leastPartError(covered)};
    double deviation = 0;
    if (mayBeAligned && (!isCut_ || (isUnmoved(a) && isUnmoved(b) && isUnmoved(c))))
        deviation = surface_.ofAligned(triangle, goal);
    else if (std::int64_t{triangle[1].i - triangle[0].i} * (triangle[2].j - triangle[0].j) !=
             std::int64_t{triangle[2].i - triangle[0].i} * (triangle[1].j - triangle[0].j))
        deviation = surface_.ofGeneral(triangle, goal);
    // A mixed triangle deviates by its longest edge.
    mesh_.mixesNodata = mesh_.mixesNodata ||
                        (surface_.hasNodata() && deviation >= surface_.longestEdgeMetres(triangle));
    countError(covered, deviation);
}

void TileMesher::addTriangle(int part, TilePoint a, TilePoint b, TilePoint c) {
    if (a.isAbsent() || b.isAbsent() || c.isAbsent())
        return;
    std::vector<std::uint16_t>& indices = partIndices_[static_cast<std::size_t>(part)];
    for (const std::uint16_t number : {a.number, b.number, c.number}) indices.push_back(number);
}

std::uint16_t TileMesher::add(TilePoint p) {
    const float source = samples_.height(std::min(column(p), quadtree_.columns() - 1),
                                         std::min(row(p), quadtree_.rows() - 1));
    mesh_.isPresent.push_back(!std::isnan(source));
    if (std::isnan(source))
        return kAbsentPoint;
    const std::int32_t q = lattice_.quantise(source);
    mesh_.vertices.push_back({p.x(), p.y(), q});
    moved_.push_back(std::abs(q * lattice_.stepMetres - static_cast<double>(source)));
    if (!mayHaveUnused())  // else it counts once it is known to be used
        countVertex(mesh_.vertices.back(), moved_.back());
    return static_cast<std::uint16_t>(mesh_.vertices.size() - 1);
}

}  // namespace eyrie::terrain
