// SPDX-License-Identifier: Apache-2.0
#include "fabric/image.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "sample_images.h"

namespace eyrie::fabric {
namespace {

PixelViewport anyPartOf(const PixelViewport& whole) {
    const int x = *rc::gen::inRange(0, whole.width + 1);
    const int y = *rc::gen::inRange(0, whole.height + 1);
    return {whole.x + x, whole.y + y, *rc::gen::inRange(0, whole.width - x + 1),
            *rc::gen::inRange(0, whole.height - y + 1)};
}

RC_GTEST_PROP(Image, PastingACropBackChangesNothing, (std::uint32_t seed)) {
    const Image image = sampleImage({3, 5, 17, 9}, seed);
    const Image part = crop(image, anyPartOf(image.area));
    Image copy = image;
    paste(part, copy);
    RC_ASSERT(copy == image);
}

RC_GTEST_PROP(Image, NothingIsDrawnOutsideTheCoveredArea, (std::uint32_t seed)) {
    Image image = makeImage({3, 5, 17, 9}, {}, true);
    const Image drawn = sampleImage(anyPartOf(image.area), seed);
    paste(drawn, image);
    const PixelViewport covered = coveredArea(image);
    Image restored = makeImage(image.area, {}, true);
    paste(crop(image, covered), restored);
    RC_ASSERT(restored.depth == image.depth);
}

TEST(Image, TheCoveredAreaIsTight) {
    Image image = makeImage({10, 20, 8, 6}, {}, true);
    EXPECT_TRUE(coveredArea(image).isEmpty());
    image.depth[1 * 8 + 2] = 0.5F;
    EXPECT_EQ(coveredArea(image), (PixelViewport{12, 21, 1, 1}));
    image.depth[4 * 8 + 7] = 0.25F;
    EXPECT_EQ(coveredArea(image), (PixelViewport{12, 21, 6, 4}));
    image.depth[2 * 8 + 0] = 0.25F;
    EXPECT_EQ(coveredArea(image), (PixelViewport{10, 21, 8, 4}));
}

TEST(Image, PastingWithoutDepthLeavesDepthAlone) {
    Image target = sampleImage({0, 0, 4, 4}, 7);
    const std::vector<float> before = target.depth;
    paste(makeImage({1, 1, 2, 2}, {9, 9, 9, 255}, false), target);
    EXPECT_EQ(target.depth, before);
    EXPECT_EQ(target.colour[5], (Rgba{9, 9, 9, 255}));
}

}  // namespace
}  // namespace eyrie::fabric
