// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/surroundings.h"

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::truth {
namespace {

using HitRange = ReferenceSurface::HitRange;

/// Of the pixels up to `reach` away, one by one.
Surroundings lookedAt(const std::vector<HitRange>& hits, int width, int x, int y, int reach) {
    Surroundings sum;
    const int height = static_cast<int>(hits.size()) / width;
    for (int row = std::max(0, y - reach); row <= std::min(height - 1, y + reach); ++row)
        for (int column = std::max(0, x - reach); column <= std::min(width - 1, x + reach);
             ++column)
            sum.add(hits[static_cast<std::size_t>(row * width + column)]);
    return sum;
}

RC_GTEST_PROP(Surroundings, AreThoseOfEveryPixelWithinReach, (std::uint32_t seed)) {
    std::mt19937 random(seed);
    const auto below = [&](unsigned bound) { return static_cast<int>(random() % bound); };
    const int width = 1 + below(19), height = 1 + below(13), reach = below(24);
    std::vector<HitRange> hits(static_cast<std::size_t>(width * height));
    for (HitRange& hit : hits)
        if (below(9) != 0) {
            hit.first = below(100);
            hit.last = below(5) == 0 ? kNoHit : hit.first + below(10);
        }
    const std::vector<Surroundings> around = surroundings(hits, width, reach);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Surroundings& got = around[static_cast<std::size_t>(y * width + x)];
            const Surroundings expected = lookedAt(hits, width, x, y, reach);
            RC_ASSERT(got.nearest == expected.nearest);
            RC_ASSERT(got.farthest == expected.farthest);
            RC_ASSERT(got.anyHit == expected.anyHit);
            RC_ASSERT(got.anyMiss == expected.anyMiss);
        }
}

}  // namespace
}  // namespace eyrie::truth
