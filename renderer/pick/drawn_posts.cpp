// SPDX-License-Identifier: Apache-2.0
#include "renderer/pick/drawn_posts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eyrie::pick {
namespace {

using terrain::TileVertex;

/// Columns and rows that a triangle reaches over.
struct Extent {
    Extent(const TileVertex& a, const TileVertex& b, const TileVertex& c)
        : left(std::min({a.x, b.x, c.x})),
          right(std::max({a.x, b.x, c.x})),
          low(std::min({a.y, b.y, c.y})),
          high(std::max({a.y, b.y, c.y})) {}

    std::int32_t left, right, low, high;
};

/// Twice the area of a, b and the post (x, y).
std::int32_t area(const TileVertex& a, const TileVertex& b, std::int32_t x, std::int32_t y) {
    return (b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y);
}

}  // namespace

void DrawnPosts::begin(std::int32_t column, std::int32_t row) {
    column_ = column;
    row_ = row;
    heights_.fill(std::numeric_limits<double>::quiet_NaN());
}

void DrawnPosts::cover(const TileVertex& a, const TileVertex& b, const TileVertex& c) {
    for (const TileVertex* v : {&a, &b, &c}) at(v->x, v->y) = v->q;
    const Extent extent(a, b, c);
    if (extent.right - extent.left > 1 || extent.high - extent.low > 1)
        fill(a, b, c);
}

/// The posts beside its corners: where they are vertices of others, they are as high as there.
void DrawnPosts::fill(const TileVertex& a, const TileVertex& b, const TileVertex& c) {
    const Extent extent(a, b, c);
    const std::int32_t whole = area(a, b, c.x, c.y);
    for (std::int32_t y = extent.low; y <= extent.high; ++y)
        for (std::int32_t x = extent.left; x <= extent.right; ++x) {
            const std::int32_t ofA = area(b, c, x, y);
            const std::int32_t ofB = area(c, a, x, y);
            const std::int32_t ofC = whole - ofA - ofB;
            if (whole > 0 && ofA >= 0 && ofB >= 0 && ofC >= 0)
                at(x, y) = (static_cast<double>(ofA) * a.q + static_cast<double>(ofB) * b.q +
                            static_cast<double>(ofC) * c.q) /
                           whole;
        }
}

double DrawnPosts::twist(const TileVertex& a, const TileVertex& b, const TileVertex& c) const {
    const Extent extent(a, b, c);
    double most = 0;
    for (std::int32_t y = extent.low; y < extent.high; ++y)
        for (std::int32_t x = extent.left; x < extent.right; ++x) {
            const double apart = at(x, y) + at(x + 1, y + 1) - at(x + 1, y) - at(x, y + 1);
            if (!std::isnan(apart))
                most = std::max(most, std::abs(apart) / 2);
        }
    return most;
}

}  // namespace eyrie::pick
