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
    scale_ = DeviationScale(std::move(metres), model_.statistics.highestMagnitude());
}

/// Thresholds exceeded by the triangle p, apex, q of the padded square; not below `known`.
int VertexLevels::exceededByTriangle(SourceSurface& surface, const Point& p, const Point& apex,
                                     const Point& q, int known) const {
    if (known == scale_.thresholds())
        return known;
    const DeviationGoal goal{scale_.next(known), scale_.metres()};
    const auto corner = [&](const Point& at) {
        const std::int32_t i = std::min(at.i, columns_ - 1);
        const std::int32_t j = std::min(at.j, rows_ - 1);
        return Corner{i, j, static_cast<double>(surface.heightAt(i, j))};
    };
    const Triangle triangle = {corner(apex), corner(p), corner(q)};
    const auto isInside = [&](const Point& at) { return at.i < columns_ && at.j < rows_; };
    const bool isAligned = isInside(p) && isInside(apex) && isInside(q);
    double deviation = goal.floor;
    if (isAligned) {
        deviation = surface.ofAligned(triangle, goal);
    } else {
        const auto pastColumns = [&](const Corner& c) { return c.i == columns_ - 1; };
        const auto pastRows = [&](const Corner& c) { return c.j == rows_ - 1; };
        const bool isSqueezed = std::all_of(triangle.begin(), triangle.end(), pastColumns) ||
                                std::all_of(triangle.begin(), triangle.end(), pastRows);
        if (isSqueezed)
            return known;
        deviation = surface.ofGeneral(triangle, goal);
    }
    if (deviation > goal.floor)
        return scale_.exceededBy(deviation);
    // What level 0 may leave out is told of heights: ground narrower than that does not vanish.
    return known == 0 && surface.hasNodata() && surface.mixes(triangle, isAligned) ? 1 : known;
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

std::uint8_t VertexLevels::codeAt(std::int32_t i, std::int32_t j) const {
    if (i < 0 || j < 0 || i > side_ || j > side_)
        return 0;
    if (isCovered(i, j)) [[likely]]
        return coarse_[coarseIndex(i, j)];
    const auto found = outside_.find(key(i, j));
    return found == outside_.end() ? DeviationScale::highest(0) : found->second;
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

/// Of a vertex that was measured in its tiles, now that all its children are known.
std::uint8_t VertexLevels::raised(std::int32_t i, std::int32_t j, std::int32_t s,
                                  bool isCentre) const {
    return std::max(codeAt(i, j), DeviationScale::lowest(exceededByChildren(i, j, s, isCentre)));
}

/// Of a vertex whose triangles no tile holds.
std::uint8_t VertexLevels::split(SourceSurface& surface, std::int32_t i, std::int32_t j,
                                 std::int32_t s, bool isCentre) const {
    const int known = std::max(exceeded(i, j), exceededByChildren(i, j, s, isCentre));
    return DeviationScale::highest(exceededBySplit(surface, i, j, s, isCentre, known));
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
                    const std::uint8_t code =
                        isMeasured ? raised(i, j, s, isCentre) : split(surface, i, j, s, isCentre);
                    if (isCovered(i, j))
                        coarse_[coarseIndex(i, j)] = code;
                    else if (DeviationScale::exceeded(code) > 0)
                        outside.local().push_back({key(i, j), code});
                }
            }
        });
    for (const std::vector<Found>& found : outside)
        for (const Found& vertex : found)
            outside_[vertex.key] = static_cast<std::uint8_t>(vertex.code);
}

absl::Status VertexLevels::finish(const import::ImportControl& control, std::int32_t endSpacing) {
    for (std::int32_t s = kCoarseSpacing; s < std::min(side_, endSpacing); s *= 2)
        for (const bool isCentre : {false, true}) {
            RETURN_IF_ERROR(control.check());
            finishClass(s, isCentre);
            RETURN_IF_ERROR(scratch_.status());
        }
    return absl::OkStatus();
}

std::vector<std::byte> VertexLevels::state() const {
    std::vector<Found> outside;
    for (const auto& [key, code] : outside_) outside.push_back({key, code});
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
        outside_[found.key] = static_cast<std::uint8_t>(found.code);
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
            at(i, j) = codeAt(i << layer, j << layer);
}

}  // namespace eyrie::terrain
