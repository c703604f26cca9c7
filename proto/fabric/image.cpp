// SPDX-License-Identifier: Apache-2.0
#include "fabric/image.h"

#include <algorithm>
#include <cassert>

namespace eyrie::fabric {
namespace {

std::size_t offsetIn(const PixelViewport& area, int x, int y) {
    return static_cast<std::size_t>(y - area.y) * static_cast<std::size_t>(area.width) +
           static_cast<std::size_t>(x - area.x);
}

template <typename T>
void copyRows(std::span<const T> from, const PixelViewport& fromArea, std::vector<T>& to,
              const PixelViewport& toArea, const PixelViewport& part) {
    for (int y = part.y; y < part.y + part.height; ++y)
        std::copy_n(&from[offsetIn(fromArea, part.x, y)], part.width,
                    &to[offsetIn(toArea, part.x, y)]);
}

}  // namespace

Image copied(const ImageView& image) {
    return {image.area,
            {image.colour.begin(), image.colour.end()},
            {image.depth.begin(), image.depth.end()}};
}

Image makeImage(const PixelViewport& area, Rgba background, bool withDepth) {
    const auto pixels = static_cast<std::size_t>(area.area());
    Image image{area, {}, std::vector<float>(withDepth ? pixels : 0, 0.0F)};
    if (pixels == 0)
        return image;
    // By rows, which are copied: pixel by pixel takes three times as long.
    const std::vector<Rgba> row(static_cast<std::size_t>(area.width), background);
    image.colour.reserve(pixels);
    for (int y = 0; y < area.height; ++y)
        image.colour.insert(image.colour.end(), row.begin(), row.end());
    return image;
}

void paste(const ImageView& source, Image& target) {
    if (source.area.isEmpty())
        return;
    assert(target.area.contains(source.area));
    copyRows(source.colour, source.area, target.colour, target.area, source.area);
    if (source.hasDepth() && target.hasDepth())
        copyRows(source.depth, source.area, target.depth, target.area, source.area);
}

}  // namespace eyrie::fabric
