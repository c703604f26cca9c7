// SPDX-License-Identifier: Apache-2.0
#include "fabric/depth_merge.h"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "sample_images.h"

namespace eyrie::fabric {
namespace {

/// The rule, pixel by pixel, as the header states it.
Image mergedPlainly(const Image& source, Image target) {
    for (int y = source.area.y; y < source.area.y + source.area.height; ++y)
        for (int x = source.area.x; x < source.area.x + source.area.width; ++x) {
            const auto from = static_cast<std::size_t>((y - source.area.y) * source.area.width +
                                                       (x - source.area.x));
            const auto to = static_cast<std::size_t>((y - target.area.y) * target.area.width +
                                                     (x - target.area.x));
            if (source.depth[from] > target.depth[to]) {
                target.depth[to] = source.depth[from];
                target.colour[to] = source.colour[from];
            }
        }
    return target;
}

Image merged(const Image& source, Image target) {
    mergeDepth(source, target);
    return target;
}

// 37 pixels a row: vectors, and a remainder.
constexpr PixelViewport kWhole{0, 0, 37, 6};

RC_GTEST_PROP(DepthMerge, IsTheScalarRule, (std::uint32_t seed)) {
    const Image target = sampleImage(kWhole, seed);
    const int x = *rc::gen::inRange(0, 37);
    const int y = *rc::gen::inRange(0, 6);
    const PixelViewport part{x, y, *rc::gen::inRange(1, 38 - x), *rc::gen::inRange(1, 7 - y)};
    const Image source = sampleImage(part, seed + 1);
    RC_ASSERT(merged(source, target) == mergedPlainly(source, target));
}

RC_GTEST_PROP(DepthMerge, IsAssociativeTiesIncluded, (std::uint32_t seed)) {
    const Image a = sampleImage(kWhole, seed);
    const Image b = sampleImage(kWhole, seed + 1);
    const Image c = sampleImage(kWhole, seed + 2);
    // `target` is the earlier range: (a b) c == a (b c).
    RC_ASSERT(merged(c, merged(b, a)) == merged(merged(c, b), a));
}

RC_GTEST_PROP(DepthMerge, TheRangeBeforeMayComeLater, (std::uint32_t seed)) {
    const Image a = sampleImage(kWhole, seed);
    Image b = sampleImage(kWhole, seed + 1);
    const Image expected = merged(b, a);
    mergeDepth(a, b, Ties::Source);
    RC_ASSERT(b == expected);
}

TEST(DepthMerge, OfEqualDepthsTheTargetStays) {
    const Image first = makeImage({0, 0, 9, 1}, {1, 1, 1, 255}, true);
    Image target = first;
    target.depth.assign(9, 0.5F);
    Image source = makeImage({0, 0, 9, 1}, {2, 2, 2, 255}, true);
    source.depth.assign(9, 0.5F);
    mergeDepth(source, target);
    EXPECT_EQ(target.colour, first.colour);
}

TEST(DepthMerge, TheLeastDifferenceOfDepthDecides) {
    Image target = makeImage({0, 0, 1, 1}, {1, 1, 1, 255}, true);
    target.depth[0] = 1e-30F;
    Image source = makeImage({0, 0, 1, 1}, {2, 2, 2, 255}, true);
    source.depth[0] = std::nextafter(1e-30F, 1.0F);
    mergeDepth(source, target);
    EXPECT_EQ(target.colour[0].r, 2);
}

}  // namespace
}  // namespace eyrie::fabric
