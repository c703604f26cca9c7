// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace eyrie::fabric {

/// A rectangle of whole pixels inside a view, counted from the view's lower left corner.
struct PixelViewport {
    std::int32_t x = 0;
    std::int32_t y = 0;
    std::int32_t width = 0;
    std::int32_t height = 0;

    bool isEmpty() const { return width <= 0 || height <= 0; }
    std::int64_t area() const { return isEmpty() ? 0 : std::int64_t{width} * height; }
    bool contains(const PixelViewport& inner) const {
        const auto end = [](std::int32_t from, std::int32_t size) {
            return std::int64_t{from} + size;  // somebody may have asked for anything
        };
        return inner.x >= x && inner.y >= y && end(inner.x, inner.width) <= end(x, width) &&
               end(inner.y, inner.height) <= end(y, height);
    }
    bool operator==(const PixelViewport&) const = default;
};

PixelViewport intersection(const PixelViewport& a, const PixelViewport& b);

/// The smallest rectangle around both; an empty one adds nothing.
PixelViewport enclosing(const PixelViewport& a, const PixelViewport& b);

/// One rectangle more than `cuts` (ascending, in (0, 1)), side by side along the longer axis, that
/// cover `whole` once; each cut falls between the pixels nearest to it. Those that would have no
/// pixels are left out.
std::vector<PixelViewport> split(const PixelViewport& whole, std::span<const double> cuts);

}  // namespace eyrie::fabric
