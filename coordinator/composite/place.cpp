// SPDX-License-Identifier: Apache-2.0
#include "coordinator/composite/place.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

namespace eyrie::composite {
namespace {

using fabric::Image;
using fabric::PixelViewport;
using fabric::Rgba;

std::size_t offsetIn(const PixelViewport& area, std::int32_t x, std::int32_t y) {
    return static_cast<std::size_t>(y - area.y) * static_cast<std::size_t>(area.width) +
           static_cast<std::size_t>(x - area.x);
}

std::uint8_t mixed(double a, double b, double weight) {
    return static_cast<std::uint8_t>(std::lround(a + (b - a) * weight));
}

/// In one go, so that a mean of four is rounded once.
Rgba colourAt(const Image& source, const Tap& column, const Tap& row) {
    const auto at = [&](std::int32_t x, std::int32_t y) {
        return source.colour[offsetIn(source.area, x, y)];
    };
    const Rgba corner = at(column.first, row.first);
    if (column.weight == 0 && row.weight == 0)
        return corner;
    const Rgba right = at(column.second, row.first);
    const Rgba above = at(column.first, row.second);
    const Rgba across = at(column.second, row.second);
    const auto mean = [&](std::uint8_t Rgba::*channel) {
        const double low = corner.*channel + (right.*channel - corner.*channel) * column.weight;
        const double high = above.*channel + (across.*channel - above.*channel) * column.weight;
        return mixed(low, high, row.weight);
    };
    return {mean(&Rgba::r), mean(&Rgba::g), mean(&Rgba::b), mean(&Rgba::a)};
}

bool comes(Placing placing, float theirs, float ours) {
    return placing == Placing::Nearer ? theirs > ours : theirs >= ours;
}

/// A pixel of a row or column that gets something.
struct Fed {
    std::int32_t at;  ///< from the part's corner
    Tap tap;
};

/// By a source that reaches from `begin` on over `size` pixels. Of two neighbours of which it has
/// one the nearer decides whose the pixel is, so that sources which meet leave none out; of the
/// other it knows nothing.
std::vector<Fed> fed(std::span<const Tap> taps, std::int32_t begin, std::int32_t size) {
    std::vector<Fed> found;
    for (std::size_t i = 0; i < taps.size(); ++i) {
        Tap tap = taps[i];
        if (tap.isNone() || tap.nearest() < begin || tap.nearest() >= begin + size)
            continue;
        tap.first = std::max(tap.first, begin);
        tap.second = std::min(tap.second, begin + size - 1);
        found.push_back({static_cast<std::int32_t>(i), tap});
    }
    return found;
}

}  // namespace

void place(const Image& source, std::span<const Tap> columns, std::span<const Tap> rows,
           const PixelViewport& part, Placing placing, Image& target) {
    assert(target.area.contains(part));
    assert(std::ssize(columns) == part.width && std::ssize(rows) == part.height);
    const PixelViewport& area = source.area;
    const bool byDepth = placing != Placing::Paste;
    const bool withDepth = source.hasDepth() && target.hasDepth();
    assert(!byDepth || withDepth);
    const std::vector<Fed> across = fed(columns, area.x, area.width);
    for (const Fed& row : fed(rows, area.y, area.height)) {
        const std::size_t first = offsetIn(target.area, part.x, part.y + row.at);
        for (const Fed& column : across) {
            const std::size_t to = first + static_cast<std::size_t>(column.at);
            if (withDepth) {
                const float depth =
                    source.depth[offsetIn(area, column.tap.nearest(), row.tap.nearest())];
                if (byDepth && !comes(placing, depth, target.depth[to]))
                    continue;
                target.depth[to] = depth;
            }
            target.colour[to] = colourAt(source, column.tap, row.tap);
        }
    }
}

Image zoomed(const Image& source, const fabric::Regridding& zoom) {
    const PixelViewport area{0, 0, zoom.width, zoom.height};
    Image made = fabric::makeImage(area, {}, source.hasDepth());
    place(source, tapsBefore(zoom, Axis::Columns), tapsBefore(zoom, Axis::Rows), area,
          Placing::Paste, made);
    return made;
}

}  // namespace eyrie::composite
