// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/tile_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "renderer/terrain/always_drawn.h"

namespace eyrie::terrain {
namespace {

/// The first half spacing that lies `posts` posts or more from the tile's first post.
std::int32_t limit(std::int32_t posts, int shift, std::int32_t side) {
    std::int32_t half = std::min(side, posts * 2 >> shift);
    while (half < side && half << shift >> 1 < posts) ++half;
    return half;
}

inline PartErrors::Rectangle extent(TilePoint a, TilePoint b, TilePoint c) {
    return {std::min({a.x(), b.x(), c.x()}), std::min({a.y(), b.y(), c.y()}),
            std::max({a.x(), b.x(), c.x()}), std::max({a.y(), b.y(), c.y()})};
}

inline std::size_t at(const TileSamples& samples, TilePoint p) { return samples.at(p.x(), p.y()); }

}  // namespace

void TileMesh::clear() {
    vertices.clear();
    indices.clear();
    walk.clear();
    isSparse = false;
    outlineMetres = 0;
    nodataParts = 0;
    minHeightMetres = std::numeric_limits<double>::infinity();
    maxHeightMetres = -std::numeric_limits<double>::infinity();
}

TileMesher::TileMesher(SourceSurface& surface, TileSamples& samples, const HeightLattice& lattice,
                       const Quadtree& quadtree)
    : surface_(surface),
      outline_(surface),
      samples_(samples),
      stepMetres_(lattice.stepMetres),
      stepsPerMetre_(lattice.stepsPerMetre()),
      quadtree_(quadtree),
      moved_(kMaxTileVertices) {
    for (int part = 0; part < kTileParts; ++part)
        partIndices_.emplace_back(3 *
                                  (part == kInteriorPart ? kMaxOwnTriangles : kMaxBorderTriangles));
}

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
    mayHaveUnused_ = isCut_ || surface_.hasNodata();
    mesh_.clear();
    mesh_.errors = PartErrors(Quadtree::cells(tile.level));
    mesh_.shape = {};
    TileShape& shape = mesh_.shape;
    shape.cells = Quadtree::cells(tile.level);
    shape.finerStep = shift_ == Quadtree::spacingShift(tile.level - 1) ? 2 : 1;
    shape.limitX = limit(quadtree_.columns() - 1 - firstColumn_, shift_, 2 * shape.cells);
    shape.limitY = limit(quadtree_.rows() - 1 - firstRow_, shift_, 2 * shape.cells);
    for (int edge = 0; edge < kEdges; ++edge)
        if (tile.level > 0 && quadtree_.contains(Quadtree::neighbour(tile, edge)))
            shape.finerEdges = static_cast<std::uint8_t>(shape.finerEdges | 1 << edge);
    for (BoundedList<std::uint16_t>& part : partIndices_) part.clear();
    moved_.clear();
    dropped_.clear();
}

/// Numbers by vertex that is used, kAbsentPoint for the others, which are dropped.
std::vector<std::uint16_t> TileMesher::dropUnused() {
    std::vector<std::uint16_t> numbers(mesh_.vertices.size(), kAbsentPoint);
    for (const BoundedList<std::uint16_t>& part : partIndices_)
        for (const std::uint16_t index : part) numbers[index] = 0;
    std::size_t kept = 0;
    std::size_t old = 0;
    const auto renumbered = [&](std::uint16_t number) {
        return number == kAbsentPoint ? kAbsentPoint : numbers[number];
    };
    for (WalkStep& step : mesh_.walk) {
        if (step.isFlag())
            continue;
        if (!step.isCorner())
            for (std::uint16_t* number : {&step.apex, &step.left, &step.right})
                *number = renumbered(*number);
        if (!step.isVertex())
            continue;
        if (numbers[old] == kAbsentPoint) {
            step.kind = step.absentKind();
            mesh_.isSparse = true;
        } else {
            numbers[old] = static_cast<std::uint16_t>(kept);
            mesh_.vertices[kept++] = mesh_.vertices[old];
        }
        ++old;
    }
    mesh_.vertices.shrink(kept);
    return numbers;
}

/// Triangles that are not drawn are as far off as their data are from something that is.
void TileMesher::measureDropped() {
    if (dropped_.empty())
        return;
    std::vector<Corner> corners;
    for (const TileVertex& vertex : mesh_.vertices) corners.push_back(corner(vertex));
    const AlwaysDrawn drawn(partIndices_, mesh_.shape.finerEdges, std::move(corners));
    double& outline = mesh_.outlineMetres;
    std::vector<DrawnSide> around;  // of the one before: the next is mostly beside it
    for (const auto& [triangle, numbers] : dropped_) {
        if (drawn.empty()) {
            outline = std::max(outline, outline_.around(triangle));
            continue;
        }
        std::vector<DrawnSide> near = drawn.of(numbers);
        if (near.empty())
            near = around;
        // Few tell more than those before, and for those few it pays to look around.
        if (!near.empty() && outline_.ofDropped(triangle, near, outline) <= outline)
            continue;
        around = drawn.around(triangle);
        outline = outline_.ofDropped(triangle, around, outline);
    }
}

/// Puts the parts together and measures what is used.
void TileMesher::finish() {
    measureDropped();
    std::vector<std::uint16_t> numbers;
    if (mayHaveUnused_) {
        numbers = dropUnused();
        for (BoundedList<std::uint16_t>& part : partIndices_)
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
    std::int32_t lowest = mesh_.vertices[0].q;
    std::int32_t highest = lowest;
    for (const TileVertex& vertex : mesh_.vertices) {
        lowest = std::min(lowest, vertex.q);
        highest = std::max(highest, vertex.q);
    }
    mesh_.minHeightMetres = lowest * stepMetres_;
    mesh_.maxHeightMetres = highest * stepMetres_;
}

bool TileMesher::isVertex(TilePoint middle, const SplitContext& context) {
    const bool isNeeded = samples_.isNeeded(at(samples_, middle), tile_.level);
    mesh_.walk.push(WalkStep::flag(splitContext(context), isNeeded));
    return isNeeded;
}

/// A vertex of the next finer level's tiles along this tile's border.
bool TileMesher::isFinerVertex(TilePoint middle, int length) {
    const bool isNeeded = samples_.isNeeded(at(samples_, middle), tile_.level - 1);
    mesh_.walk.push(WalkStep::flag(finerContext(length), isNeeded));
    return isNeeded;
}

void TileMesher::triangle(int part, TilePoint a, TilePoint b, TilePoint c) {
    const PartErrors::Rectangle covered = extent(a, b, c);
    if (!isHalfCell(covered) && mayBeWorst(covered, a, b, c))
        measure(covered, a, b, c, true);
    addTriangle(part, a, b, c);
}

void TileMesher::finerTriangle(int part, TilePoint apex, TilePoint from, TilePoint to,
                               bool isWhole) {
    const PartErrors::Rectangle covered = extent(apex, from, to);
    if (!isWhole && !isHalfCell(covered))
        measure(covered, apex, from, to, false);
    addTriangle(part, apex, from, to);
}

Corner TileMesher::corner(const TileVertex& vertex) const {
    return {std::min(firstColumn_ + (vertex.x << shift_ >> 1), quadtree_.columns() - 1),
            std::min(firstRow_ + (vertex.y << shift_ >> 1), quadtree_.rows() - 1),
            vertex.q * stepMetres_};
}

Corner TileMesher::corner(TilePoint p) const {
    return {std::min(column(p), quadtree_.columns() - 1), std::min(row(p), quadtree_.rows() - 1),
            p.isAbsent() ? std::numeric_limits<double>::quiet_NaN()
                         : mesh_.vertices[p.number].q * stepMetres_};
}

/// Whether all posts of a triangle of that extent are its vertices, which are measured as such.
bool TileMesher::isHalfCell(const PartErrors::Rectangle& covered) const {
    return shift_ == 0 && covered.x1 - covered.x0 == 2 && covered.y1 - covered.y0 == 2;
}

/// A vertex belongs to all triangles around it.
void TileMesher::countVertex(const TileVertex& vertex, double movedMetres) {
    mesh_.errors.raise({vertex.x - 1, vertex.y - 1, vertex.x + 1, vertex.y + 1}, movedMetres);
}

/// Whether a triangle of the global triangulation may deviate more than any so far of the parts
/// that it lies in. VertexLevels has measured it with the source's heights; here its corners have
/// moved to the lattice.
bool TileMesher::mayBeWorst(const PartErrors::Rectangle& covered, TilePoint apex, TilePoint left,
                            TilePoint right) const {
    if (mayHaveUnused_ || apex.isAbsent() || left.isAbsent() || right.isAbsent())
        return true;  // nodata has to be seen
    const TilePoint middle{(left.position + right.position) / 2, 0, 0};
    const double moved = std::max({moved_[apex.number], moved_[left.number], moved_[right.number]});
    return samples_.greatestDeviationMetres(at(samples_, middle)) + moved >=
           mesh_.errors.least(covered);
}

void TileMesher::measure(const PartErrors::Rectangle& covered, TilePoint a, TilePoint b,
                         TilePoint c, bool mayBeAligned) {
    const Triangle triangle = {corner(a), corner(b), corner(c)};
    const auto isUnmoved = [&](TilePoint p) {
        return column(p) < quadtree_.columns() && row(p) < quadtree_.rows();
    };
    const DeviationGoal goal{mesh_.errors.least(covered)};
    double deviation = 0;
    const bool isAligned =
        mayBeAligned && (!isCut_ || (isUnmoved(a) && isUnmoved(b) && isUnmoved(c)));
    if (isAligned)
        deviation = surface_.ofAligned(triangle, goal);
    else if (std::int64_t{triangle[1].i - triangle[0].i} * (triangle[2].j - triangle[0].j) !=
             std::int64_t{triangle[2].i - triangle[0].i} * (triangle[1].j - triangle[0].j))
        deviation = surface_.ofGeneral(triangle, goal);
    // A mixed triangle counts as its longest edge.
    if (const double edge = surface_.hasNodata() ? surface_.longestEdgeMetres(triangle) : 0;
        surface_.hasNodata() && deviation >= edge && surface_.mixes(triangle, isAligned)) {
        if (a.isAbsent() || b.isAbsent() || c.isAbsent())
            dropped_.push_back({triangle, {a.number, b.number, c.number}});
        else
            mesh_.outlineMetres = outline_.ofDrawn(triangle, mesh_.outlineMetres);
        markNodata(covered);
        return;
    }
    mesh_.errors.raise(covered, deviation);
}

void TileMesher::markNodata(const PartErrors::Rectangle& covered) {
    mesh_.nodataParts = static_cast<std::uint16_t>(mesh_.nodataParts | mesh_.errors.mask(covered));
}

void TileMesher::addTriangle(int part, TilePoint a, TilePoint b, TilePoint c) {
    if (a.isAbsent() || b.isAbsent() || c.isAbsent()) {
        if (!a.isAbsent() || !b.isAbsent() || !c.isAbsent())
            markNodata(extent(a, b, c));
        return;
    }
    std::uint16_t* out = partIndices_[static_cast<std::size_t>(part)].grow(3);
    out[0] = a.number;
    out[1] = b.number;
    out[2] = c.number;
}

std::uint16_t TileMesher::addCorner(TilePoint p, TilePoint) {
    return add(p, {.kind = WalkStep::Kind::Corner});
}

std::uint16_t TileMesher::addMiddle(TilePoint p, TilePoint apex, TilePoint left, TilePoint right,
                                    int steps) {
    return add(
        p, {WalkStep::Kind::Point, middleContext(steps), apex.number, left.number, right.number});
}

std::uint16_t TileMesher::addFinerMiddle(TilePoint p, TilePoint apex, TilePoint from, TilePoint to,
                                         int) {
    return add(p,
               {WalkStep::Kind::Point, kFinerHeightContext, apex.number, from.number, to.number});
}

float TileMesher::sourceHeight(TilePoint p) const {
    if (!isCut_) [[likely]]
        return samples_.height(at(samples_, p));
    return samples_.height(samples_.atPost(std::min(column(p), quadtree_.columns() - 1),
                                           std::min(row(p), quadtree_.rows() - 1)));
}

/// The point that a step of the walk is about.
std::uint16_t TileMesher::add(TilePoint p, WalkStep step) {
    const float source = sourceHeight(p);
    if (std::isnan(source)) {
        step.kind = step.absentKind();
        mesh_.walk.push(step);
        mesh_.isSparse = true;
        return kAbsentPoint;
    }
    mesh_.walk.push(step);
    const auto number = static_cast<std::uint16_t>(mesh_.vertices.size());
    const std::int32_t q = HeightLattice::quantise(source, stepsPerMetre_);
    const double moved = std::abs(q * stepMetres_ - static_cast<double>(source));
    // Field by field: put together in a register first, it waits for its own halves.
    TileVertex& vertex = *mesh_.vertices.grow(1);
    vertex.x = p.x();
    vertex.y = p.y();
    vertex.q = q;
    moved_.push(moved);
    if (!mayHaveUnused_)  // else it counts once it is known to be used
        countVertex(vertex, moved);
    return number;
}

}  // namespace eyrie::terrain
