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

void paste(const Image& source, Image& target) {
    if (source.area.isEmpty())
        return;
    assert(target.area.contains(source.area));
    copyRows(source.colour, source.area, target.colour, target.area, source.area);
    if (source.hasDepth() && target.hasDepth())
        copyRows(source.depth, source.area, target.depth, target.area, source.area);
}

}  // namespace eyrie::fabric
