// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fabric/viewport.h"

namespace eyrie::fabric {

/// Colour of one pixel, 8 bits a channel, not premultiplied; bytes in memory are r, g, b, a.
struct Rgba {
    std::uint8_t r = 0;
    std::uint8_t g = 0;
    std::uint8_t b = 0;
    std::uint8_t a = 255;

    bool operator==(const Rgba&) const = default;
};
static_assert(sizeof(Rgba) == 4);

/// Pixels of a rectangle of a view. Rows run from the bottom up, pixels from left to right.
///
/// `depth` is either empty or as large as `colour`: reversed depth, 1 at the near plane, 0 where
/// nothing was drawn. Everything outside `area` is background with depth 0.
struct Image {
    PixelViewport area;
    std::vector<Rgba> colour;
    std::vector<float> depth;

    bool hasDepth() const { return !depth.empty(); }
    bool operator==(const Image&) const = default;
};

/// The pixels of an image that is somewhere else, as they lie there; no longer than that is there.
struct ImageView {
    PixelViewport area;
    std::span<const Rgba> colour;
    std::span<const float> depth;

    ImageView() = default;
    ImageView(const PixelViewport& where, std::span<const Rgba> colours,
              std::span<const float> depths)
        : area(where), colour(colours), depth(depths) {}
    ImageView(const Image& image) : ImageView(image.area, image.colour, image.depth) {}

    bool hasDepth() const { return !depth.empty(); }
};

Image copied(const ImageView& image);

/// An image of `area` filled with `background` and, if asked for, depth 0.
Image makeImage(const PixelViewport& area, Rgba background, bool withDepth);

/// Copies `source` over `target` (sort-first assembly); depth too where both have it.
/// Precondition: target.area contains source.area, unless that is empty.
void paste(const ImageView& source, Image& target);

}  // namespace eyrie::fabric
