// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/tile_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace eyrie::terrain {
namespace {

constexpr std::uint16_t kNoSlot = 0xffff;

}  // namespace

TileMesher::TileMesher(SourceSurface& surface, TileSamples& samples, const HeightLattice& lattice,
                       const Quadtree& quadtree)
    : surface_(surface), samples_(samples), lattice_(lattice), quadtree_(quadtree) {}

TileMesh TileMesher::mesh(const TileId& tile) {
    tile_ = tile;
    samples_.load(tile);
    const std::int32_t side = Quadtree::side(tile.level);
    shift_ = Quadtree::spacingShift(tile.level);
    side_ = 2 * Quadtree::cells(tile.level);
    finerStep_ = shift_ == Quadtree::spacingShift(tile.level - 1) ? 2 : 1;
    firstColumn_ = tile.x * side;
    firstRow_ = tile.y * side;
    isCut_ = firstColumn_ + side >= quadtree_.columns() || firstRow_ + side >= quadtree_.rows();
    for (int edge = 0; edge < kEdges; ++edge)
        hasNeighbour_[static_cast<std::size_t>(edge)] =
            quadtree_.contains(Quadtree::neighbour(tile, edge));
    mesh_ = {};
    slots_.assign(static_cast<std::size_t>((side_ + 1) * (side_ + 1)), kNoSlot);
    for (std::vector<std::uint16_t>& part : partIndices_) part.clear();

    const Point centre{side_ / 2, side_ / 2};
    const std::array<Point, 5> around = {{{0, 0}, {side_, 0}, {side_, side_}, {0, side_}, {0, 0}}};
    for (std::size_t k = 0; k < 4; ++k) refine(centre, around[k], around[k + 1]);

    for (std::size_t part = 0; part < kTileParts; ++part) {
        mesh_.parts[part] = {static_cast<std::uint32_t>(mesh_.indices.size()),
                             static_cast<std::uint32_t>(partIndices_[part].size())};
        mesh_.indices.insert(mesh_.indices.end(), partIndices_[part].begin(),
                             partIndices_[part].end());
    }
    return std::move(mesh_);
}

bool TileMesher::isVertex(const Point& p) const {
    return samples_.isNeeded(column(p), row(p), tile_.level);
}

/// A vertex of the next finer level's tiles along this tile's border: theirs by need, or a corner.
bool TileMesher::isFinerVertex(const Point& p) const {
    return p.x + p.y == side_ / 2 || p.x + p.y == side_ + side_ / 2 ||
           samples_.isNeeded(column(p), row(p), tile_.level - 1);
}

/// Splits the triangle of right angle `apex` and hypotenuse left-right, counter-clockwise, as far
/// as the level has vertices.
void TileMesher::refine(const Point& apex, const Point& left, const Point& right) {
    if (isCut_) {  // all of it past the last column or row: squeezed to nothing
        const Point nearest{std::min({apex.x, left.x, right.x}),
                            std::min({apex.y, left.y, right.y})};
        if (column(nearest) >= quadtree_.columns() - 1 || row(nearest) >= quadtree_.rows() - 1)
            return;
    }
    const Point middle{(left.x + right.x) / 2, (left.y + right.y) / 2};
    const bool isOnGrid = ((middle.x | middle.y) & 1) == 0;  // sample positions are even
    if (isOnGrid && isVertex(middle)) {
        refine(middle, apex, left);
        refine(middle, right, apex);
    } else {
        addLeaf(apex, left, right);
    }
}

/// Edge number of a side on the tile's border, -1 otherwise.
int TileMesher::borderEdge(const Point& a, const Point& b) const {
    if (a.x == b.x && (a.x == 0 || a.x == side_))
        return a.x == 0 ? kEdgeMinX : kEdgeMaxX;
    if (a.y == b.y && (a.y == 0 || a.y == side_))
        return a.y == 0 ? kEdgeMinY : kEdgeMaxY;
    return -1;
}

void TileMesher::addLeaf(const Point& a, const Point& b, const Point& c) {
    measure(a, b, c, true);
    const std::array<Point, 5> corners = {a, b, c, a, b};
    int edge = -1;
    std::size_t side = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const int found = borderEdge(corners[k], corners[k + 1]);
        if (found < 0)
            continue;
        assert(edge < 0 && "a triangle has sides on two borders");
        edge = found;
        side = k;
    }
    addTriangle(edge < 0 ? kInteriorPart : kOwnPart + edge, a, b, c);
    if (edge >= 0 && tile_.level > 0 && hasNeighbour_[static_cast<std::size_t>(edge)])
        addFan(edge, corners[side + 2], corners[side], corners[side + 1]);
}

/// The border triangle apex, from, to, split at the finer level's vertices between from and to.
void TileMesher::addFan(int edge, const Point& apex, const Point& from, const Point& to) {
    const std::int32_t dx = finerStep_ * ((to.x > from.x) - (to.x < from.x));
    const std::int32_t dy = finerStep_ * ((to.y > from.y) - (to.y < from.y));
    Point last = from;
    const auto add = [&](const Point& next) {
        if (last.x != from.x || last.y != from.y || next.x != to.x || next.y != to.y)
            measure(apex, last, next, false);
        addTriangle(kFinerPart + edge, apex, last, next);
        last = next;
    };
    for (Point p{from.x + dx, from.y + dy}; p.x != to.x || p.y != to.y; p = {p.x + dx, p.y + dy})
        if (isFinerVertex(p))
            add(p);
    add(to);
}

Corner TileMesher::corner(const Point& p) const {
    const std::int32_t i = std::min(column(p), quadtree_.columns() - 1);
    const std::int32_t j = std::min(row(p), quadtree_.rows() - 1);
    const float height = samples_.height(i, j);
    return {i, j,
            std::isnan(height) ? static_cast<double>(height)
                               : lattice_.quantise(height) * lattice_.stepMetres};
}

void TileMesher::measure(const Point& a, const Point& b, const Point& c, bool mayBeAligned) {
    const std::int32_t width = std::max({a.x, b.x, c.x}) - std::min({a.x, b.x, c.x});
    const std::int32_t height = std::max({a.y, b.y, c.y}) - std::min({a.y, b.y, c.y});
    if (shift_ == 0 && width == 2 && height == 2)
        return;  // half a cell: all its posts are vertices, and those are measured as such
    const Triangle triangle = {corner(a), corner(b), corner(c)};
    const auto isUnmoved = [&](const Point& p) {
        return column(p) < quadtree_.columns() && row(p) < quadtree_.rows();
    };
    double deviation = 0;
    if (mayBeAligned && (!isCut_ || (isUnmoved(a) && isUnmoved(b) && isUnmoved(c))))
        deviation = surface_.ofAligned(triangle, {mesh_.errorMetres});
    else if (std::int64_t{triangle[1].i - triangle[0].i} * (triangle[2].j - triangle[0].j) !=
             std::int64_t{triangle[2].i - triangle[0].i} * (triangle[1].j - triangle[0].j))
        deviation = surface_.ofGeneral(triangle, {mesh_.errorMetres});
    mesh_.errorMetres = std::max(mesh_.errorMetres, deviation);
}

void TileMesher::addTriangle(int part, const Point& a, const Point& b, const Point& c) {
    if (isCut_ || surface_.hasNodata()) {
        const Corner ca = corner(a);
        const Corner cb = corner(b);
        const Corner cc = corner(c);
        if (std::int64_t{cb.i - ca.i} * (cc.j - ca.j) ==
                std::int64_t{cc.i - ca.i} * (cb.j - ca.j) ||
            std::isnan(ca.z) || std::isnan(cb.z) || std::isnan(cc.z))
            return;
    }
    std::vector<std::uint16_t>& indices = partIndices_[static_cast<std::size_t>(part)];
    for (const Point& p : {a, b, c}) indices.push_back(vertex(p));
}

std::uint16_t TileMesher::vertex(const Point& p) {
    std::uint16_t& number = slots_[static_cast<std::size_t>(p.y * (side_ + 1) + p.x)];
    if (number != kNoSlot)
        return number;
    number = static_cast<std::uint16_t>(mesh_.vertices.size());
    const std::int32_t i = std::min(column(p), quadtree_.columns() - 1);
    const std::int32_t j = std::min(row(p), quadtree_.rows() - 1);
    const float source = samples_.height(i, j);
    const std::int32_t q = lattice_.quantise(source);
    const double drawn = q * lattice_.stepMetres;
    mesh_.vertices.push_back({p.x, p.y, q});
    mesh_.errorMetres = std::max(mesh_.errorMetres, std::abs(drawn - static_cast<double>(source)));
    mesh_.minHeightMetres = std::min(mesh_.minHeightMetres, drawn);
    mesh_.maxHeightMetres = std::max(mesh_.maxHeightMetres, drawn);
    return number;
}

}  // namespace eyrie::terrain
