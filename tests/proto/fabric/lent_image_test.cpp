// SPDX-License-Identifier: Apache-2.0
#include "fabric/lent_image.h"

#include <memory>
#include <utility>

#include <gtest/gtest.h>

namespace eyrie::fabric {
namespace {

Image picture(std::uint8_t red) { return makeImage({3, 4, 5, 2}, {red, 0, 0, 255}, true); }

TEST(LentImage, OnesOwnIsMovedNotCopied) {
    Image image = picture(1);
    const Rgba* const pixels = image.colour.data();
    LentImage own(std::move(image));
    EXPECT_EQ(own.view().colour.data(), pixels);
    EXPECT_TRUE(own.hasDepth());
    EXPECT_EQ(std::move(own.own()).colour.data(), pixels);
}

TEST(LentImage, WhatIsLentIsReadWhereItLiesUntilItIsChanged) {
    const auto lender = std::make_shared<Image>(picture(1));
    LentImage lent(*lender, lender);
    LentImage copy = lent;
    EXPECT_EQ(lent.view().colour.data(), lender->colour.data());
    EXPECT_EQ(lent.area(), lender->area);
    EXPECT_EQ(lender.use_count(), 3);
    lent.own().colour[0].g = 9;
    EXPECT_EQ(lender.use_count(), 2);
    EXPECT_EQ(lender->colour[0].g, 0);
    EXPECT_EQ(copy.view().colour.data(), lender->colour.data());
    copy = {};
    EXPECT_EQ(lender.use_count(), 1);
}

TEST(LentImage, WhatWasCopiedStaysWhateverIsWrittenAfterwards) {
    const auto lender = std::make_shared<Image>(picture(1));
    LentImage lent(*lender, lender);
    const Image taken = std::move(lent.own());
    *lender = picture(2);
    EXPECT_TRUE(taken == picture(1));
}

TEST(LentImage, NoneIsEmpty) {
    LentImage none;
    EXPECT_TRUE(none.isEmpty());
    EXPECT_FALSE(none.hasDepth());
    EXPECT_TRUE(none.own() == Image{});
}

}  // namespace
}  // namespace eyrie::fabric
