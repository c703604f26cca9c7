// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/deviation.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include <glm/geometric.hpp>

#include "renderer/terrain/deviation_scan.h"
#include "renderer/terrain/small_triangle.h"
#include "renderer/terrain/triangle_cells.h"

namespace eyrie::terrain {
namespace {

/// The last block with a cell of posts up to `post`, blocks of `cells`.
std::int32_t lastBlock(std::int32_t first, std::int32_t post, std::int32_t cells) {
    return std::max(first, (post - 1) / cells);
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

/// The tile that holds all of a triangle, null if none does.
const HeightPatch* SourceSurface::onlyTile(const Triangle& t) {
    if (patch_.has(t[0].i, t[0].j) && patch_.has(t[1].i, t[1].j) && patch_.has(t[2].i, t[2].j))
        return &patch_;
    const PostBounds box(t);
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
    const PostBounds box(triangle);
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
