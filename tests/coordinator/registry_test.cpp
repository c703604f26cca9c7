// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/registry.h"

#include <gtest/gtest.h>

#include "tests/support/captured_log.h"

namespace eyrie::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const Registry::Clock::time_point kStart{};

RegistryOptions everySecond() {
    RegistryOptions options;
    options.heartbeatInterval = seconds(1);
    options.missedHeartbeats = 3;
    return options;
}

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
                return entry.isAlive();
        return false;
    }

    Registry registry_{everySecond()};
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

TEST_F(RegistryTest, WhoseAddressAnotherTakesIsNotToTakeItBack) {
    const std::string first = add("a:1");
    const std::string second = add("a:1");
    const absl::Status displaced = registry_.heartbeat(first, kStart);
    EXPECT_TRUE(absl::IsFailedPrecondition(displaced)) << displaced;
    EXPECT_EQ(displaced.message(),
              "another renderer has registered at a:1; give each its own --listen");
    EXPECT_TRUE(registry_.heartbeat(second, kStart).ok());
    registry_.markDead(second, "test", kStart);
    add("a:1");
    EXPECT_TRUE(absl::IsNotFound(registry_.heartbeat(second, kStart))) << "its place was free";
}

TEST_F(RegistryTest, TheLatestSixtyFourWhosePlaceWasTakenAreRemembered) {
    const std::string first = add("a:1");
    const std::string second = add("a:1");
    for (int i = 0; i < 64; ++i) add("a:1");
    EXPECT_TRUE(absl::IsNotFound(registry_.heartbeat(first, kStart)));
    EXPECT_TRUE(absl::IsFailedPrecondition(registry_.heartbeat(second, kStart)));
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
    for (int i = 3; i <= 9; ++i) registry_.expire(kStart + seconds(i));
    EXPECT_EQ(changes_, 2);
    registry_.markDead(id, "again", kStart + seconds(9));
    EXPECT_EQ(changes_, 2);
}

TEST_F(RegistryTest, TimeInWhichNobodyLookedIsNobodysSilence) {
    const std::string id = add("a:1");
    registry_.expire(kStart);
    registry_.expire(kStart + seconds(100));  // the coordinator was stopped
    EXPECT_TRUE(isAlive(id));
    for (int i = 1; i <= 5; ++i) registry_.expire(kStart + seconds(100 + i));
    EXPECT_FALSE(isAlive(id));
}

TEST_F(RegistryTest, OneThatDrainsIsAliveUntilItIsRemoved) {
    const std::string id = add("a:1");
    EXPECT_TRUE(registry_.drain(id, kStart).ok());
    EXPECT_TRUE(registry_.drain(id, kStart + seconds(2)).ok());
    EXPECT_EQ(changes_, 2);
    EXPECT_EQ(registry_.entries().at(0).presence, Registry::Presence::Draining);
    registry_.expire(kStart + seconds(3));  // asking to leave is a sign of life
    registry_.expire(kStart + seconds(4));
    EXPECT_TRUE(isAlive(id));
    registry_.remove(id);
    EXPECT_TRUE(registry_.entries().empty());
    EXPECT_EQ(registry_.drain(id, kStart).code(), absl::StatusCode::kNotFound);
}

TEST_F(RegistryTest, TheRefusedAreListedWithTheReasonForAMinute) {
    registry_.refuse("a:1", {}, "too old", kStart);
    registry_.refuse("a:1", {}, "still too old", kStart + seconds(1));
    ASSERT_EQ(registry_.entries().size(), 1U);
    const Registry::Entry refused = registry_.entries()[0];
    EXPECT_EQ(refused.presence, Registry::Presence::Refused);
    EXPECT_EQ(refused.why, "still too old");
    EXPECT_FALSE(refused.isAlive());
    registry_.expire(kStart + seconds(62));
    EXPECT_TRUE(registry_.entries().empty());
}

TEST_F(RegistryTest, OneThatIsRefusedAgainAndAgainIsToldToTheLogOnce) {
    const test::CapturedLog log;
    for (int i = 0; i < 5; ++i) registry_.refuse("a:1", {}, "too old", kStart + seconds(i));
    EXPECT_EQ(log.lines(), 1) << log.text();
    registry_.refuse("a:1", {}, "too new", kStart + seconds(5));
    registry_.refuse("a:2", {}, "too old", kStart + seconds(5));
    EXPECT_EQ(log.lines(), 3) << log.text();
    registry_.expire(kStart + seconds(70));
    registry_.refuse("a:1", {}, "too new", kStart + seconds(70));
    EXPECT_EQ(log.lines(), 4) << log.text();
}

TEST_F(RegistryTest, ARefusalTakesNobodysPlace) {
    const std::string id = add("a:1");
    registry_.refuse("a:1", {}, "too old", kStart);
    EXPECT_TRUE(isAlive(id));
    registry_.refuse("a:2", {}, "too old", kStart);
    EXPECT_TRUE(isAlive(add("a:2")));
    EXPECT_EQ(registry_.entries().size(), 2U);
}

TEST_F(RegistryTest, AtMostSixteenRefusedAreListedTheLatest) {
    for (int i = 0; i < 40; ++i)
        registry_.refuse("a:" + std::to_string(i), {}, "too old", kStart + seconds(i));
    ASSERT_EQ(registry_.entries().size(), 16U);
    EXPECT_EQ(registry_.entries()[0].address, "a:24");
}

TEST(Registry, SilenceIsDeathWithinThreeSeconds) {
    Registry registry;
    ASSERT_TRUE(registry.add("a:1", {}, nullptr, kStart).ok());
    // As the coordinator looks: four times a heartbeat.
    for (auto now = kStart; now <= kStart + seconds(3);
         now += registry.options().heartbeatInterval / 4)
        registry.expire(now);
    EXPECT_FALSE(registry.entries().at(0).isAlive());
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
