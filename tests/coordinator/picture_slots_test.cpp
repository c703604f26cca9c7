// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/picture_slots.h"

#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace eyrie::coordinator {
namespace {

TEST(PictureSlots, WhatWasGivenBackIsLentAgain) {
    PictureSlots slots("fake");
    auto memory = slots.lend(1000);
    ASSERT_NE(memory, nullptr);
    EXPECT_GE(memory->offer().bytes, 1000U);
    const std::string key = memory->offer().key;
    slots.giveBack(std::move(memory), true);
    EXPECT_EQ(slots.lend(900)->offer().key, key);
}

TEST(PictureSlots, TwoThatAreLentAtOnceAreNotTheSame) {
    PictureSlots slots("fake");
    const auto one = slots.lend(1000);
    const auto other = slots.lend(1000);
    EXPECT_NE(one->offer().key, other->offer().key);
    EXPECT_NE(one->offer().descriptor, other->offer().descriptor);
}

TEST(PictureSlots, OneWhosePictureIsStillReadIsLentOnlyAfterwards) {
    const auto slots = std::make_shared<PictureSlots>("fake");
    auto memory = slots->lend(1000);
    const std::string key = memory->offer().key;
    auto read = slots->giveBackLater(std::move(memory));
    auto readToo = read;
    EXPECT_NE(slots->lend(1000)->offer().key, key);
    read = nullptr;
    EXPECT_NE(slots->lend(1000)->offer().key, key);
    readToo = nullptr;
    EXPECT_EQ(slots->lend(1000)->offer().key, key);
}

TEST(PictureSlots, APictureThatIsReadIsThereWhenTheyAreGone) {
    auto slots = std::make_shared<PictureSlots>("fake");
    auto memory = slots->lend(16);
    const wire::MemoryOffer offer = memory->offer();
    auto read = slots->giveBackLater(std::move(memory));
    slots = nullptr;
    EXPECT_TRUE(wire::PictureMemory::open(offer).ok());
    read = nullptr;
    EXPECT_FALSE(wire::PictureMemory::open(offer).ok());
}

TEST(PictureSlots, OneThatIsNotGivenBackIsNeverLentAgain) {
    PictureSlots slots("fake");
    const std::string key = slots.lend(1000)->offer().key;  // and the call failed
    for (int i = 0; i < 5; ++i) {
        auto memory = slots.lend(1000);
        EXPECT_NE(memory->offer().key, key);
        slots.giveBack(std::move(memory), true);
    }
}

TEST(PictureSlots, ALargerPictureGetsALargerOneAndAMuchSmallerAnotherToo) {
    PictureSlots slots("fake");
    slots.giveBack(slots.lend(1000), true);
    auto larger = slots.lend(100'000);
    EXPECT_GE(larger->offer().bytes, 100'000U);
    slots.giveBack(std::move(larger), true);
    EXPECT_LT(slots.lend(1000)->offer().bytes, 100'000U);
}

TEST(PictureSlots, ARendererThatCannotUseThemIsOfferedNoMore) {
    PictureSlots slots("fake");
    slots.giveBack(slots.lend(1000), true);
    slots.giveBack(slots.lend(1000), false);
    EXPECT_EQ(slots.lend(1000), nullptr);
}

TEST(PictureSlots, NothingIsLentForNoPixelsOrTooMany) {
    PictureSlots slots("fake");
    EXPECT_EQ(slots.lend(0), nullptr);
    EXPECT_EQ(slots.lend(wire::PictureMemory::kMaxBytes + 1), nullptr);
    EXPECT_NE(slots.lend(1), nullptr);
}

}  // namespace
}  // namespace eyrie::coordinator
