// SPDX-License-Identifier: Apache-2.0
#include "coordinator/composite/eyes.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace eyrie::composite {
namespace {

using fabric::Image;

std::uint8_t seen(bool byLeft, std::uint8_t left, bool byRight, std::uint8_t right) {
    if (byLeft && byRight)
        return static_cast<std::uint8_t>((left + right + 1) / 2);
    return static_cast<std::uint8_t>(byLeft ? left : byRight ? right : 0);
}

Image both(const Image& a, const Image& b, const fabric::PixelViewport& area) {
    Image image = fabric::makeImage(area, {}, a.hasDepth() && b.hasDepth());
    fabric::paste(a, image);
    fabric::paste(b, image);
    return image;
}

}  // namespace

Image anaglyph(const Image& left, const Mask& leftMask, const Image& right, const Mask& rightMask) {
    assert(left.area == right.area);
    Image image = fabric::makeImage(left.area, {}, false);
    for (std::size_t i = 0; i < image.colour.size(); ++i) {
        const fabric::Rgba& a = left.colour[i];
        const fabric::Rgba& b = right.colour[i];
        image.colour[i] = {seen(leftMask.red, a.r, rightMask.red, b.r),
                           seen(leftMask.green, a.g, rightMask.green, b.g),
                           seen(leftMask.blue, a.b, rightMask.blue, b.b), std::max(a.a, b.a)};
    }
    return image;
}

Image sideBySide(const Image& left, const Image& right) {
    fabric::PixelViewport area = left.area;
    area.width *= 2;
    Image moved = right;
    moved.area = {left.area.x + left.area.width, left.area.y, right.area.width, right.area.height};
    return both(left, moved, area);
}

Image topBottom(const Image& left, const Image& right) {
    fabric::PixelViewport area = left.area;
    area.height *= 2;
    Image above = left;
    above.area.y += left.area.height;
    Image below = right;
    below.area = left.area;
    return both(above, below, area);
}

}  // namespace eyrie::composite
