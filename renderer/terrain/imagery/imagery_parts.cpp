// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/imagery/imagery_parts.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace eyrie::terrain {
namespace {

/// A square of posts within a tile.
struct Square {
    std::int32_t x;
    std::int32_t y;
    std::int32_t side;
};

class PartFinder {
public:
    PartFinder(const EytIndex& index, const lod::ObjectView& view, double texelPixels,
               const TileId& tile, const std::function<bool(const TextureId&)>& isThere,
               Unseen unseen)
        : index_(index),
          imagery_(*index.imagery),
          view_(view),
          texelPixels_(texelPixels),
          record_(index.tile(tile)),
          tile_{tile.x * Quadtree::side(tile.level), tile.y * Quadtree::side(tile.level),
                Quadtree::side(tile.level)},
          isThere_(isThere),
          unseen_(unseen),
          postMetres_(std::max(glm::length(fabric::Vec3(index.objectFromLattice[0])),
                               glm::length(fabric::Vec3(index.objectFromLattice[1])))) {}

    std::vector<ImageryPart> find() {
        add(tile_);
        return std::move(parts_);
    }

private:
    void add(const Square& square) {
        const fabric::Box bounds = boundsOf(square);
        const int level = levelFor(bounds);
        if (imagery_.pyramid.sidePosts(level) >= square.side) {
            parts_.push_back(partOf(square, textureAt(square, level)));
            return;
        }
        const std::size_t first = parts_.size();
        const std::int32_t half = square.side / 2;
        for (int k = 0; k < 4; ++k) {
            const Square quarter{square.x + (k & 1) * half, square.y + (k >> 1) * half, half};
            if (quarter.x < index_.quadtree.columns() - 1 &&
                quarter.y < index_.quadtree.rows() - 1 &&
                (unseen_ == Unseen::Coarsest || view_.isVisible(boundsOf(quarter))))
                add(quarter);
        }
        joinFrom(first, square);
    }

    /// Where all quarters have the same texture, they are one part.
    void joinFrom(std::size_t first, const Square& square) {
        if (first == parts_.size())
            return;
        const auto texture = parts_[first].texture;
        const auto begin = parts_.begin() + static_cast<std::ptrdiff_t>(first);
        if (!std::all_of(begin, parts_.end(),
                         [&](const ImageryPart& part) { return part.texture == texture; }))
            return;
        parts_.erase(begin, parts_.end());
        parts_.push_back(partOf(square, texture));
    }

    ImageryPart partOf(const Square& square, const std::optional<TextureId>& texture) const {
        constexpr std::int32_t kEndless = ImageryPart::kEndless;
        const std::int32_t x = square.x - tile_.x;
        const std::int32_t y = square.y - tile_.y;
        return {x == 0 ? -kEndless : x, y == 0 ? -kEndless : y,
                x + square.side == tile_.side ? kEndless : x + square.side,
                y + square.side == tile_.side ? kEndless : y + square.side, texture};
    }

    fabric::Box boundsOf(const Square& square) const {
        fabric::Box box;
        const double x1 = std::min(square.x + square.side, index_.quadtree.columns() - 1);
        const double y1 = std::min(square.y + square.side, index_.quadtree.rows() - 1);
        for (const double x : {static_cast<double>(square.x), x1})
            for (const double y : {static_cast<double>(square.y), y1}) {
                const fabric::Vec3 corner(index_.objectFromLattice * fabric::Vec4(x, y, 0, 1));
                box.grow({corner.x, corner.y, record_.minHeightMetres});
                box.grow({corner.x, corner.y, record_.maxHeightMetres});
            }
        return box;
    }

    /// Texels grow twofold from level to level, and on the screen at least as fast.
    int levelFor(const fabric::Box& bounds) const {
        const TexturePyramid& pyramid = imagery_.pyramid;
        const double finest = pixelsOf(0, bounds);
        const int top = pyramid.top().level;
        if (!(finest > 0) || std::isinf(texelPixels_))
            return top;  // nothing of it is seen, or any will do
        int level = static_cast<int>(std::clamp(std::floor(std::log2(texelPixels_ / finest)), 0.0,
                                                static_cast<double>(top)));
        while (level > 0 && pixelsOf(level, bounds) > texelPixels_) --level;
        return level;
    }

    double pixelsOf(int level, const fabric::Box& bounds) const {
        return view_.screenSpaceErrorPixels(postMetres_ * imagery_.pyramid.texelPosts(level),
                                            bounds);
    }

    std::optional<TextureId> textureAt(const Square& square, int level) const {
        const double side = imagery_.pyramid.sidePosts(level);
        TextureId texture{level, static_cast<std::int32_t>(square.x / side),
                          static_cast<std::int32_t>(square.y / side)};
        while (imagery_.has(texture) && !isThere_(texture)) {
            if (texture == imagery_.pyramid.top())
                return std::nullopt;
            texture = TexturePyramid::parent(texture);
        }
        return imagery_.has(texture) ? std::optional(texture) : std::nullopt;
    }

    const EytIndex& index_;
    const ImageryIndex& imagery_;
    const lod::ObjectView& view_;
    double texelPixels_;
    const TileRecord& record_;
    Square tile_;
    const std::function<bool(const TextureId&)>& isThere_;
    Unseen unseen_;
    double postMetres_;
    std::vector<ImageryPart> parts_;
};

}  // namespace

std::vector<ImageryPart> imageryParts(const EytIndex& index, const lod::ObjectView& view,
                                      double texelPixels, const TileId& tile,
                                      const std::function<bool(const TextureId&)>& isThere,
                                      Unseen unseen) {
    return PartFinder(index, view, texelPixels, tile, isThere, unseen).find();
}

}  // namespace eyrie::terrain
