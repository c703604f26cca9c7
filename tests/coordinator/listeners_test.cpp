// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/listeners.h"

#include <atomic>

#include <gtest/gtest.h>

#include "tests/service/eventually.h"

namespace eyrie::coordinator {
namespace {

TEST(Listeners, EachIsCalledUntilItIsRemoved) {
    Listeners listeners;
    int first = 0;
    int second = 0;
    const int handle = listeners.add([&] { ++first; });
    listeners.add([&] { ++second; });
    listeners.notify();
    listeners.remove(handle);
    listeners.notify();
    EXPECT_EQ(first, 1);
    EXPECT_EQ(second, 2);
}

TEST(Listeners, OneMayRemoveItself) {
    Listeners listeners;
    int calls = 0;
    int handle = 0;
    handle = listeners.add([&] {
        ++calls;
        listeners.remove(handle);
    });
    listeners.notify();
    listeners.notify();
    EXPECT_EQ(calls, 1);
}

TEST(Listeners, RemoveWaitsForTheCallInProgress) {
    Listeners listeners;
    std::atomic<bool> inside{false};
    std::atomic<bool> mayLeave{false};
    std::atomic<bool> left{false};
    const int handle = listeners.add([&] {
        inside = true;
        eventually([&] { return mayLeave.load(); });
        left = true;
    });
    std::jthread notifier([&] { listeners.notify(); });
    ASSERT_TRUE(eventually([&] { return inside.load(); }));
    std::jthread releaser([&] { mayLeave = true; });
    listeners.remove(handle);
    EXPECT_TRUE(left);
}

}  // namespace
}  // namespace eyrie::coordinator
