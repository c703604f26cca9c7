// SPDX-License-Identifier: Apache-2.0
#include "service/reply_slots.h"

#include <gtest/gtest.h>

namespace eyrie::service {
namespace {

TEST(ReplySlots, AreTakenUntilTheLastMessageHasBeenHandedOver) {
    ReplySlots slots;
    for (int i = 0; i < ReplySlots::kMaxOpen; ++i) {
        slots.open();
        EXPECT_TRUE(slots.check().ok());
    }
    slots.open();
    EXPECT_TRUE(absl::IsResourceExhausted(slots.check()));
    slots.leave(100);
    EXPECT_TRUE(slots.check().ok());
}

TEST(ReplySlots, AnswersThatLeaveAreBoundedByTheirBytesOnly) {
    ReplySlots slots;
    constexpr std::size_t kBytes = ReplySlots::kMaxLeavingBytes / 1000;
    for (int i = 0; i < 1000; ++i) {
        slots.open();
        ASSERT_TRUE(slots.check().ok()) << i;
        slots.leave(kBytes);
    }
    slots.open();
    slots.leave(ReplySlots::kMaxLeavingBytes);
    EXPECT_TRUE(absl::IsResourceExhausted(slots.check()));
    slots.close(ReplySlots::kMaxLeavingBytes);
    EXPECT_TRUE(slots.check().ok());
}

}  // namespace
}  // namespace eyrie::service
