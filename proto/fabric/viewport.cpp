// SPDX-License-Identifier: Apache-2.0
#include "fabric/viewport.h"

#include <algorithm>
#include <cmath>

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

std::vector<PixelViewport> split(const PixelViewport& whole, std::span<const double> cuts) {
    std::vector<PixelViewport> parts;
    const bool wide = whole.width >= whole.height;
    const int length = wide ? whole.width : whole.height;
    int begin = 0;
    const auto endAt = [&](int end) {
        if (end > begin)
            parts.push_back(
                wide ? PixelViewport{whole.x + begin, whole.y, end - begin, whole.height}
                     : PixelViewport{whole.x, whole.y + begin, whole.width, end - begin});
        begin = std::max(begin, end);
    };
    for (const double cut : cuts) endAt(static_cast<int>(std::lround(length * cut)));
    endAt(length);
    return parts;
}

}  // namespace eyrie::fabric
