// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/terrain_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <glm/matrix.hpp>

#include "renderer/draw/terrain_tiles.h"
#include "renderer/lod/vertical_error.h"
#include "renderer/terrain/holes.h"

namespace eyrie::draw {
namespace {

using fabric::Box;
using fabric::Vec2;
using fabric::Vec3;
using terrain::Quadtree;

/// Tiles of a cut that keep tau whose triangles are looked at, to promise less.
constexpr int kMostLookedAt = 16;

double errorMetres(const terrain::TileRecord& record, std::size_t share) {
    return static_cast<double>(record.errorMetres) * static_cast<double>(share) /
           terrain::kFullPartError;
}

/// Where the plane of a triangle is at (x, y), if the triangle is there.
std::optional<double> heightAt(std::span<const Vec3, 3> t, double x, double y) {
    const auto side = [&](const Vec3& a, const Vec3& b) {
        return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
    };
    const Vec3 weights(side(t[1], t[2]), side(t[2], t[0]), side(t[0], t[1]));
    const double area = weights.x + weights.y + weights.z;
    if (!(area > 0) || weights.x < 0 || weights.y < 0 || weights.z < 0)
        return std::nullopt;
    return (weights.x * t[0].z + weights.y * t[1].z + weights.z * t[2].z) / area;
}

Box boundsOf(std::span<const Vec3, 3> triangle) {
    Box bounds;
    for (const Vec3& corner : triangle) bounds.grow(corner);
    return bounds;
}

}  // namespace

double TerrainError::pixels(const terrain::TerrainCut& cut) {
    terrain::DrawnGround ground;
    ground.narrower = [this](const terrain::TileChoice& tile, double pixels, double enough) {
        return ofTriangles(tile, pixels, enough);
    };
    if (!isEyeOverGround())
        hidden_ = nullptr;
    if (hidden_ != nullptr) {
        for (const auto* tiles : {&cut.tiles, &cut.holes})
            for (const terrain::TileChoice& tile : *tiles)
                if (index_.tile(tile.id).outlineMetres > 0)
                    blurred_.push_back(index_.quadtree.tileIndex(tile.id));
        std::ranges::sort(blurred_);
        ground.isHidden = [this](const Box& bounds, double pixels) {
            return isHidden(bounds, [&] { return hidden_->coverOf(bounds, pixels); });
        };
    }
    return terrain::screenSpaceErrorPixels(index_, request_.view, cut, ground);
}

/// Judges a tile by the triangles that are drawn of it: one of the finest level that does not keep
/// tau, about which nothing can be done (the eye may well be inside its box), and a few others that
/// would decide what is promised. Where the outline of a hole may be off, the boxes of the tile's
/// parts do: triangles that mix data and nodata lie in those alone. The channels that draw a tile
/// that does not keep tau judge it.
double TerrainError::ofTriangles(const terrain::TileChoice& tile, double pixels, double enough) {
    const terrain::TileRecord& record = index_.tile(tile.id);
    const bool isLimit = tile.id.level == 0 && pixels > request_.tauPixels;
    if (!isLimit && lookedAt_ == kMostLookedAt)
        return pixels;
    const double ofOutlines = terrain::outlineErrorPixels(index_, request_.view, tile.id);
    if (ofOutlines >= pixels)
        return pixels;
    if (!needed_.contains(tile.id) || record.triangles == 0)
        return isLimit ? ofOutlines : pixels;
    lookedAt_ += isLimit ? 0 : 1;
    const CornersByError corners = drawnCorners(index_, tile, *paging_.tile(tile.id));
    double worst = std::max(enough, ofOutlines);
    for (std::size_t share = 0; share < corners.size(); ++share) {
        const lod::VerticalError error(request_.view, errorMetres(record, share));
        for (std::size_t k = 0; k + 2 < corners[share].size(); k += 3) {
            const std::span<const Vec3, 3> triangle(corners[share].data() + k, 3);
            const double own = error.pixels(triangle) + request_.view.roundingPixels(triangle);
            if (own > worst && !(hidden_ != nullptr && isHidden(boundsOf(triangle), [&] {
                                     return hidden_->coverOf(triangle, own);
                                 })))
                worst = own;
        }
    }
    return std::min(pixels, worst);
}

/// Whether what lies in `bounds` is hidden by what `coverOf()` says covers it. A hole behind that
/// does not let anyone see it.
template <typename CoverOf>
bool TerrainError::isHidden(const Box& bounds, CoverOf coverOf) {
    const std::optional<fabric::PixelViewport> cover = coverOf();
    if (!cover || !isEyeAboveGround())
        return false;
    const Vec2 eye(request_.view.objectFromView()[3]);
    return !terrain::hasHoleBefore(index_, eye, bounds, blurred_) ||
           !terrain::hasHoleBefore(index_, eye, bounds, blurred_, hidden_->reachOf(*cover));
}

/// Whether the eye is above or below a cell of the terrain.
bool TerrainError::isEyeOverGround() const {
    const Vec3 post = eyePost();
    return post.x >= 0 && post.y >= 0 && post.x < index_.quadtree.columns() - 1 &&
           post.y < index_.quadtree.rows() - 1;
}

/// The eye in the lattice; its height does not count.
Vec3 TerrainError::eyePost() const {
    const Vec3 eye(request_.view.objectFromView()[3]);
    return Vec3(glm::inverse(index_.objectFromLattice) * fabric::Vec4(eye.x, eye.y, 0, 1));
}

bool TerrainError::isEyeAboveGround() {
    if (!isEyeAboveGround_)
        isEyeAboveGround_ = findEyeAboveGround();
    return *isEyeAboveGround_;
}

/// Whether the eye is above the source, and not over a hole. That is no higher than any tile's box,
/// nor than what any tile draws plus its error.
bool TerrainError::findEyeAboveGround() {
    const Vec3 eye(request_.view.objectFromView()[3]);
    const Vec3 post = eyePost();
    const Quadtree& quadtree = index_.quadtree;
    for (int level = 0; level < quadtree.levels(); ++level) {
        const terrain::TileId id{level, static_cast<std::int32_t>(post.x) / Quadtree::side(level),
                                 static_cast<std::int32_t>(post.y) / Quadtree::side(level)};
        const terrain::TileRecord& record = index_.tile(id);
        if (record.outlineMetres > 0 || record.triangles == 0)
            return false;
        if (eye.z > record.maxHeightMetres)
            return true;
        const DeviceTile* tile = paging_.tile(id);
        if (tile == nullptr)
            continue;
        const CornersByError corners = drawnCorners(index_, {.id = id}, *tile);
        for (std::size_t share = 0; share < corners.size(); ++share)
            for (std::size_t k = 0; k + 2 < corners[share].size(); k += 3)
                if (const auto ground = heightAt(
                        std::span<const Vec3, 3>(corners[share].data() + k, 3), eye.x, eye.y))
                    return eye.z > *ground + errorMetres(record, share);
        return false;
    }
    return false;
}

}  // namespace eyrie::draw
