// SPDX-License-Identifier: Apache-2.0
// The first step: each tile by itself.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "renderer/terrain/finest_row.h"
#include "renderer/terrain/tile_progress.h"
#include "renderer/terrain/vertex_levels.h"

namespace eyrie::terrain {

/// One tile's vertices, from what lies in the tile alone.
class VertexLevels::TileMeasure {
public:
    TileMeasure(const VertexLevels& levels, std::int32_t x, std::int32_t y)
        : levels_(levels),
          scale_(levels.scale_),
          surface_(levels.model_),
          heights_(levels.model_.heights.tile(x, y)),
          i0_(x * kRasterTileCells),
          j0_(y * kRasterTileCells),
          limitI_(std::min(kRasterTileCells, levels.columns_ - 1 - i0_)),
          limitJ_(std::min(kRasterTileCells, levels.rows_ - 1 - j0_)),
          hasNodata_(surface_.hasNodata()),
          rounding_(levels.model_.statistics.highestMagnitude() * kDeviationRounding),
          codes_(TiledRaster<std::uint8_t>::newTile()) {
        std::memset(codes_.get(), 0, kRasterTileValues);
    }

    std::shared_ptr<std::uint8_t[]> run() {
        measureFinestEdges();
        measureFinestCentres();
        for (std::int32_t s = 2; s < kRasterTileCells; s *= 2) {
            measureEdges(s);
            measureCentres(s);
        }
        return std::move(codes_);
    }

private:
    std::uint8_t& at(std::int32_t u, std::int32_t v) {
        return codes_[static_cast<std::size_t>(v * kRasterTilePosts + u)];
    }
    std::int32_t end(std::int32_t limit, std::int32_t s) const {
        return std::min(limit + s, kRasterTilePosts);
    }

    void measureFinestEdges() {
        std::array<std::uint8_t, kRasterTilePosts> row{};
        const auto tolerance = static_cast<float>(surface_.postToleranceMetres());
        for (std::int32_t v = 0; v < end(limitJ_, 1); ++v) {
            const bool isInner = v > 0 && v < limitJ_ && limitI_ > 1;
            const float* here = heights_.get() + v * kRasterTilePosts;
            if (isInner)
                finestRow(here - kRasterTilePosts, here, here + kRasterTilePosts, limitI_ + 1,
                          (v & 1) == 0, tolerance, levels_.scale_, row.data());
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
        for (std::int32_t v = 1; v < end(limitJ_, 1); v += 2)
            for (std::int32_t u = 1; u < end(limitI_, 1); u += 2) {
                if (!isInside(u, v, 1)) {
                    measureVertex(u, v, 1, true);
                    continue;
                }
                const auto [deviation, greatest] =
                    finestCentre(heights_.get() + v * kRasterTilePosts + u, kRasterTilePosts,
                                 ((u ^ v) & 2) == 0, surface_.postToleranceMetres());
                const int exceeded =
                    scale_.exceededBy(deviation, exceededByChildren(u, v, 1, true));
                at(u, v) = scale_.code(exceeded, deviation);
                reach(u, v) = roundedUp(greatest);
            }
    }

    void measureEdges(std::int32_t s) {
        for (std::int32_t v = 0; v < end(limitJ_, s); v += s)
            for (std::int32_t u = (v & s) == 0 ? s : 0; u < end(limitI_, s); u += 2 * s)
                measure(u, v, s, false);
    }

    void measureCentres(std::int32_t s) {
        for (std::int32_t v = s; v < end(limitJ_, s); v += 2 * s)
            for (std::int32_t u = s; u < end(limitI_, s); u += 2 * s) measure(u, v, s, true);
    }

    void measure(std::int32_t u, std::int32_t v, std::int32_t s, bool isCentre) {
        if (isInside(u, v, s))
            measureInside(u, v, s, isCentre);
        else
            measureVertex(u, v, s, isCentre);
    }
    /// Whether what lies in the tile of a vertex's triangles is grid and data.
    bool isInside(std::int32_t u, std::int32_t v, std::int32_t s) const {
        return !hasNodata_ && std::min(u + s, kRasterTileCells) <= limitI_ &&
               std::min(v + s, kRasterTileCells) <= limitJ_;
    }
    void measureVertex(std::int32_t u, std::int32_t v, std::int32_t s, bool isCentre);
    void measureInside(std::int32_t u, std::int32_t v, std::int32_t s, bool isCentre);
    SourceSurface::Inside reachOf(const Triangle& triangle, double boundMetres, int known);
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
    int exceededByChildren(std::int32_t u, std::int32_t v, std::int32_t s, bool isCentre) const {
        const auto get = [&](std::int32_t x, std::int32_t y) -> int {
            const bool isHere = x >= 0 && y >= 0 && x <= kRasterTileCells && y <= kRasterTileCells;
            return isHere ? DeviationScale::exceeded(
                                codes_[static_cast<std::size_t>(y * kRasterTilePosts + x)])
                          : 0;
        };
        if (isCentre)
            return std::max({get(u - s, v), get(u + s, v), get(u, v - s), get(u, v + s)});
        const std::int32_t h = s / 2;
        return h == 0 ? 0
                      : std::max({get(u - h, v - h), get(u + h, v - h), get(u - h, v + h),
                                  get(u + h, v + h)});
    }

    const VertexLevels& levels_;
    const DeviationScale& scale_;
    SourceSurface surface_;
    TiledRaster<float>::Tile heights_;
    std::int32_t i0_;
    std::int32_t j0_;
    std::int32_t limitI_;  ///< last post of the grid, in the tile's own counting
    std::int32_t limitJ_;
    bool hasNodata_;  ///< somewhere in the model
    double rounding_;
    std::shared_ptr<std::uint8_t[]> codes_;
    /// By vertices from spacing 1's centres on: what the triangles that it splits in the tile
    /// deviate from the source at most, at posts and at edges, in metres.
    std::array<float, kRasterTileValues> reaches_;
};

void VertexLevels::TileMeasure::measureVertex(std::int32_t u, std::int32_t v, std::int32_t s,
                                              bool isCentre) {
    int known = exceededByChildren(u, v, s, isCentre);
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
    at(u, v) = DeviationScale::highest(known);
    reach(u, v) = std::numeric_limits<float>::infinity();
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
    int known = scale_.exceededBy(moved, exceededByChildren(u, v, s, isCentre));
    double deviation = moved;
    double greatest = moved;
    for (const Point& apex : apexes) {
        if (apex.i < 0 || apex.j < 0 || apex.i > kRasterTileCells || apex.j > kRasterTileCells)
            continue;
        const auto halves = std::max(reach((apex.i + p.i) / 2, (apex.j + p.j) / 2),
                                     reach((apex.i + q.i) / 2, (apex.j + q.j) / 2));
        const SourceSurface::Inside found =
            reachOf({corner(apex), left, right}, moved + static_cast<double>(halves), known);
        known = scale_.exceededBy(found.deviation, known);
        deviation = std::max(deviation, found.deviation);
        greatest = std::max(greatest, found.greatest);
    }
    at(u, v) = scale_.code(known, deviation);
    reach(u, v) = roundedUp(greatest);
}

/// Bounds on a triangle of which one is known; it is looked at where that leaves open whether more
/// than `known` thresholds are exceeded.
SourceSurface::Inside VertexLevels::TileMeasure::reachOf(const Triangle& triangle,
                                                         double boundMetres, int known) {
    if (known == scale_.thresholds())
        return {0, boundMetres};
    const double next = scale_.next(known);
    if (boundMetres + rounding_ <= next)
        return {boundMetres, boundMetres};
    SourceSurface::Inside found = surface_.inside(triangle, next);
    if (found.deviation <= next)  // then it may be less than what edges deviate
        found.deviation = std::min(next, found.greatest);
    return found;
}

absl::Status VertexLevels::measure(const import::ImportControl& control, const TileFilter& needed) {
    return forEachTile(
        measured_.tilesX(), measured_.tilesY(), "measuring", scratch_, control,
        [&](std::int32_t x, std::int32_t y) {
            if (!needed || needed(x, y))
                measured_.write(x, y, TileMeasure(*this, x, y).run());
        },
        Sweep::FromLastRow);
}

}  // namespace eyrie::terrain
