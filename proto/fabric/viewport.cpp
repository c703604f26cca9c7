// SPDX-License-Identifier: Apache-2.0
#include "fabric/viewport.h"

#include <algorithm>

namespace eyrie::fabric {

PixelViewport intersection(const PixelViewport& a, const PixelViewport& b) {
    const int left = std::max(a.x, b.x);
    const int bottom = std::max(a.y, b.y);
    const int right = std::min(a.x + a.width, b.x + b.width);
    const int top = std::min(a.y + a.height, b.y + b.height);
    if (right <= left || top <= bottom)
        return {};
    return {left, bottom, right - left, top - bottom};
}

PixelViewport enclosing(const PixelViewport& a, const PixelViewport& b) {
    if (a.isEmpty() || b.isEmpty())
        return a.isEmpty() ? b : a;
    const int left = std::min(a.x, b.x);
    const int bottom = std::min(a.y, b.y);
    return {left, bottom, std::max(a.x + a.width, b.x + b.width) - left,
            std::max(a.y + a.height, b.y + b.height) - bottom};
}

std::vector<PixelViewport> split(const PixelViewport& whole, int count) {
    std::vector<PixelViewport> parts;
    const bool wide = whole.width >= whole.height;
    const std::int64_t length = wide ? whole.width : whole.height;
    for (std::int64_t i = 0; i < count; ++i) {
        const int begin = static_cast<int>(length * i / count);
        const int size = static_cast<int>(length * (i + 1) / count) - begin;
        if (size == 0)
            continue;
        parts.push_back(wide ? PixelViewport{whole.x + begin, whole.y, size, whole.height}
                             : PixelViewport{whole.x, whole.y + begin, whole.width, size});
    }
    return parts;
}

}  // namespace eyrie::fabric
