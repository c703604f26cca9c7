// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "renderer/lod/view.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::terrain {

/// A part of a tile's ground and the texture tile that is laid on it. In posts from the tile's
/// first: x in [firstX, endX), y alike. The parts of a tile cover its whole ground once, and reach
/// without end beyond its own borders, so that no rounding there falls between them.
struct ImageryPart {
    static constexpr std::int32_t kEndless = 1 << 23;

    std::int32_t firstX = -kEndless;
    std::int32_t firstY = -kEndless;
    std::int32_t endX = kEndless;
    std::int32_t endY = kEndless;
    std::optional<TextureId> texture;  ///< none: there is no picture

    /// It is all that there is of the tile.
    bool isWhole() const {
        return firstX == -kEndless && firstY == -kEndless && endX == kEndless && endY == kEndless;
    }
    bool operator==(const ImageryPart&) const = default;
};

/// What becomes of those parts of a tile that the view does not see.
enum class Unseen { LeftOut, Coarsest };

/// Which texture tiles lie on a tile's ground in a view.
///
/// The coarsest whose texels are at most `texelPixels` on the screen anywhere in the part, or the
/// finest there are. Where one texture tile covers the whole tile there is one part. Otherwise, on
/// pictures much finer than the posts, the tile is quartered until one does; each quarter chooses
/// for itself. What the view does not see is in no part, or has the coarsest texture.
///
/// In place of a texture tile that is not there (`isThere`) comes the nearest above that is.
/// Precondition: index.imagery.
std::vector<ImageryPart> imageryParts(const EytIndex& index, const lod::ObjectView& view,
                                      double texelPixels, const TileId& tile,
                                      const std::function<bool(const TextureId&)>& isThere,
                                      Unseen unseen = Unseen::LeftOut);

/// Texels a side of the screen: what is asked for at tau 1. The nearest point of a part decides for
/// all of it, so most of its texels are smaller.
inline constexpr double kTexelPixels = 1.41421356;

}  // namespace eyrie::terrain
