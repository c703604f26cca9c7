// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/degrees_caveat.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <glm/common.hpp>

namespace eyrie::import {
namespace {

using fabric::Vec2;

struct Extent {
    Vec2 low;
    Vec2 high;
};

/// Of the posts.
Extent extentOf(const terrain::GridFrame& frame) {
    const Vec2 right = frame.perColumn * static_cast<double>(frame.columns - 1);
    const Vec2 down = frame.perRow * static_cast<double>(frame.rows - 1);
    Extent extent{frame.origin, frame.origin};
    for (const Vec2& way : std::array{right, down, right + down}) {
        extent.low = glm::min(extent.low, frame.origin + way);
        extent.high = glm::max(extent.high, frame.origin + way);
    }
    return extent;
}

}  // namespace

bool mayBeDegrees(const terrain::GridFrame& frame) {
    constexpr double kRounding = 1e-6;
    const Vec2 most = Vec2(360, 90) + kRounding;
    const Extent extent = extentOf(frame);
    return glm::all(glm::greaterThanEqual(extent.low, -most)) &&
           glm::all(glm::lessThanEqual(extent.high, most));
}

std::string degreesCaveat(const terrain::GridFrame& frame,
                          const terrain::HeightStatistics& heights) {
    // A degree taken for a metre makes 1 in 10,000 a slope of 11; a wall scanned from above, or a
    // tree, is hardly as tall as this.
    constexpr double kSteep = 4;
    const Extent extent = extentOf(frame);
    const Vec2 size = extent.high - extent.low;
    const double relief = static_cast<double>(heights.max) - heights.min;
    if (!(relief > kSteep * std::max(size.x, size.y)))
        return "";
    return fmt::format(
        "no CRS says where on earth it lies, and coordinates are taken for metres; if they are "
        "degrees ({:.6g} to {:.6g} east, {:.6g} to {:.6g} north), say so first (gdal_translate "
        "-a_srs EPSG:4326)",
        extent.low.x, extent.high.x, extent.low.y, extent.high.y);
}

}  // namespace eyrie::import
