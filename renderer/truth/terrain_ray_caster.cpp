// SPDX-License-Identifier: Apache-2.0
// Grid traversal through a pyramid of minimum and maximum heights: C. Dick, J. Krueger,
// R. Westermann, "GPU Ray-Casting for Scalable Terrain Rendering", 2009, here recursive, front to
// back, in double precision. The pyramid starts at blocks of cells, so that it stays small.
#include "renderer/truth/terrain_ray_caster.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace eyrie::truth {
namespace {

constexpr int kBlockCells = 8;
/// Slack, in parameter space relative to the hit, that closes the seams between cells.
constexpr double kSeam = 1e-12;

/// Part of a ray: parameters from `begin` to `end`; empty when they are in the wrong order.
struct Span {
    double begin;
    double end;
    bool isEmpty() const { return !(begin <= end); }
};

/// The part of `span` in which origin + t * direction lies between `low` and `high`.
Span clip(Span span, double origin, double direction, double low, double high) {
    if (direction == 0)
        return origin >= low && origin <= high ? span : Span{1, 0};
    double a = (low - origin) / direction;
    double b = (high - origin) / direction;
    if (a > b)
        std::swap(a, b);
    return {std::max(span.begin, a - kSeam * std::abs(a)),
            std::min(span.end, b + kSeam * std::abs(b))};
}

/// A cell's four posts, and a ray relative to its first: u along columns, v along rows, z height.
struct Cell {
    double h00, h10, h01, h11;

    double height(CellSurface surface, double u, double v) const {
        switch (surface) {
            case CellSurface::MainDiagonal:
                return u >= v ? h00 + u * (h10 - h00) + v * (h11 - h10)
                              : h00 + v * (h01 - h00) + u * (h11 - h01);
            case CellSurface::OtherDiagonal:
                return u + v <= 1 ? h00 + u * (h10 - h00) + v * (h01 - h00)
                                  : h11 + (1 - u) * (h01 - h11) + (1 - v) * (h10 - h11);
            case CellSurface::Bilinear:
                break;
        }
        return (h00 * (1 - u) + h10 * u) * (1 - v) + (h01 * (1 - u) + h11 * u) * v;
    }
};

struct LocalRay {
    double u, v, z, du, dv, dz;
};

double above(const Cell& cell, CellSurface surface, const LocalRay& ray, double t) {
    return ray.z + t * ray.dz - cell.height(surface, ray.u + t * ray.du, ray.v + t * ray.dv);
}

/// First zero in `span` of a height difference that is linear in it; `begin`, `end` are the
/// differences at its ends. NaN (no data) never hits.
double linearRoot(Span span, double begin, double end) {
    if (begin == 0)
        return span.begin;
    if (!(begin * end <= 0))
        return kNoHit;
    return span.begin + (span.end - span.begin) * (begin / (begin - end));
}

/// First hit with a cell of two triangles: the ray's span is cut where it crosses the diagonal,
/// and on each side the difference is linear.
double hitTriangles(const Cell& cell, CellSurface surface, const LocalRay& ray, Span span) {
    const bool main = surface == CellSurface::MainDiagonal;
    const double side = main ? ray.u - ray.v : ray.u + ray.v - 1;
    const double change = main ? ray.du - ray.dv : ray.du + ray.dv;
    const double crossing = change == 0 ? span.begin : -side / change;
    const double middle = std::clamp(crossing, span.begin, span.end);
    for (const Span part : {Span{span.begin, middle}, Span{middle, span.end}}) {
        const double inside = (part.begin + part.end) / 2;  // decides which triangle this part is
        const bool upper = side + inside * change >= 0;
        const auto plane = [&](double t) {
            const double u = ray.u + t * ray.du;
            const double v = ray.v + t * ray.dv;
            double h;
            if (main)
                h = upper ? cell.h00 + u * (cell.h10 - cell.h00) + v * (cell.h11 - cell.h10)
                          : cell.h00 + v * (cell.h01 - cell.h00) + u * (cell.h11 - cell.h01);
            else
                h = upper ? cell.h11 + (1 - u) * (cell.h01 - cell.h11) +
                                (1 - v) * (cell.h10 - cell.h11)
                          : cell.h00 + u * (cell.h10 - cell.h00) + v * (cell.h01 - cell.h00);
            return ray.z + t * ray.dz - h;
        };
        const double hit = linearRoot(part, plane(part.begin), plane(part.end));
        if (hit != kNoHit)
            return hit;
    }
    return kNoHit;
}

/// First hit with the bilinear patch: along a ray its height is a quadratic in t.
double hitBilinear(const Cell& cell, const LocalRay& ray, Span span) {
    const double f0 = above(cell, CellSurface::Bilinear, ray, span.begin);
    const double f1 = above(cell, CellSurface::Bilinear, ray, span.end);
    const double length = span.end - span.begin;
    // On s in [0, 1]: f(s) = f0 + (f1 - f0 - c) s + c s^2, with c from the patch's twist.
    const double twist = cell.h00 - cell.h10 - cell.h01 + cell.h11;
    const double c = -twist * ray.du * ray.dv * length * length;
    const double b = f1 - f0 - c;
    if (f0 == 0)
        return span.begin;
    if (c == 0)
        return linearRoot(span, f0, f1);
    const double discriminant = b * b - 4 * c * f0;
    if (!(discriminant >= 0))
        return kNoHit;
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    double first = kNoHit;
    for (const double s : {q / c, f0 / q})
        if (s >= 0 && s <= 1)
            first = std::min(first, span.begin + s * length);
    return first == kNoHit ? linearRoot(span, f0, f1) : first;  // a root lost at the very end
}

/// What (dx, dy) metres are in columns and rows.
fabric::Vec2 inCells(const HeightGrid& grid, double dx, double dy) {
    const fabric::Vec2& c = grid.perColumn;
    const fabric::Vec2& r = grid.perRow;
    const double determinant = c.x * r.y - r.x * c.y;
    return {(dx * r.y - dy * r.x) / determinant, (dy * c.x - dx * c.y) / determinant};
}

}  // namespace

struct TerrainRayCaster::Traversal {
    Ray ray;  ///< in grid space: post (i, j) is at x = i, y = j; z stays metres
    std::array<double, kCellSurfaces> hits{kNoHit, kNoHit, kNoHit};
    double through = kNoHit;  ///< where it first has gone through both diagonals of one cell

    double farthest() const {
        return std::max(through, *std::max_element(hits.begin(), hits.end()));
    }
    /// The part of the ray inside a box of cells and heights.
    Span within(double x0, double x1, double y0, double y1, double z0, double z1) const {
        Span span{0, farthest()};
        span = clip(span, ray.origin.x, ray.direction.x, x0, x1);
        span = clip(span, ray.origin.y, ray.direction.y, y0, y1);
        return clip(span, ray.origin.z, ray.direction.z, z0, z1);
    }
};

TerrainRayCaster::TerrainRayCaster(HeightGrid grid) : grid_(std::move(grid)) { buildLevels(); }

double TerrainRayCaster::post(int i, int j) const {
    return grid_.heights[static_cast<std::size_t>(j) * static_cast<std::size_t>(grid_.columns) +
                         static_cast<std::size_t>(i)];
}

TerrainRayCaster::Extent TerrainRayCaster::blockExtent(int column, int row) const {
    Extent extent{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
    const int lastRow = std::min((row + 1) * kBlockCells, grid_.rows - 1);
    const int lastColumn = std::min((column + 1) * kBlockCells, grid_.columns - 1);
    for (int j = row * kBlockCells; j <= lastRow; ++j)
        for (int i = column * kBlockCells; i <= lastColumn; ++i) {
            const auto height = static_cast<float>(post(i, j));
            if (std::isnan(height))
                continue;
            extent.min = std::min(extent.min, height);
            extent.max = std::max(extent.max, height);
        }
    return extent;
}

bool TerrainRayCaster::hasNodata(int column, int row) const {
    const int lastRow = std::min((row + 1) * kBlockCells, grid_.rows - 1);
    const int lastColumn = std::min((column + 1) * kBlockCells, grid_.columns - 1);
    for (int j = row * kBlockCells; j <= lastRow; ++j)
        for (int i = column * kBlockCells; i <= lastColumn; ++i)
            if (std::isnan(post(i, j)))
                return true;
    return false;
}

bool TerrainRayCaster::mayHaveEnd(int column, int row) const {
    const Level& blocks = levels_.front();
    for (int j = row - 1; j <= row + 1; ++j)
        for (int i = column - 1; i <= column + 1; ++i) {
            const bool isInside = i >= 0 && j >= 0 && i < blocks.columns && j < blocks.rows;
            if (!isInside || hasNodata_[blocks.index(i, j)] != 0)
                return true;
        }
    return false;
}

void TerrainRayCaster::buildLevels() {
    Level base{(grid_.columns - 2) / kBlockCells + 1, (grid_.rows - 2) / kBlockCells + 1, {}};
    for (int row = 0; row < base.rows; ++row)
        for (int column = 0; column < base.columns; ++column) {
            base.blocks.push_back(blockExtent(column, row));
            hasNodata_.push_back(hasNodata(column, row) ? 1 : 0);
        }
    levels_.push_back(std::move(base));
    while (levels_.back().columns > 1 || levels_.back().rows > 1) {
        const Level& fine = levels_.back();
        const Extent none{std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()};
        Level coarse{(fine.columns + 1) / 2, (fine.rows + 1) / 2, {}};
        coarse.blocks.assign(
            static_cast<std::size_t>(coarse.columns) * static_cast<std::size_t>(coarse.rows), none);
        for (int row = 0; row < fine.rows; ++row)
            for (int column = 0; column < fine.columns; ++column) {
                const Extent& part = fine.blocks[fine.index(column, row)];
                Extent& whole = coarse.blocks[coarse.index(column / 2, row / 2)];
                whole = {std::min(whole.min, part.min), std::max(whole.max, part.max)};
            }
        levels_.push_back(std::move(coarse));
    }
}

fabric::Vec2 TerrainRayCaster::toGrid(double x, double y) const {
    return inCells(grid_, x - grid_.origin.x, y - grid_.origin.y);
}

/// The direction without the origin, which would take ten digits of it.
Ray TerrainRayCaster::toGrid(const Ray& ray) const {
    const fabric::Vec2 origin = toGrid(ray.origin.x, ray.origin.y);
    const fabric::Vec2 direction = inCells(grid_, ray.direction.x, ray.direction.y);
    return {{origin.x, origin.y, ray.origin.z}, {direction.x, direction.y, ray.direction.z}};
}

TerrainRayCaster::Traversal TerrainRayCaster::cast(const Ray& ray) const {
    Traversal traversal{.ray = toGrid(ray)};
    visit(traversal, static_cast<int>(levels_.size()) - 1, 0, 0);
    return traversal;
}

std::array<double, kCellSurfaces> TerrainRayCaster::firstHits(const Ray& ray) const {
    return cast(ray).hits;
}

void TerrainRayCaster::visit(Traversal& traversal, int level, int column, int row) const {
    const Level& blocks = levels_[static_cast<std::size_t>(level)];
    if (column >= blocks.columns || row >= blocks.rows)
        return;
    const Extent& extent = blocks.blocks[blocks.index(column, row)];
    const double side = kBlockCells << level;
    if (extent.min > extent.max || traversal
                                       .within(column * side, (column + 1) * side, row * side,
                                               (row + 1) * side, extent.min, extent.max)
                                       .isEmpty())
        return;
    if (level == 0)
        return visitCells(traversal, column, row);
    const int nearColumn = traversal.ray.direction.x < 0 ? 1 : 0;
    const int nearRow = traversal.ray.direction.y < 0 ? 1 : 0;
    for (const int dr : {nearRow, 1 - nearRow})
        for (const int dc : {nearColumn, 1 - nearColumn})
            visit(traversal, level - 1, 2 * column + dc, 2 * row + dr);
}

void TerrainRayCaster::visitCells(Traversal& traversal, int column, int row) const {
    const int endRow = std::min((row + 1) * kBlockCells, grid_.rows - 1);
    const int endColumn = std::min((column + 1) * kBlockCells, grid_.columns - 1);
    for (int j = row * kBlockCells; j < endRow; ++j)
        for (int i = column * kBlockCells; i < endColumn; ++i) visitCell(traversal, i, j);
}

void TerrainRayCaster::visitCell(Traversal& traversal, int i, int j) const {
    const Ray& ray = traversal.ray;
    Span span{0, traversal.farthest()};
    span = clip(span, ray.origin.x, ray.direction.x, i, i + 1);
    span = clip(span, ray.origin.y, ray.direction.y, j, j + 1);
    if (span.isEmpty())
        return;
    const Cell cell{post(i, j), post(i + 1, j), post(i, j + 1), post(i + 1, j + 1)};
    const double low = std::fmin(std::fmin(cell.h00, cell.h10), std::fmin(cell.h01, cell.h11));
    const double high = std::fmax(std::fmax(cell.h00, cell.h10), std::fmax(cell.h01, cell.h11));
    span = clip(span, ray.origin.z, ray.direction.z, low, high);
    if (span.isEmpty())
        return;
    // Parameters count from the span's middle: far from the eye that saves digits.
    const double shift = (span.begin + span.end) / 2;
    const fabric::Vec3 p = ray.at(shift);
    const LocalRay local{p.x - i, p.y - j, p.z, ray.direction.x, ray.direction.y, ray.direction.z};
    const Span part{span.begin - shift, span.end - shift};
    const auto keep = [&](double& first, double hit) { first = std::min(first, hit + shift); };
    const double main = hitTriangles(cell, CellSurface::MainDiagonal, local, part);
    const double other = hitTriangles(cell, CellSurface::OtherDiagonal, local, part);
    keep(traversal.hits[static_cast<std::size_t>(CellSurface::MainDiagonal)], main);
    keep(traversal.hits[static_cast<std::size_t>(CellSurface::OtherDiagonal)], other);
    keep(traversal.hits[static_cast<std::size_t>(CellSurface::Bilinear)],
         hitBilinear(cell, local, part));
    keep(traversal.through, std::max(main, other));
}

std::array<double, kCellSurfaces> TerrainRayCaster::heightsAt(double x, double y) const {
    const fabric::Vec2 p = toGrid(x, y);
    if (!(p.x >= 0 && p.y >= 0 && p.x <= grid_.columns - 1 && p.y <= grid_.rows - 1)) {
        const double none = std::numeric_limits<double>::quiet_NaN();
        return {none, none, none};
    }
    const int i = std::min(static_cast<int>(p.x), grid_.columns - 2);
    const int j = std::min(static_cast<int>(p.y), grid_.rows - 2);
    const Cell cell{post(i, j), post(i + 1, j), post(i, j + 1), post(i + 1, j + 1)};
    const auto height = [&](CellSurface surface) { return cell.height(surface, p.x - i, p.y - j); };
    return {height(CellSurface::MainDiagonal), height(CellSurface::OtherDiagonal),
            height(CellSurface::Bilinear)};
}

ReferenceSurface::HitRange TerrainRayCaster::hitRange(const Ray& ray) const {
    const Traversal hit = cast(ray);
    return {*std::min_element(hit.hits.begin(), hit.hits.end()), hit.farthest()};
}

bool TerrainRayCaster::isEnd(int i, int j) const {
    const auto isData = [&](int column, int row) {
        return column >= 0 && row >= 0 && column < grid_.columns && row < grid_.rows &&
               !std::isnan(post(column, row));
    };
    if (!isData(i, j))
        return false;
    for (int row = j - 1; row <= j + 1; ++row)
        for (int column = i - 1; column <= i + 1; ++column)
            if (!isData(column, row))
                return true;
    return false;
}

bool TerrainRayCaster::endsWithin(const fabric::Vec3& point, double reach,
                                  const std::function<bool(const fabric::Vec3&)>& isThere) const {
    const fabric::Vec2 centre = toGrid(point.x, point.y);
    const fabric::Vec2 posts(reach / glm::length(grid_.perColumn),
                             reach / glm::length(grid_.perRow));
    struct Stretch {
        int first, last;
    };
    const auto within = [](double middle, double half, int count) {
        return Stretch{
            static_cast<int>(std::clamp<double>(std::ceil(middle - half), 0, count)),
            static_cast<int>(std::clamp<double>(std::floor(middle + half), -1, count - 1))};
    };
    const Stretch columns = within(centre.x, posts.x, grid_.columns);
    const Stretch rows = within(centre.y, posts.y, grid_.rows);
    const auto isEndThere = [&](int i, int j) {
        if (!isEnd(i, j))
            return false;
        const fabric::Vec2 place = grid_.origin + static_cast<double>(i) * grid_.perColumn +
                                   static_cast<double>(j) * grid_.perRow;
        return isThere({place.x, place.y, post(i, j)});
    };
    const Level& blocks = levels_.front();
    const auto blockOf = [](int post, int count) {
        return std::min(post / kBlockCells, count - 1);
    };
    for (int j = rows.first; j <= rows.last; ++j)
        for (int i = columns.first; i <= columns.last;) {
            const int column = blockOf(i, blocks.columns);
            const int end =
                column + 1 == blocks.columns ? grid_.columns : (column + 1) * kBlockCells;
            if (mayHaveEnd(column, blockOf(j, blocks.rows)))
                for (; i < end && i <= columns.last; ++i)
                    if (isEndThere(i, j))
                        return true;
            i = end;
        }
    return false;
}

std::optional<fabric::Vec3> TerrainRayCaster::counterpart(const fabric::Vec3& point) const {
    std::optional<fabric::Vec3> best;
    for (const double height : heightsAt(point.x, point.y))
        if (!std::isnan(height) &&
            (!best || std::abs(height - point.z) < std::abs(best->z - point.z)))
            best = fabric::Vec3(point.x, point.y, height);
    return best;
}

}  // namespace eyrie::truth
