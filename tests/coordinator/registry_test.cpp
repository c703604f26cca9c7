// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/registry.h"

#include <gtest/gtest.h>

namespace eyrie::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const Registry::Clock::time_point kStart{};

class RegistryTest : public testing::Test {
protected:
    RegistryTest() {
        registry_.listeners().add([this] { ++changes_; });
    }
    std::string add(const std::string& address, Registry::Clock::time_point now = kStart) {
        return registry_.add(address, {}, nullptr, now).value();
    }
    bool isAlive(const std::string& id) const {
        for (const Registry::Entry& entry : registry_.entries())
            if (entry.id == id)
                return entry.alive;
        return false;
    }

    Registry registry_;
    int changes_ = 0;
};

TEST_F(RegistryTest, ARendererIsAliveWhileItsHeartbeatsCome) {
    const std::string id = add("a:1");
    for (int i = 1; i < 20; ++i) {
        ASSERT_TRUE(registry_.heartbeat(id, kStart + seconds(i)).ok());
        registry_.expire(kStart + seconds(i) + milliseconds(900));
    }
    EXPECT_TRUE(isAlive(id));
}

TEST_F(RegistryTest, ThreeMissedHeartbeatsAreDeath) {
    const std::string id = add("a:1");
    registry_.expire(kStart + milliseconds(3000));
    EXPECT_TRUE(isAlive(id));
    registry_.expire(kStart + milliseconds(3001));
    EXPECT_FALSE(isAlive(id));
}

TEST_F(RegistryTest, ADeadRenderersHeartbeatSaysToRegisterAgain) {
    const std::string id = add("a:1");
    registry_.markDead(id, "test", kStart);
    EXPECT_EQ(registry_.heartbeat(id, kStart).code(), absl::StatusCode::kNotFound);
    EXPECT_EQ(registry_.heartbeat("stranger", kStart).code(), absl::StatusCode::kNotFound);
    const std::string again = add("a:1");
    EXPECT_NE(again, id);
    EXPECT_TRUE(isAlive(again));
    EXPECT_EQ(registry_.entries().size(), 1U);
}

TEST_F(RegistryTest, TheDeadAreListedForAMinute) {
    registry_.markDead(add("a:1"), "test", kStart);
    registry_.expire(kStart + seconds(60));
    EXPECT_EQ(registry_.entries().size(), 1U);
    registry_.expire(kStart + seconds(61));
    EXPECT_TRUE(registry_.entries().empty());
}

TEST_F(RegistryTest, ListenersHearOfChangesAndOfNothingElse) {
    const std::string id = add("a:1");
    EXPECT_EQ(changes_, 1);
    ASSERT_TRUE(registry_.heartbeat(id, kStart + seconds(1)).ok());
    registry_.expire(kStart + seconds(2));
    EXPECT_EQ(changes_, 1);
    registry_.expire(kStart + seconds(9));
    EXPECT_EQ(changes_, 2);
    registry_.markDead(id, "again", kStart + seconds(9));
    EXPECT_EQ(changes_, 2);
}

TEST(Registry, TheNumberOfLivingRenderersIsBounded) {
    RegistryOptions options;
    options.maxRenderers = 2;
    Registry registry(options);
    const std::string first = registry.add("a:1", {}, nullptr, kStart).value();
    ASSERT_TRUE(registry.add("a:2", {}, nullptr, kStart).ok());
    EXPECT_EQ(registry.add("a:3", {}, nullptr, kStart).status().code(),
              absl::StatusCode::kResourceExhausted);
    registry.markDead(first, "test", kStart);
    EXPECT_TRUE(registry.add("a:3", {}, nullptr, kStart).ok());
}

}  // namespace
}  // namespace eyrie::coordinator
