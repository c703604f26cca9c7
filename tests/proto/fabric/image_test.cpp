// SPDX-License-Identifier: Apache-2.0
#include "fabric/image.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "sample_images.h"

namespace eyrie::fabric {
namespace {

RC_GTEST_PROP(Image, PastingReplacesThatPartAndNothingElse, (std::uint32_t seed)) {
    const Image before = sampleImage({3, 5, 17, 9}, seed);
    const PixelViewport& whole = before.area;
    const int x = *rc::gen::inRange(0, whole.width + 1);
    const int y = *rc::gen::inRange(0, whole.height + 1);
    const Image part =
        sampleImage({whole.x + x, whole.y + y, *rc::gen::inRange(0, whole.width - x + 1),
                     *rc::gen::inRange(0, whole.height - y + 1)},
                    seed + 1);
    Image image = before;
    paste(part, image);
    for (int row = 0; row < whole.height; ++row)
        for (int column = 0; column < whole.width; ++column) {
            const PixelViewport pixel{whole.x + column, whole.y + row, 1, 1};
            const bool inPart = part.area.contains(pixel);
            const Image& source = inPart ? part : before;
            const auto from = static_cast<std::size_t>(
                (pixel.y - source.area.y) * source.area.width + pixel.x - source.area.x);
            const auto at = static_cast<std::size_t>(row * whole.width + column);
            RC_ASSERT(image.colour[at] == source.colour[from]);
            RC_ASSERT(image.depth[at] == source.depth[from]);
        }
}

TEST(Image, PastingWithoutDepthLeavesDepthAlone) {
    Image target = sampleImage({0, 0, 4, 4}, 7);
    const std::vector<float> before = target.depth;
    paste(makeImage({1, 1, 2, 2}, {9, 9, 9, 255}, false), target);
    EXPECT_EQ(target.depth, before);
    EXPECT_EQ(target.colour[5], (Rgba{9, 9, 9, 255}));
}

TEST(Image, OfAnEmptyOneNothingIsPastedWhereverItLies) {
    Image target = sampleImage({3, 2, 4, 4}, 7);
    const Image before = target;
    paste(Image{}, target);
    EXPECT_EQ(target, before);
}

}  // namespace
}  // namespace eyrie::fabric
