// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/seen_lids.h"

#include <cmath>

namespace eyrie::draw {
namespace {

/// Of a piece's depth: more than rounding adds.
constexpr double kRounding = 1e-9;

}  // namespace

SeenLids::SeenLids(std::span<const fabric::Box> lids, const lod::ObjectView& view) : view_(view) {
    for (const fabric::Box& lid : lids)
        lids_.push_back(
            {view.coveredPixels(lid), -fabric::transformed(lid, view.viewFromObject()).max.z});
}

fabric::PixelViewport SeenLids::before(const fabric::Box& bounds) const {
    fabric::PixelViewport all;
    if (lids_.empty())
        return all;
    const fabric::PixelViewport pixels = view_.coveredPixels(bounds);
    const double farthest = -fabric::transformed(bounds, view_.viewFromObject()).min.z;
    for (const Seen& lid : lids_)
        if (lid.nearest <= farthest + kRounding * std::abs(farthest))
            all = fabric::enclosing(all, fabric::intersection(lid.pixels, pixels));
    return all;
}

}  // namespace eyrie::draw
