// SPDX-License-Identifier: Apache-2.0
#include "access/gate.h"

#include <string>

#include <gtest/gtest.h>

namespace eyrie::access {
namespace {

using std::chrono::hours;
using std::chrono::seconds;

const std::string kView = "Bearer view-0123456789abcdef0123456789";
const std::string kAdmin = "bearer  admin-0123456789abcdef0123456789";
const Gate::Clock::time_point kNow{hours(500'000)};

Gate gate() {
    return Gate(
        *Tokens::parse("view view-0123456789abcdef0123456789\n"
                       "admin admin-0123456789abcdef0123456789\n",
                       "t"));
}

TEST(Gate, LetsInWhoMayDoWhatIsAsked) {
    Gate door = gate();
    EXPECT_EQ(*door.admit({kView, ""}, "10.0.0.1", Role::View, kNow), Role::View);
    EXPECT_EQ(*door.admit({kAdmin, ""}, "10.0.0.1", Role::View, kNow), Role::Admin);
    EXPECT_TRUE(absl::IsPermissionDenied(
        door.admit({kView, ""}, "10.0.0.1", Role::Control, kNow).status()));
    EXPECT_TRUE(
        absl::IsUnauthenticated(door.admit({"", ""}, "10.0.0.1", Role::View, kNow).status()));
    for (const std::string wrong :
         {"Bearer wrong-0123456789abcdef0123456789", "Basic dmlldzp2aWV3", "Bearer", "Bearer ",
          "view-0123456789abcdef0123456789", "Bearer view-0123456789abcdef0123456789 x"})
        EXPECT_TRUE(
            absl::IsUnauthenticated(door.admit({wrong, ""}, "10.0.0.1", Role::View, kNow).status()))
            << wrong;
    EXPECT_EQ(door.refusals(Door::Http), (Refusals{1, 6, 0, 1}));
    EXPECT_EQ(door.refusals(Door::Grpc), Refusals());
    EXPECT_FALSE(door.admit({"Bearer x", "", Door::Grpc}, "10.0.0.1", Role::View, kNow).ok());
    EXPECT_EQ(door.refusals(Door::Grpc), (Refusals{0, 1, 0, 0}));
    EXPECT_EQ(door.roleOf({"Bearer x", ""}, kNow), std::nullopt);
    EXPECT_EQ(door.roleOf({kView, ""}, kNow), Role::View);
    EXPECT_EQ(door.refusals(Door::Http), (Refusals{1, 6, 0, 1})) << "nobody asked to come in";
}

TEST(Gate, TicketsLastForHours) {
    Gate door = gate();
    const std::string ticket = Gate::ticketFor(kView, kNow);
    EXPECT_EQ(*door.admit({"", ticket}, "10.0.0.1", Role::View, kNow + hours(11)), Role::View);
    EXPECT_TRUE(absl::IsUnauthenticated(
        door.admit({"", ticket}, "10.0.0.1", Role::View, kNow + hours(13)).status()));
    EXPECT_TRUE(absl::IsUnauthenticated(
        door.admit({kView + "x", ticket}, "10.0.0.1", Role::View, kNow).status()))
        << "a wrong token is wrong, whatever else comes with it";
}

TEST(Gate, LimitsWrongTokensOfAnAddressAndOfNobodyElse) {
    Gate door = gate();
    const auto guess = [&](std::string_view address, Gate::Clock::time_point now) {
        return door.admit({"Bearer 0123456789abcdef0123456789", ""}, address, Role::View, now)
            .status();
    };
    for (int i = 0; i < Gate::kMaxWrong; ++i)
        EXPECT_TRUE(absl::IsUnauthenticated(guess("10.0.0.1", kNow)));
    for (int i = 0; i < 100; ++i)
        EXPECT_TRUE(absl::IsResourceExhausted(guess("10.0.0.1", kNow + seconds(59))));
    EXPECT_TRUE(absl::IsUnauthenticated(guess("10.0.0.2", kNow)));
    EXPECT_TRUE(door.admit({kView, ""}, "10.0.0.1", Role::View, kNow).ok());
    EXPECT_TRUE(absl::IsUnauthenticated(guess("10.0.0.1", kNow + seconds(60))));
    EXPECT_TRUE(absl::IsUnauthenticated(guess("10.0.0.1", kNow - hours(1))))
        << "the clock was put back";
    EXPECT_EQ(door.refusals(Door::Http).limited, 100u);
}

TEST(Gate, RemembersABoundedNumberOfAddresses) {
    Gate door = gate();
    for (int i = 0; i < 5000; ++i)
        EXPECT_TRUE(absl::IsUnauthenticated(
            door.admit({"Bearer x", ""}, std::to_string(i), Role::View, kNow + seconds(i % 7))
                .status()));
    EXPECT_EQ(door.refusals(Door::Http).wrong, 5000u);
}

}  // namespace
}  // namespace eyrie::access
