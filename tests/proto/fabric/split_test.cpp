// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "fabric/range.h"
#include "fabric/viewport.h"

namespace eyrie::fabric {
namespace {

RC_GTEST_PROP(PixelViewportSplit, CoversEveryPixelOnce, ()) {
    const PixelViewport whole{*rc::gen::inRange(0, 50), *rc::gen::inRange(0, 50),
                              *rc::gen::inRange(1, 40), *rc::gen::inRange(1, 40)};
    const std::vector<PixelViewport> parts = split(whole, equalCuts(*rc::gen::inRange(1, 50)));
    for (int y = whole.y; y < whole.y + whole.height; ++y)
        for (int x = whole.x; x < whole.x + whole.width; ++x)
            RC_ASSERT(std::count_if(parts.begin(), parts.end(), [&](const PixelViewport& part) {
                          return part.contains({x, y, 1, 1});
                      }) == 1);
    for (const PixelViewport& part : parts) RC_ASSERT(whole.contains(part) && !part.isEmpty());
}

RC_GTEST_PROP(PixelViewportSplit, PartsDifferByOnePixelAtMost, ()) {
    const PixelViewport whole{0, 0, *rc::gen::inRange(100, 5000), *rc::gen::inRange(1, 100)};
    const auto parts = split(whole, equalCuts(*rc::gen::inRange(1, 100)));
    const auto [least, most] = std::minmax_element(
        parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.width < b.width; });
    RC_ASSERT(most->width - least->width <= 1);
}

TEST(PixelViewportSplit, CutsTheLongerSide) {
    EXPECT_EQ(split(PixelViewport{0, 0, 100, 50}, equalCuts(2))[1], (PixelViewport{50, 0, 50, 50}));
    EXPECT_EQ(split(PixelViewport{0, 0, 50, 100}, equalCuts(2))[1], (PixelViewport{0, 50, 50, 50}));
}

TEST(PixelViewport, TheIntersectionIsWhatBothHold) {
    EXPECT_EQ(intersection({0, 0, 10, 10}, {4, 6, 10, 10}), (PixelViewport{4, 6, 6, 4}));
    EXPECT_TRUE(intersection({0, 0, 10, 10}, {10, 0, 10, 10}).isEmpty());
}

TEST(PixelViewport, TheEnclosingOneHoldsBothAndNoMore) {
    EXPECT_EQ(enclosing({0, 0, 10, 10}, {14, 6, 2, 10}), (PixelViewport{0, 0, 16, 16}));
    EXPECT_EQ(enclosing({}, {14, 6, 2, 10}), (PixelViewport{14, 6, 2, 10}));
    EXPECT_EQ(enclosing({14, 6, 2, 10}, {0, 0, 0, 5}), (PixelViewport{14, 6, 2, 10}));
}

RC_GTEST_PROP(RangeSplit, CoversEveryPositionOnce, ()) {
    const double begin = *rc::gen::inRange(0, 500) / 1000.0;
    const double end = begin + *rc::gen::inRange(1, 500) / 1000.0;
    const std::vector<Range> parts = split(Range{begin, end}, equalCuts(*rc::gen::inRange(1, 20)));
    RC_ASSERT(parts.front().begin == begin);
    RC_ASSERT(parts.back().end == end);
    for (std::size_t i = 1; i < parts.size(); ++i)
        RC_ASSERT(parts[i].begin == parts[i - 1].end && !parts[i].isEmpty());
}

}  // namespace
}  // namespace eyrie::fabric
