// SPDX-License-Identifier: Apache-2.0
// W. Evans, D. Kirkpatrick, G. Townsend, "Right-Triangulated Irregular Networks", 2001; R.
// Pajarola, "Large Scale Terrain Visualization Using the Restricted Quadtree Triangulation", 1998.
// Departs from both in the error: theirs is the midpoint's alone, which understates what a triangle
// leaves out by up to 1.8 times on real terrain; here each triangle is measured in full.
#include "renderer/terrain/vertex_levels.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "fabric/status.h"
#include "renderer/terrain/finest_row.h"
#include "renderer/terrain/quadtree.h"
#include "renderer/terrain/tile_progress.h"

namespace eyrie::terrain {

VertexLevels::VertexLevels(const ElevationModel& model, Scratch& scratch)
    : model_(model),
      scratch_(scratch),
      columns_(model.frame.columns),
      rows_(model.frame.rows),
      side_(Quadtree::side(
          Quadtree(static_cast<std::uint32_t>(columns_), static_cast<std::uint32_t>(rows_))
              .top()
              .level)),
      coveredI_(model.heights.tilesX() * kRasterTileCells),
      coveredJ_(model.heights.tilesY() * kRasterTileCells),
      coarseColumns_(coveredI_ / kCoarseSpacing + 1),
      measured_(scratch, coveredI_ + 1, coveredJ_ + 1),
      coarse_(static_cast<std::size_t>(coarseColumns_) *
              static_cast<std::size_t>(coveredJ_ / kCoarseSpacing + 1)) {
    for (int layer = 0; layer < kLayers; ++layer)
        joined_[static_cast<std::size_t>(layer)] =
            TiledRaster<std::uint8_t>(scratch, (coveredI_ >> layer) + 1, (coveredJ_ >> layer) + 1);
}

void VertexLevels::setThresholds(std::vector<double> metres) {
    thresholds_ = std::move(metres);
    floatThresholds_.assign(thresholds_.begin(), thresholds_.end());
    constexpr double kFloatRounding = 1.0 / (1 << 20);
    const double rounding = kFloatRounding * model_.statistics.highestMagnitude();
    greatestDeviations_.clear();
    for (const double threshold : thresholds_)
        greatestDeviations_.push_back(threshold * (1 + kFloatRounding) + rounding);
    greatestDeviations_.push_back(std::numeric_limits<double>::infinity());
}

int VertexLevels::thresholdsExceededBy(double deviationMetres) const {
    int count = 0;
    for (const double threshold : thresholds_) {
        if (!(deviationMetres > threshold))
            break;
        ++count;
    }
    return count;
}

/// Thresholds exceeded by the triangle p, apex, q of the padded square; not below `known`.
int VertexLevels::exceededByTriangle(SourceSurface& surface, const Point& p, const Point& apex,
                                     const Point& q, int known) const {
    if (known == static_cast<int>(thresholds_.size()))
        return known;
    const DeviationGoal goal{thresholds_[static_cast<std::size_t>(known)], thresholds_};
    const auto corner = [&](const Point& at) {
        const std::int32_t i = std::min(at.i, columns_ - 1);
        const std::int32_t j = std::min(at.j, rows_ - 1);
        return Corner{i, j, static_cast<double>(surface.heightAt(i, j))};
    };
    const Triangle triangle = {corner(apex), corner(p), corner(q)};
    const auto isInside = [&](const Point& at) { return at.i < columns_ && at.j < rows_; };
    double deviation = goal.floor;
    if (isInside(p) && isInside(apex) && isInside(q)) {
        deviation = surface.ofAligned(triangle, goal);
    } else {
        const auto pastColumns = [&](const Corner& c) { return c.i == columns_ - 1; };
        const auto pastRows = [&](const Corner& c) { return c.j == rows_ - 1; };
        const bool isSqueezed = std::all_of(triangle.begin(), triangle.end(), pastColumns) ||
                                std::all_of(triangle.begin(), triangle.end(), pastRows);
        if (!isSqueezed)
            deviation = surface.ofGeneral(triangle, goal);
    }
    return deviation > goal.floor ? thresholdsExceededBy(deviation) : known;
}

/// Thresholds exceeded by the two triangles that vertex (i, j) of spacing s splits, of which one
/// may lie outside of the square.
int VertexLevels::exceededBySplit(SourceSurface& surface, std::int32_t i, std::int32_t j,
                                  std::int32_t s, bool isCentre, int known) const {
    const auto measured = [&](const Point& p, const Point& apex, const Point& q) {
        if (apex.i >= 0 && apex.j >= 0 && apex.i <= side_ && apex.j <= side_)
            known = exceededByTriangle(surface, p, apex, q, known);
    };
    if (isCentre) {
        // Of a square of side 2s the diagonal that meets the centre of the square around it.
        const std::int32_t d = (((i - s) ^ (j - s)) & (2 * s)) == 0 ? s : -s;
        measured({i - d, j - s}, {i + d, j - s}, {i + d, j + s});
        measured({i + d, j + s}, {i - d, j + s}, {i - d, j - s});
        return known;
    }
    const bool isHorizontal = (i & s) != 0;
    const std::int32_t dx = isHorizontal ? s : 0;
    const std::int32_t dy = isHorizontal ? 0 : s;
    measured({i - dx, j - dy}, {i + dy, j - dx}, {i + dx, j + dy});
    measured({i + dx, j + dy}, {i - dy, j + dx}, {i - dx, j - dy});
    return known;
}

/// One tile's vertices, from what lies in the tile alone.
class VertexLevels::TileMeasure {
public:
    TileMeasure(const VertexLevels& levels, std::int32_t x, std::int32_t y)
        : levels_(levels),
          surface_(levels.model_),
          heights_(levels.model_.heights.tile(x, y)),
          i0_(x * kRasterTileCells),
          j0_(y * kRasterTileCells),
          limitI_(std::min(kRasterTileCells, levels.columns_ - 1 - i0_)),
          limitJ_(std::min(kRasterTileCells, levels.rows_ - 1 - j0_)),
          isWhole_(!surface_.hasNodata() && limitI_ == kRasterTileCells &&
                   limitJ_ == kRasterTileCells),
          rounding_(levels.model_.statistics.highestMagnitude() * kDeviationRounding),
          counts_(TiledRaster<std::uint8_t>::newTile()) {
        std::memset(counts_.get(), 0, kRasterTileValues);
    }

    std::shared_ptr<std::uint8_t[]> run() {
        measureFinest();
        for (std::int32_t s = 1; s < kRasterTileCells; s *= 2) {
            if (s > 1)
                measureEdges(s);
            if (s == 1 && isWhole_)
                measureFinestCentres();
            else
                measureCentres(s);
        }
        return std::move(counts_);
    }

private:
    std::uint8_t& at(std::int32_t u, std::int32_t v) {
        return counts_[static_cast<std::size_t>(v * kRasterTilePosts + u)];
    }
    std::int32_t end(std::int32_t limit, std::int32_t s) const {
        return std::min(limit + s, kRasterTilePosts);
    }

    void measureFinest() {
        std::array<std::uint8_t, kRasterTilePosts> row{};
        const auto tolerance = static_cast<float>(surface_.postToleranceMetres());
        for (std::int32_t v = 0; v < end(limitJ_, 1); ++v) {
            const bool isInner = v > 0 && v < limitJ_ && limitI_ > 1;
            const float* here = heights_.get() + v * kRasterTilePosts;
            if (isInner)
                finestRow(here - kRasterTilePosts, here, here + kRasterTilePosts, limitI_ + 1,
                          (v & 1) == 0, tolerance, levels_.floatThresholds_, row.data());
            for (std::int32_t u = (v & 1) == 0 ? 1 : 0; u < end(limitI_, 1); u += 2) {
                const std::uint8_t found = row[static_cast<std::size_t>(u)];
                if (isInner && u > 0 && u < limitI_ && found != kFinestRowNodata)
                    at(u, v) = found;
                else
                    measureVertex(u, v, 1, false);
            }
        }
    }

    /// The centres of squares of two cells, a quarter of all vertices.
    void measureFinestCentres() {
        for (std::int32_t v = 1; v < kRasterTileCells; v += 2)
            for (std::int32_t u = 1; u < kRasterTileCells; u += 2) {
                const auto [deviation, greatest] =
                    finestCentre(heights_.get() + v * kRasterTilePosts + u, kRasterTilePosts,
                                 ((u ^ v) & 2) == 0, surface_.postToleranceMetres());
                const int own = levels_.thresholdsExceededBy(deviation);
                at(u, v) = static_cast<std::uint8_t>(std::max(own, children(u, v, 1, true)));
                reach(u, v) = roundedUp(greatest);
            }
    }

    void measureEdges(std::int32_t s) {
        for (std::int32_t v = 0; v < end(limitJ_, s); v += s)
            for (std::int32_t u = (v & s) == 0 ? s : 0; u < end(limitI_, s); u += 2 * s)
                isWhole_ ? measureInside(u, v, s, false) : measureVertex(u, v, s, false);
    }

    void measureCentres(std::int32_t s) {
        for (std::int32_t v = s; v < end(limitJ_, s); v += 2 * s)
            for (std::int32_t u = s; u < end(limitI_, s); u += 2 * s)
                isWhole_ ? measureInside(u, v, s, true) : measureVertex(u, v, s, true);
    }

    void measureVertex(std::int32_t u, std::int32_t v, std::int32_t s, bool isCentre);
    void measureInside(std::int32_t u, std::int32_t v, std::int32_t s, bool isCentre);
    float& reach(std::int32_t u, std::int32_t v) {
        return reaches_[static_cast<std::size_t>(v * kRasterTilePosts + u)];
    }
    Corner corner(Point p) const {
        return {
            i0_ + p.i, j0_ + p.j,
            static_cast<double>(heights_[static_cast<std::size_t>(p.j * kRasterTilePosts + p.i)])};
    }
    static float roundedUp(double metres) {
        return static_cast<float>(metres * (1 + 1.0 / (1 << 22)));
    }
    int children(std::int32_t u, std::int32_t v, std::int32_t s, bool isCentre) const {
        const auto get = [&](std::int32_t x, std::int32_t y) -> int {
            const bool isHere = x >= 0 && y >= 0 && x <= kRasterTileCells && y <= kRasterTileCells;
            return isHere ? counts_[static_cast<std::size_t>(y * kRasterTilePosts + x)] : 0;
        };
        if (isCentre)
            return std::max({get(u - s, v), get(u + s, v), get(u, v - s), get(u, v + s)});
        const std::int32_t h = s / 2;
        return h == 0 ? 0
                      : std::max({get(u - h, v - h), get(u + h, v - h), get(u - h, v + h),
                                  get(u + h, v + h)});
    }

    const VertexLevels& levels_;
    SourceSurface surface_;
    TiledRaster<float>::Tile heights_;
    std::int32_t i0_;
    std::int32_t j0_;
    std::int32_t limitI_;  ///< last post of the grid, in the tile's own counting
    std::int32_t limitJ_;
    bool isWhole_;  ///< all posts are of the grid, and data
    double rounding_;
    std::shared_ptr<std::uint8_t[]> counts_;
    /// Of whole tiles, by vertices from spacing 1's centres on: what its triangles in the tile
    /// deviate from the source at most, at posts and at edges, in metres.
    std::array<float, kRasterTileValues> reaches_;
};

void VertexLevels::TileMeasure::measureVertex(std::int32_t u, std::int32_t v, std::int32_t s,
                                              bool isCentre) {
    int known = children(u, v, s, isCentre);
    const auto measured = [&](std::int32_t pu, std::int32_t pv, std::int32_t au, std::int32_t av,
                              std::int32_t qu, std::int32_t qv) {
        if (au < 0 || av < 0 || au > kRasterTileCells || av > kRasterTileCells)
            return;
        known = levels_.exceededByTriangle(surface_, {i0_ + pu, j0_ + pv}, {i0_ + au, j0_ + av},
                                           {i0_ + qu, j0_ + qv}, known);
    };
    if (isCentre) {
        const std::int32_t d = (((i0_ + u - s) ^ (j0_ + v - s)) & (2 * s)) == 0 ? s : -s;
        measured(u - d, v - s, u + d, v - s, u + d, v + s);
        measured(u + d, v + s, u - d, v + s, u - d, v - s);
    } else {
        const std::int32_t dx = (u & s) != 0 ? s : 0;
        const std::int32_t dy = s - dx;
        measured(u - dx, v - dy, u + dy, v - dx, u + dx, v + dy);
        measured(u + dx, v + dy, u - dy, v + dx, u - dx, v - dy);
    }
    at(u, v) = static_cast<std::uint8_t>(known);
}

/// Of a whole tile. Where a triangle is split its drawing moves by the middle's own distance at
/// most, so it deviates by no more than that and what its halves deviate: often that is below the
/// next threshold, and the triangle need not be looked at.
void VertexLevels::TileMeasure::measureInside(std::int32_t u, std::int32_t v, std::int32_t s,
                                              bool isCentre) {
    const bool isMain = (((i0_ + u - s) ^ (j0_ + v - s)) & (2 * s)) == 0;
    const bool isHorizontal = (u & s) != 0;
    const std::int32_t dx = isCentre ? (isMain ? s : -s) : (isHorizontal ? s : 0);
    const std::int32_t dy = isCentre || !isHorizontal ? s : 0;
    const Point p{u - dx, v - dy};
    const Point q{u + dx, v + dy};
    const std::array<Point, 2> apexes = {{{u + dy, v - dx}, {u - dy, v + dx}}};
    const Corner left = corner(p);
    const Corner right = corner(q);
    const double moved = std::abs(corner({u, v}).z - (left.z + right.z) / 2);
    const auto all = static_cast<int>(levels_.thresholds_.size());
    int known = std::max(children(u, v, s, isCentre), levels_.thresholdsExceededBy(moved));
    double greatest = moved;
    for (const Point& apex : apexes) {
        if (apex.i < 0 || apex.j < 0 || apex.i > kRasterTileCells || apex.j > kRasterTileCells)
            continue;
        double bound =
            moved + static_cast<double>(std::max(reach((apex.i + p.i) / 2, (apex.j + p.j) / 2),
                                                 reach((apex.i + q.i) / 2, (apex.j + q.j) / 2)));
        const double floor =
            known < all ? levels_.thresholds_[static_cast<std::size_t>(known)] : bound;
        if (known < all && bound + rounding_ > floor) {
            const auto found = surface_.inside({corner(apex), left, right}, floor);
            bound = found.greatest;
            if (found.deviation > floor)
                known = levels_.thresholdsExceededBy(found.deviation);
        }
        greatest = std::max(greatest, bound);
    }
    at(u, v) = static_cast<std::uint8_t>(known);
    reach(u, v) = roundedUp(greatest);
}

absl::Status VertexLevels::measure(const import::ImportControl& control) {
    return forEachTile(measured_.tilesX(), measured_.tilesY(), "measuring", scratch_, control,
                       [&](std::int32_t x, std::int32_t y) {
                           measured_.write(x, y, TileMeasure(*this, x, y).run());
                       });
}

/// A square of 8 x 8 tiles: the vertices up to a spacing of 16, with their children across
/// borders. A vertex of spacing s depends on others within 2s + s / 2 of it at most.
class VertexLevels::GroupJoin {
public:
    static constexpr std::int32_t kTiles = 8;
    static constexpr std::int32_t kCells = kTiles * kRasterTileCells;
    static constexpr std::int32_t kHalo = 2 * kCoarseSpacing;

    GroupJoin(VertexLevels& levels, std::int32_t x, std::int32_t y)
        : levels_(levels), x_(x), y_(y) {
        const std::int32_t i1 = std::min(x * kCells + kCells + kHalo, levels.coveredI_);
        const std::int32_t j1 = std::min(y * kCells + kCells + kHalo, levels.coveredJ_);
        rect_.i = std::max(0, x * kCells - kHalo);
        rect_.j = std::max(0, y * kCells - kHalo);
        rect_.columns = i1 - rect_.i + 1;
        rect_.rows = j1 - rect_.j + 1;
        counts_.resize(static_cast<std::size_t>(rect_.columns) *
                       static_cast<std::size_t>(rect_.rows));
    }

    void run() {
        load();
        for (std::int32_t s = 1; s <= kCoarseSpacing; s *= 2) {
            if (s > 1)
                raiseEdges(s);
            if (s < kCoarseSpacing)
                raiseCentres(s);
        }
        for (int layer = 0; layer < kLayers; ++layer) store(layer);
        storeCoarse();
    }

private:
    std::uint8_t* row(std::int32_t v) {
        return counts_.data() +
               static_cast<std::ptrdiff_t>(v) * static_cast<std::ptrdiff_t>(rect_.columns);
    }
    std::int32_t endOf(std::int32_t posts, std::int32_t first, std::int32_t size,
                       std::int32_t s) const {
        return std::min(size, posts - 1 + s - first);
    }

    void load() {
        levels_.measured_.forEachPart(rect_, [&](const std::uint8_t* values, const PostRect& part) {
            for (std::int32_t j = 0; j < part.rows; ++j) {
                std::uint8_t* out = row(part.j - rect_.j + j) + (part.i - rect_.i);
                const std::uint8_t* in = values + j * kRasterTilePosts;
                for (std::int32_t k = 0; k < part.columns; ++k) out[k] = std::max(out[k], in[k]);
            }
        });
    }

    /// Vertices at the group's own edge lack children; they lie in the halo.
    void raiseCentres(std::int32_t s) {
        const std::int32_t endU = endOf(levels_.columns_, rect_.i, rect_.columns - s, s);
        const std::int32_t endV = endOf(levels_.rows_, rect_.j, rect_.rows - s, s);
        for (std::int32_t v = s; v < endV; v += 2 * s) {
            std::uint8_t* here = row(v);
            const std::uint8_t* below = row(v - s);
            const std::uint8_t* above = row(v + s);
            for (std::int32_t u = s; u < endU; u += 2 * s)
                here[u] = std::max({here[u], here[u - s], here[u + s], below[u], above[u]});
        }
    }

    void raiseEdges(std::int32_t s) {
        const std::int32_t h = s / 2;
        const std::int32_t endU = endOf(levels_.columns_, rect_.i, rect_.columns, s);
        const std::int32_t endV = endOf(levels_.rows_, rect_.j, rect_.rows, s);
        for (std::int32_t v = 0; v < endV; v += s) {
            std::uint8_t* here = row(v);
            const std::uint8_t* below = v >= h ? row(v - h) : nullptr;
            const std::uint8_t* above = v + h < rect_.rows ? row(v + h) : nullptr;
            for (std::int32_t u = (v & s) == 0 ? s : 0; u < endU; u += 2 * s)
                for (const std::uint8_t* other : {below, above}) {
                    if (other != nullptr && u >= h)
                        here[u] = std::max(here[u], other[u - h]);
                    if (other != nullptr && u + h < rect_.columns)
                        here[u] = std::max(here[u], other[u + h]);
                }
        }
    }

    void store(int layer) {
        TiledRaster<std::uint8_t>& raster = levels_.joined_[static_cast<std::size_t>(layer)];
        const std::int32_t tiles = kTiles >> layer;
        for (std::int32_t y = y_ * tiles; y < std::min((y_ + 1) * tiles, raster.tilesY()); ++y)
            for (std::int32_t x = x_ * tiles; x < std::min((x_ + 1) * tiles, raster.tilesX()); ++x)
                raster.write(x, y, thinned(layer, x, y));
    }

    std::shared_ptr<std::uint8_t[]> thinned(int layer, std::int32_t x, std::int32_t y) {
        auto tile = TiledRaster<std::uint8_t>::newTile();
        for (std::int32_t v = 0; v < kRasterTilePosts; ++v)
            for (std::int32_t u = 0; u < kRasterTilePosts; ++u) {
                const std::int32_t i = ((x * kRasterTileCells + u) << layer) - rect_.i;
                const std::int32_t j = ((y * kRasterTileCells + v) << layer) - rect_.j;
                tile[static_cast<std::size_t>(v * kRasterTilePosts + u)] =
                    i < rect_.columns && j < rect_.rows ? row(j)[i] : std::uint8_t{0};
            }
        return tile;
    }

    void storeCoarse() {
        const std::int32_t endI = std::min(x_ * kCells + kCells, levels_.coveredI_ + 1);
        const std::int32_t endJ = std::min(y_ * kCells + kCells, levels_.coveredJ_ + 1);
        // The last column and row of the tiles begin no group of their own.
        const std::int32_t lastI = endI == levels_.coveredI_ ? endI + 1 : endI;
        const std::int32_t lastJ = endJ == levels_.coveredJ_ ? endJ + 1 : endJ;
        for (std::int32_t j = y_ * kCells; j < lastJ; j += kCoarseSpacing)
            for (std::int32_t i = x_ * kCells; i < lastI; i += kCoarseSpacing)
                levels_.coarse_[levels_.coarseIndex(i, j)] = row(j - rect_.j)[i - rect_.i];
    }

    VertexLevels& levels_;
    std::int32_t x_;
    std::int32_t y_;
    PostRect rect_;
    std::vector<std::uint8_t> counts_;
};

absl::Status VertexLevels::join(const import::ImportControl& control) {
    const auto over = [](std::int32_t tiles) {
        return (tiles + GroupJoin::kTiles - 1) / GroupJoin::kTiles;
    };
    return forEachTile(over(measured_.tilesX()), over(measured_.tilesY()), "joining", scratch_,
                       control,
                       [&](std::int32_t x, std::int32_t y) { GroupJoin(*this, x, y).run(); });
}

int VertexLevels::exceeded(std::int32_t i, std::int32_t j) const {
    if (i < 0 || j < 0 || i > side_ || j > side_)
        return 0;
    if (isCovered(i, j)) [[likely]]
        return coarse_[coarseIndex(i, j)];
    const auto found = outside_.find(key(i, j));
    return found == outside_.end() ? 0 : found->second;
}

/// Thresholds exceeded by the vertices that split the halves of (i, j)'s triangles.
int VertexLevels::exceededByChildren(std::int32_t i, std::int32_t j, std::int32_t s,
                                     bool isCentre) const {
    if (isCentre)
        return std::max(
            {exceeded(i - s, j), exceeded(i + s, j), exceeded(i, j - s), exceeded(i, j + s)});
    const std::int32_t h = s / 2;
    return h < kCoarseSpacing ? 0
                              : std::max({exceeded(i - h, j - h), exceeded(i + h, j - h),
                                          exceeded(i - h, j + h), exceeded(i + h, j + h)});
}

/// All vertices of one spacing: midpoints of the sides of squares of side 2s, or their centres.
void VertexLevels::finishClass(std::int32_t s, bool isCentre) {
    const std::int32_t first = isCentre ? s : 0;
    const std::int32_t step = isCentre ? 2 * s : s;
    const std::int32_t end = std::min(rows_ - 1 + s, side_ + 1);
    const std::int32_t count = (end - first + step - 1) / step;
    const bool isMeasured = 2 * s <= kRasterTileCells;
    tbb::enumerable_thread_specific<std::vector<Found>> outside;
    tbb::parallel_for(
        tbb::blocked_range<std::int32_t>(0, std::max(count, 0)), [&](const auto& range) {
            SourceSurface surface(model_);
            for (std::int32_t k = range.begin(); k < range.end(); ++k) {
                const std::int32_t j = first + k * step;
                const std::int32_t endI = std::min(columns_ - 1 + s, side_ + 1);
                for (std::int32_t i = isCentre || (j & s) == 0 ? s : 0; i < endI; i += 2 * s) {
                    int known = std::max(exceeded(i, j), exceededByChildren(i, j, s, isCentre));
                    if (!isMeasured)
                        known = exceededBySplit(surface, i, j, s, isCentre, known);
                    if (isCovered(i, j))
                        coarse_[coarseIndex(i, j)] = static_cast<std::uint8_t>(known);
                    else if (known > 0)
                        outside.local().push_back({key(i, j), static_cast<std::uint64_t>(known)});
                }
            }
        });
    for (const std::vector<Found>& found : outside)
        for (const Found& vertex : found)
            outside_[vertex.key] = static_cast<std::uint8_t>(vertex.exceeded);
}

absl::Status VertexLevels::finish(const import::ImportControl& control) {
    for (std::int32_t s = kCoarseSpacing; s < side_; s *= 2)
        for (const bool isCentre : {false, true}) {
            RETURN_IF_ERROR(control.check());
            finishClass(s, isCentre);
            RETURN_IF_ERROR(scratch_.status());
        }
    return absl::OkStatus();
}

std::vector<std::byte> VertexLevels::state() const {
    std::vector<Found> outside;
    for (const auto& [key, exceeded] : outside_) outside.push_back({key, exceeded});
    const auto coarse = std::as_bytes(std::span(coarse_));
    const auto rest = std::as_bytes(std::span(outside));
    std::vector<std::byte> state(coarse.begin(), coarse.end());
    state.insert(state.end(), rest.begin(), rest.end());
    return state;
}

bool VertexLevels::restore(std::span<const std::byte> state) {
    if (state.size() < coarse_.size() || (state.size() - coarse_.size()) % sizeof(Found) != 0)
        return false;
    std::memcpy(coarse_.data(), state.data(), coarse_.size());
    for (state = state.subspan(coarse_.size()); !state.empty();
         state = state.subspan(sizeof(Found))) {
        Found found;
        std::memcpy(&found, state.data(), sizeof found);
        outside_[found.key] = static_cast<std::uint8_t>(found.exceeded);
    }
    return true;
}

void VertexLevels::read(int layer, const PostRect& rect, std::uint8_t* out) const {
    const auto at = [&](std::int32_t i, std::int32_t j) -> std::uint8_t& {
        return out[static_cast<std::ptrdiff_t>(j - rect.j) * rect.columns + (i - rect.i)];
    };
    std::memset(out, 0,
                static_cast<std::size_t>(rect.columns) * static_cast<std::size_t>(rect.rows));
    if (layer < kLayers) {
        const TiledRaster<std::uint8_t>& raster = joined_[static_cast<std::size_t>(layer)];
        const PostRect inner{rect.i, rect.j, std::min(rect.columns, raster.columns() - rect.i),
                             std::min(rect.rows, raster.rows() - rect.j)};
        raster.forEachPart(inner, [&](const std::uint8_t* values, const PostRect& part) {
            for (std::int32_t v = 0; v < part.rows; ++v)
                std::copy_n(values + v * kRasterTilePosts, part.columns, &at(part.i, part.j + v));
        });
    }
    const std::int32_t step = layer < kLayers ? kCoarseSpacing >> layer : 1;
    const auto up = [&](std::int32_t first) { return (first + step - 1) / step * step; };
    for (std::int32_t j = up(rect.j); j < rect.j + rect.rows; j += step)
        for (std::int32_t i = up(rect.i); i < rect.i + rect.columns; i += step)
            at(i, j) = static_cast<std::uint8_t>(exceeded(i << layer, j << layer));
}

}  // namespace eyrie::terrain
