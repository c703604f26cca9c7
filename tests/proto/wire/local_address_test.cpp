// SPDX-License-Identifier: Apache-2.0
#include "wire/local_address.h"

#include <gtest/gtest.h>

namespace eyrie::wire {
namespace {

TEST(LocalAddress, OnlyThisMachineReachesIt) {
    for (const char* local :
         {"unix:/run/r0", "127.0.0.1:1", "127.9.9.9:1", "localhost:1", "[::1]:1"})
        EXPECT_TRUE(isLocal(local) && leadsToOwnMachine(local)) << local;
    for (const char* far : {"10.0.0.7:1", "[2001:db8::7]:1", "viz:1", "localhost.example:1"})
        EXPECT_FALSE(isLocal(far) || leadsToOwnMachine(far)) << far;
}

TEST(LocalAddress, WhatListensEverywhereIsReachedByOthersButNotBySuchAnAddress) {
    for (const char* every : {"0.0.0.0:1", "[::]:1"}) {
        EXPECT_FALSE(isLocal(every)) << every;
        EXPECT_TRUE(leadsToOwnMachine(every)) << every;
    }
}

}  // namespace
}  // namespace eyrie::wire
