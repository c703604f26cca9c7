// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace eyrie::equalizer {

enum class Axis { X, Y };

/// Part of what is cut, from (x, y) up to (xEnd, yEnd): pixels of a picture from its lower left
/// corner, or, on x alone, a share of the data. Parts that meet have the very same edge.
struct Area {
    double x = 0;
    double y = 0;
    double xEnd = 1;
    double yEnd = 1;

    double begin(Axis axis) const { return axis == Axis::X ? x : y; }
    double end(Axis axis) const { return axis == Axis::X ? xEnd : yEnd; }
    double length(Axis axis) const { return end(axis) - begin(axis); }
    double size() const { return std::max(0.0, xEnd - x) * std::max(0.0, yEnd - y); }
    bool isEmpty() const { return !(x < xEnd && y < yEnd); }
    bool operator==(const Area&) const = default;
};

inline Area intersection(const Area& a, const Area& b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::min(a.xEnd, b.xEnd),
            std::min(a.yEnd, b.yEnd)};
}

/// What lies before `position` on `axis`.
inline Area before(Area area, Axis axis, double position) {
    (axis == Axis::X ? area.xEnd : area.yEnd) = position;
    return area;
}

/// What lies from `position` on.
inline Area from(Area area, Axis axis, double position) {
    (axis == Axis::X ? area.x : area.y) = position;
    return area;
}

}  // namespace eyrie::equalizer
