// SPDX-License-Identifier: Apache-2.0
#include "access/failed_handshakes.h"

#include <string>

#include <gmock/gmock.h>

namespace eyrie::access {
namespace {

using std::chrono::seconds;

TEST(RareWarnings, AreOfEachAddressOnceAMinuteAndOfSoManyAddresses) {
    RareWarnings warnings;
    const RareWarnings::Clock::time_point now{seconds(1000)};
    EXPECT_TRUE(warnings.isDue("10.0.0.1", now));
    EXPECT_FALSE(warnings.isDue("10.0.0.1", now + seconds(59)));
    EXPECT_TRUE(warnings.isDue("10.0.0.2", now + seconds(59)));
    EXPECT_TRUE(warnings.isDue("10.0.0.1", now + seconds(60)));
    int due = 0;
    for (int i = 0; i < 5000; ++i) due += warnings.isDue(std::to_string(i), now + seconds(60));
    EXPECT_LE(due, static_cast<int>(RareWarnings::kMost));
}

TEST(FailedHandshakes, AreAllCountedAndToldOnceAMinuteAndAddress) {
    FailedHandshakes handshakes;
    const FailedHandshakes::Clock::time_point now{seconds(1000)};
    const auto tells = [&](const std::optional<std::string>& address, int second) {
        handshakes.count();
        return handshakes.warning(address, "why", now + seconds(second)).has_value();
    };
    EXPECT_TRUE(tells("10.0.0.1", 0));
    EXPECT_FALSE(tells("10.0.0.1", 59));
    EXPECT_TRUE(tells("10.0.0.2", 59));
    EXPECT_TRUE(tells(std::nullopt, 59));
    EXPECT_FALSE(tells(std::nullopt, 60)) << "all that have no name are one";
    EXPECT_TRUE(tells("10.0.0.1", 60));
    EXPECT_EQ(handshakes.soFar(), 6U);
}

TEST(FailedHandshakes, AreToldWithTheAddressAndTheReason) {
    FailedHandshakes handshakes;
    EXPECT_EQ(handshakes.warning("10.0.0.1", "http request\n", {}),
              "no encrypted connection with 10.0.0.1: http request\\x0a; more from there within a "
              "minute are not told");
    EXPECT_THAT(handshakes.warning(std::nullopt, "why", {}).value_or(""),
                testing::HasSubstr("with a peer that has hung up: why"));
}

}  // namespace
}  // namespace eyrie::access
