// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/deviation.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <type_traits>

#include <glm/geometric.hpp>

#include "renderer/terrain/deviation_scan.h"
#include "renderer/terrain/small_triangle.h"

namespace eyrie::terrain {
namespace {

struct Bounds {
    explicit Bounds(const Triangle& t)
        : i0(std::min({t[0].i, t[1].i, t[2].i})),
          j0(std::min({t[0].j, t[1].j, t[2].j})),
          i1(std::max({t[0].i, t[1].i, t[2].i})),
          j1(std::max({t[0].j, t[1].j, t[2].j})) {}

    std::int32_t i0, j0, i1, j1;
};

/// The last block with a cell of posts up to `post`, blocks of `cells`.
std::int32_t lastBlock(std::int32_t first, std::int32_t post, std::int32_t cells) {
    return std::max(first, (post - 1) / cells);
}

/// Whether a triangle's inside or border may meet a block: not wholly beyond one of its sides.
class Overlap {
public:
    explicit Overlap(const Triangle& t) : t_(t) {
        const std::int64_t area = std::int64_t{t[1].i - t[0].i} * (t[2].j - t[0].j) -
                                  std::int64_t{t[2].i - t[0].i} * (t[1].j - t[0].j);
        sign_ = area < 0 ? -1 : 1;
    }
    bool meets(std::int32_t i0, std::int32_t j0, std::int32_t cells) const {
        for (std::size_t e = 0; e < 3; ++e) {
            const Corner& a = t_[e];
            const Corner& b = t_[(e + 1) % 3];
            const std::int64_t nx = -sign_ * std::int64_t{b.j - a.j};
            const std::int64_t ny = sign_ * std::int64_t{b.i - a.i};
            const std::int64_t inmost =
                nx * (i0 + (nx > 0 ? cells : 0) - a.i) + ny * (j0 + (ny > 0 ? cells : 0) - a.j);
            if (inmost < 0)
                return false;
        }
        return true;
    }

private:
    const Triangle& t_;
    std::int64_t sign_ = 1;
};

/// Whether its sides run along rows, columns and cells' diagonals, so that they leave no part of a
/// cell but a half.
bool crossesCellsAtPosts(const Triangle& t) {
    for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t di = std::abs(t[k].i - t[(k + 1) % 3].i);
        const std::int32_t dj = std::abs(t[k].j - t[(k + 1) % 3].j);
        if (di != 0 && dj != 0 && di != dj)
            return false;
    }
    return true;
}

}  // namespace

std::vector<std::byte> ElevationModel::state() const {
    std::vector<std::byte> state(sizeof statistics);
    std::memcpy(state.data(), &statistics, sizeof statistics);
    const std::vector<std::byte> summary = relief.bytes();
    state.insert(state.end(), summary.begin(), summary.end());
    return state;
}

bool ElevationModel::restore(std::span<const std::byte> state) {
    static_assert(std::is_trivially_copyable_v<HeightStatistics>);
    if (state.size() < sizeof statistics || !relief.restore(state.subspan(sizeof statistics)))
        return false;
    std::memcpy(&statistics, state.data(), sizeof statistics);
    return true;
}

double DeviationGoal::bar(double worst) const {
    if (steps.empty())
        return worst;
    const auto next = std::lower_bound(steps.begin(), steps.end(), worst);
    return next == steps.end() ? std::numeric_limits<double>::infinity() : *next;
}

SourceSurface::SourceSurface(const ElevationModel& model)
    : model_(model), postTolerance_(std::min(model.frame.postMetres() / 2048, 0.05)) {}

const HeightPatch& SourceSurface::tilePatch(std::int32_t x, std::int32_t y) {
    const std::int32_t i0 = x * kRasterTileCells;
    const std::int32_t j0 = y * kRasterTileCells;
    if (patch_.posts != nullptr && patch_.i0 == i0 && patch_.j0 == j0)
        return patch_;
    tile_ = model_.heights.tile(x, y);
    patch_ = {tile_.get(),
              kRasterTilePosts,
              i0,
              j0,
              std::min(i0 + kRasterTileCells, model_.frame.columns - 1),
              std::min(j0 + kRasterTileCells, model_.frame.rows - 1)};
    return patch_;
}

float SourceSurface::farHeightAt(std::int32_t i, std::int32_t j) {
    return tilePatch(std::min(i / kRasterTileCells, model_.heights.tilesX() - 1),
                     std::min(j / kRasterTileCells, model_.heights.tilesY() - 1))
        .at(i, j);
}

/// On the ground.
double SourceSurface::metresAside(const Corner& a, const Corner& b) const {
    return glm::length(model_.frame.perColumn * static_cast<double>(b.i - a.i) +
                       model_.frame.perRow * static_cast<double>(b.j - a.j));
}

double SourceSurface::longestEdgeMetres(const Triangle& triangle) const {
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
        longest = std::max(longest, metresAside(triangle[k], triangle[(k + 1) % 3]));
    return longest;
}

double SourceSurface::drawnOutlineMetres(const Triangle& triangle) {
    double rounded = 0;
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Corner& corner = triangle[k];
        rounded = std::max(rounded,
                           std::abs(static_cast<double>(heightAt(corner.i, corner.j)) - corner.z));
        const Corner& next = triangle[(k + 1) % 3];
        longest = std::max(longest, std::hypot(metresAside(corner, next), corner.z - next.z));
    }
    return std::max(longest / std::numbers::sqrt3 + rounded,
                    farthestDataMetres(triangle, triangle, 0));
}

double SourceSurface::farthestDataMetres(const Triangle& triangle, std::span<const Corner> drawn,
                                         double atLeast) {
    const Bounds box(triangle);
    const Overlap overlap(triangle);
    const bool endsAtPosts = crossesCellsAtPosts(triangle);
    double farthest = atLeast;
    std::size_t last = 0;  // near one cell, and mostly near the next
    for (std::int32_t j = box.j0; j < box.j1; ++j)
        for (std::int32_t i = box.i0; i < box.i1; ++i) {
            if (!overlap.meets(i, j, 1))
                continue;
            std::array<Corner, 4> posts;
            std::size_t count = 0;
            for (const std::int32_t row : {j, j + 1})
                for (const std::int32_t column : {i, i + 1})
                    posts[count++] = {column, row, static_cast<double>(heightAt(column, row))};
            // Three make half a cell of ground.
            if (std::ranges::count_if(posts, [](const Corner& p) { return std::isnan(p.z); }) > 1)
                continue;
            const auto farthestFrom = [&](const Corner& corner) {
                double aside = 0;
                double up = 0;
                for (const Corner& post : posts) {
                    if (!endsAtPosts || overlap.meets(post.i, post.j, 0))
                        aside = std::max(aside, metresAside(post, corner));
                    if (const double by = std::abs(post.z - corner.z); by > up)  // not of nodata
                        up = by;
                }
                return std::hypot(aside, up);
            };
            double nearest = std::numeric_limits<double>::infinity();
            for (std::size_t k = 0; k < drawn.size() && nearest > farthest; ++k) {
                const std::size_t at = (last + k) % drawn.size();
                if (const double metres = farthestFrom(drawn[at]); metres < nearest) {
                    nearest = metres;
                    if (metres <= farthest)
                        last = at;
                }
            }
            farthest = std::max(farthest, nearest);
        }
    return farthest;
}

double SourceSurface::aroundMetres(const Triangle& triangle) {
    const Bounds box(triangle);
    const std::int32_t around = std::max(box.i1 - box.i0, box.j1 - box.j0);
    float lowest = std::numeric_limits<float>::infinity();
    float highest = -lowest;
    for (std::int32_t j = std::max(0, box.j0 - around);
         j <= std::min(model_.frame.rows - 1, box.j1 + around); ++j)
        for (std::int32_t i = std::max(0, box.i0 - around);
             i <= std::min(model_.frame.columns - 1, box.i1 + around); ++i) {
            const float height = heightAt(i, j);
            lowest = height < lowest ? height : lowest;
            highest = height > highest ? height : highest;
        }
    const double aside = 2 * longestEdgeMetres(triangle);
    return highest > lowest
               ? std::hypot(aside, static_cast<double>(highest) - static_cast<double>(lowest))
               : aside;
}

/// The tile that holds all of a triangle, null if none does.
const HeightPatch* SourceSurface::onlyTile(const Triangle& t) {
    if (patch_.has(t[0].i, t[0].j) && patch_.has(t[1].i, t[1].j) && patch_.has(t[2].i, t[2].j))
        return &patch_;
    const Bounds box(t);
    const std::int32_t x = box.i0 / kRasterTileCells;
    const std::int32_t y = box.j0 / kRasterTileCells;
    if (lastBlock(x, box.i1, kRasterTileCells) > x || lastBlock(y, box.j1, kRasterTileCells) > y)
        return nullptr;
    return &tilePatch(std::min(x, model_.heights.tilesX() - 1),
                      std::min(y, model_.heights.tilesY() - 1));
}

/// Calls visit(x, y, patch), patch() making a HeightPatch, for the summary's blocks that the
/// triangle meets, tile by tile, while it returns true.
template <typename Visit>
void SourceSurface::forEachBlock(const Triangle& triangle, Visit visit) {
    const Bounds box(triangle);
    const Overlap overlap(triangle);
    const std::int32_t cells = model_.relief.blockCells();
    const std::int32_t perTile = kRasterTileCells / cells;
    const std::int32_t x0 = box.i0 / kRasterTileCells;
    const std::int32_t y0 = box.j0 / kRasterTileCells;
    const std::int32_t x1 =
        std::min(lastBlock(x0, box.i1, kRasterTileCells), model_.heights.tilesX() - 1);
    const std::int32_t y1 =
        std::min(lastBlock(y0, box.j1, kRasterTileCells), model_.heights.tilesY() - 1);
    for (std::int32_t y = y0; y <= y1; ++y)
        for (std::int32_t x = x0; x <= x1; ++x) {
            if (!overlap.meets(x * kRasterTileCells, y * kRasterTileCells, kRasterTileCells))
                continue;
            for (std::int32_t v = y * perTile; v < (y + 1) * perTile; ++v)
                for (std::int32_t u = x * perTile; u < (x + 1) * perTile; ++u) {
                    if (!overlap.meets(u * cells, v * cells, cells))
                        continue;
                    const auto patch = [&] {
                        return tilePatch(x, y).clipped(u * cells, v * cells, (u + 1) * cells,
                                                       (v + 1) * cells);
                    };
                    if (!visit(u, v, patch))
                        return;
                }
        }
}

SourceSurface::Contents SourceSurface::contents(const Triangle& triangle) {
    PostCounts all;
    if (const HeightPatch* tile = onlyTile(triangle)) {
        all = countPosts(*tile, triangle);
    } else {
        forEachBlock(triangle, [&](std::int32_t x, std::int32_t y, auto patch) {
            const bool isPlain = !model_.relief.hasNodata(x, y) || !model_.relief.hasData(x, y);
            const bool addsNothing = isPlain && (all.data > 0 || all.nodata > 0) &&
                                     model_.relief.hasData(x, y) == (all.data > 0);
            const PostCounts counts = addsNothing ? PostCounts{} : countPosts(patch(), triangle);
            all.data += counts.data;
            all.nodata += counts.nodata;
            return all.data == 0 || all.nodata == 0;
        });
    }
    if (all.nodata == 0)
        return Contents::Data;
    return all.data == 0 ? Contents::Nodata : Contents::Mixed;
}

/// Posts of a triangle that lies in several tiles.
double SourceSurface::scanBlocks(const Triangle& triangle, const Plane& plane,
                                 const DeviationGoal& goal, double worst) {
    double bar = goal.bar(worst);
    forEachBlock(triangle, [&](std::int32_t x, std::int32_t y, auto patch) {
        if (model_.relief.farthest(x, y, plane) > bar) {
            worst = scanGeneral(patch(), triangle, plane, worst);
            bar = goal.bar(worst);
        }
        return bar < std::numeric_limits<double>::infinity();
    });
    return worst;
}

bool SourceSurface::liesOnItsPosts(const Triangle& triangle) {
    Triangle unmoved = triangle;
    for (Corner& corner : unmoved) corner.z = static_cast<double>(heightAt(corner.i, corner.j));
    const HeightPatch* tile = onlyTile(triangle);
    if (tile != nullptr && isSmall(unmoved))
        return deviationOfSmall(*tile, unmoved, 0).atPosts <= postTolerance_;
    const Plane plane = planeOfAligned(unmoved);
    if (tile != nullptr)
        return scanAligned(*tile, unmoved, plane, 0) <= postTolerance_;
    const std::array<double, 1> step{postTolerance_};
    return scanBlocks(unmoved, plane, {0, step}, 0) <= postTolerance_;
}

double SourceSurface::ofAligned(const Triangle& triangle, const DeviationGoal& goal) {
    if (hasNodata()) {
        const Contents held = contents(triangle);
        if (held != Contents::Data)
            return held == Contents::Mixed ? std::max(goal.floor, longestEdgeMetres(triangle))
                                           : goal.floor;
    }
    if (isSmall(triangle))
        if (const HeightPatch* tile = onlyTile(triangle)) {
            const auto [atPosts, atCentres] = deviationOfSmall(*tile, triangle, goal.floor);
            return atCentres > atPosts && !liesOnItsPosts(triangle) ? atCentres : atPosts;
        }
    const Plane plane = planeOfAligned(triangle);
    double atPosts = goal.floor;
    double atCentres = goal.floor;
    if (const HeightPatch* tile = onlyTile(triangle)) {
        atPosts = scanAligned(*tile, triangle, plane, atPosts);
        atCentres = scanDiagonalEdges(*tile, triangle, atCentres);
    } else {
        atPosts = scanBlocks(triangle, plane, goal, atPosts);
        const double bar = goal.bar(atPosts);
        forEachBlock(triangle, [&](std::int32_t x, std::int32_t y, auto patch) {
            if (model_.relief.farthest(x, y, plane) > bar)
                atCentres = scanDiagonalEdges(patch(), triangle, atCentres);
            return true;
        });
    }
    return atCentres > atPosts && !liesOnItsPosts(triangle) ? atCentres : atPosts;
}

SourceSurface::Inside SourceSurface::inside(const Triangle& triangle, double floor) {
    const HeightPatch& tile = *onlyTile(triangle);
    SmallDeviation found;
    if (isSmall(triangle))
        found = deviationOfSmall(tile, triangle, 0);
    else
        found = {scanAligned(tile, triangle, planeOfAligned(triangle), 0),
                 scanDiagonalEdges(tile, triangle, 0)};
    const auto [atPosts, atCentres] = found;
    const bool countsEdges = atCentres > std::max(atPosts, floor) && !liesOnItsPosts(triangle);
    return {countsEdges ? atCentres : atPosts, std::max(atPosts, atCentres)};
}

bool SourceSurface::mixes(const Triangle& triangle, bool isAligned) {
    const Contents held = contents(triangle);
    if (held != Contents::Data || isAligned)
        return held == Contents::Mixed;
    if (const HeightPatch* tile = onlyTile(triangle))
        return scanCrossings(*tile, triangle, 0).meetsNodata;
    bool meetsNodata = false;
    forEachBlock(triangle, [&](std::int32_t x, std::int32_t y, auto patch) {
        meetsNodata =
            model_.relief.hasNodata(x, y) && scanCrossings(patch(), triangle, 0).meetsNodata;
        return !meetsNodata;
    });
    return meetsNodata;
}

double SourceSurface::ofGeneral(const Triangle& triangle, const DeviationGoal& goal) {
    if (hasNodata()) {
        const Contents held = contents(triangle);
        if (held != Contents::Data)
            return held == Contents::Mixed ? std::max(goal.floor, longestEdgeMetres(triangle))
                                           : goal.floor;
    }
    const Plane plane = planeOf(triangle);
    Crossed crossed{goal.floor, false};
    if (const HeightPatch* tile = onlyTile(triangle)) {
        crossed = scanCrossings(*tile, triangle, scanGeneral(*tile, triangle, plane, goal.floor));
    } else {
        double bar = goal.bar(crossed.worst);
        forEachBlock(triangle, [&](std::int32_t x, std::int32_t y, auto patch) {
            const bool mayMatter =
                model_.relief.farthest(x, y, plane) > bar || model_.relief.hasNodata(x, y);
            if (!mayMatter)
                return true;
            const HeightPatch block = patch();
            const Crossed here =
                scanCrossings(block, triangle, scanGeneral(block, triangle, plane, crossed.worst));
            crossed = {here.worst, crossed.meetsNodata || here.meetsNodata};
            bar = goal.bar(crossed.worst);
            return true;
        });
    }
    return crossed.meetsNodata ? std::max(goal.floor, longestEdgeMetres(triangle)) : crossed.worst;
}

}  // namespace eyrie::terrain
