// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/reachable_address.h"

#include <gtest/gtest.h>

namespace eyrie::coordinator {
namespace {

TEST(ReachableAddress, AWildcardHostBecomesThePeers) {
    EXPECT_EQ(reachableAddress("0.0.0.0:5000", "ipv4:10.0.0.7:41234"), "10.0.0.7:5000");
    EXPECT_EQ(reachableAddress("[::]:5000", "ipv6:%5B2001:db8::7%5D:41234"), "[2001:db8::7]:5000");
    EXPECT_EQ(reachableAddress("[::]:5000", "ipv4:10.0.0.7:41234"), "10.0.0.7:5000");
}

TEST(ReachableAddress, EveryOtherAddressStays) {
    EXPECT_EQ(reachableAddress("render3:5000", "ipv4:10.0.0.7:41234"), "render3:5000");
    EXPECT_EQ(reachableAddress("unix:/run/r0", "ipv4:10.0.0.7:41234"), "unix:/run/r0");
    EXPECT_EQ(reachableAddress("0.0.0.0:5000", "unix:"), "0.0.0.0:5000");
    EXPECT_EQ(reachableAddress("", ""), "");
}

}  // namespace
}  // namespace eyrie::coordinator
