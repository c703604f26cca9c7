// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/least_memory.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace eyrie::draw {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string refusal(const MemoryUse& share, std::uint64_t textureBytes = 0) {
    const absl::Status status = checkHolds(share, {100, 50}, "m.eym", textureBytes);
    EXPECT_TRUE(absl::IsResourceExhausted(status)) << status;
    return std::string(status.message());
}

TEST(LeastMemory, IsEnough) { EXPECT_TRUE(checkHolds({100, 50}, {100, 50}, "m.eym").ok()); }

TEST(LeastMemory, NamesTheLimitThatIsShortAndNoOther) {
    EXPECT_THAT(refusal({99, 50}), AllOf(HasSubstr("m.eym: it needs 100 bytes on the device"),
                                         HasSubstr("is 99; raise --memory,"),
                                         Not(HasSubstr("host")), Not(HasSubstr("textures"))));
    EXPECT_THAT(refusal({1000, 49}),
                AllOf(HasSubstr("need 50 bytes on the host"),
                      HasSubstr("is 49; raise --host-memory,"), Not(HasSubstr("1000"))));
}

TEST(LeastMemory, TellsOfTexturesWithTheShareAsItWasGiven) {
    EXPECT_THAT(refusal({99, 50}, 30),
                AllOf(HasSubstr("70 bytes on the device at least beside 30"), HasSubstr("is 99;")));
}

}  // namespace
}  // namespace eyrie::draw
