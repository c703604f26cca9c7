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
void copyRows(const std::vector<T>& from, const PixelViewport& fromArea, std::vector<T>& to,
              const PixelViewport& toArea, const PixelViewport& part) {
    for (int y = part.y; y < part.y + part.height; ++y)
        std::copy_n(&from[offsetIn(fromArea, part.x, y)], part.width,
                    &to[offsetIn(toArea, part.x, y)]);
}

}  // namespace

Image makeImage(const PixelViewport& area, Rgba background, bool withDepth) {
    const auto pixels = static_cast<std::size_t>(area.area());
    return {area, std::vector<Rgba>(pixels, background),
            std::vector<float>(withDepth ? pixels : 0, 0.0F)};
}

PixelViewport coveredArea(const Image& image) {
    const int width = image.area.width;
    int left = width;
    int right = -1;
    int bottom = image.area.height;
    int top = -1;
    for (int y = 0; y < image.area.height; ++y) {
        const float* row = image.depth.data() + static_cast<std::size_t>(y) * width;
        const auto drawn = [](float d) { return d != 0.0F; };
        const auto first = static_cast<int>(std::find_if(row, row + width, drawn) - row);
        if (first == width)
            continue;
        int last = width - 1;
        while (last > right && !drawn(row[last])) --last;
        left = std::min(left, first);
        right = std::max(right, last);
        bottom = std::min(bottom, y);
        top = y;
    }
    if (top < 0)
        return {image.area.x, image.area.y, 0, 0};
    return {image.area.x + left, image.area.y + bottom, right - left + 1, top - bottom + 1};
}

Image crop(const Image& image, const PixelViewport& area) {
    assert(image.area.contains(area));
    Image result = makeImage(area, {}, image.hasDepth());
    if (area.isEmpty())
        return result;
    copyRows(image.colour, image.area, result.colour, area, area);
    if (image.hasDepth())
        copyRows(image.depth, image.area, result.depth, area, area);
    return result;
}

void paste(const Image& source, Image& target) {
    assert(target.area.contains(source.area));
    if (source.area.isEmpty())
        return;
    copyRows(source.colour, source.area, target.colour, target.area, source.area);
    if (source.hasDepth() && target.hasDepth())
        copyRows(source.depth, source.area, target.depth, target.area, source.area);
}

}  // namespace eyrie::fabric
