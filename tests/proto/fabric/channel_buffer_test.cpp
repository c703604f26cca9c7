// SPDX-License-Identifier: Apache-2.0
#include "fabric/channel_buffer.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "fabric/depth_merge.h"
#include "sample_images.h"

namespace eyrie::fabric {
namespace {

constexpr PixelViewport kWhole{2, 1, 30, 8};
constexpr Rgba kBackground{1, 2, 3, 255};

PixelViewport anyPart(const PixelViewport& whole) {
    const int x = *rc::gen::inRange(0, whole.width);
    const int y = *rc::gen::inRange(0, whole.height);
    return {whole.x + x, whole.y + y, *rc::gen::inRange(1, whole.width - x + 1),
            *rc::gen::inRange(1, whole.height - y + 1)};
}

/// Random pixels, background where nothing was drawn.
Image sample(const PixelViewport& area, std::uint32_t seed) {
    Image image = sampleImage(area, seed);
    for (std::size_t i = 0; i < image.colour.size(); ++i)
        if (image.depth[i] == 0)
            image.colour[i] = kBackground;
    return image;
}

Image widened(const Image& image, const PixelViewport& area, bool withDepth) {
    Image wide = makeImage(area, kBackground, withDepth);
    paste(image, wide);
    return wide;
}

/// As a whole framebuffer does it.
void putPlainly(const Image& image, const PixelViewport& whole, Merge merge, Image& buffer) {
    if (merge == Merge::Paste)
        paste(widened(image, whole, buffer.hasDepth()), buffer);
    else
        mergeDepth(image, buffer, merge == Merge::DepthBefore ? Ties::Source : Ties::Target);
}

RC_GTEST_PROP(ChannelBuffer, IsAFramebufferOfTheWhole, (std::uint32_t seed)) {
    ChannelBuffer buffer(kWhole, kBackground, true);
    Image plain = makeImage(kWhole, kBackground, true);
    for (std::uint32_t left = *rc::gen::inRange(0U, 5U); left > 0; --left) {
        const PixelViewport whole = anyPart(kWhole);
        const Image image = sample(anyPart(whole), seed + left);
        const Merge merge = *rc::gen::element(Merge::Paste, Merge::DepthBehind, Merge::DepthBefore);
        buffer.put(image, whole, merge);
        putPlainly(image, whole, merge, plain);
    }
    const PixelViewport part = anyPart(kWhole);
    Image expected = makeImage(kWhole, kBackground, true);
    for (std::size_t i = 0; i < expected.colour.size(); ++i) {
        const auto at = static_cast<int>(i);
        if (!part.contains({kWhole.x + at % kWhole.width, kWhole.y + at / kWhole.width, 1, 1}))
            continue;
        expected.colour[i] = plain.colour[i];
        expected.depth[i] = plain.depth[i];
    }
    RC_ASSERT(widened(buffer.part(part, true), kWhole, true) == expected);
    expected.depth.clear();
    RC_ASSERT(widened(buffer.part(part, false), kWhole, false) == expected);
}

TEST(ChannelBuffer, HoldsNoMoreThanWasDrawn) {
    ChannelBuffer buffer(kWhole, kBackground, true);
    EXPECT_TRUE(buffer.part(kWhole, true).area.isEmpty());
    buffer.put(sample({5, 3, 4, 2}, 1), kWhole, Merge::Paste);
    buffer.put(sample({7, 2, 4, 2}, 2), kWhole, Merge::DepthBehind);
    EXPECT_EQ(buffer.part(kWhole, false).area, (PixelViewport{5, 2, 6, 3}));
    EXPECT_EQ(buffer.part({0, 0, 6, 4}, true).area, (PixelViewport{5, 2, 1, 2}));
}

}  // namespace
}  // namespace eyrie::fabric
