// SPDX-License-Identifier: Apache-2.0
#include "wire/connections.h"

#include <gtest/gtest.h>

#include "local_connection.h"

namespace eyrie::wire {
namespace {

TEST(Connections, AreThoseThatWereAcceptedAtThePorts) {
    const LocalConnection one(2);
    const LocalConnection other;
    const Connections expected{{one.server(), {"127.0.0.2", false}}};
    EXPECT_EQ(connectionsAt({one.port()}), expected);
    one.shutServer();
    EXPECT_EQ(connectionsAt({one.port()}).at(one.server()), (Connection{"127.0.0.2", true}));
    EXPECT_TRUE(connectionsAt({}).empty());
}

TEST(Connections, ThatWereResetAreShutAndTheSystemHasForgottenThePeer) {
    LocalConnection one;
    one.reset();
    EXPECT_EQ(connectionsAt({one.port()}).at(one.server()), (Connection{"", true}));
}

TEST(PeerOfShut, IsKnownFromBeforeItHungUp) {
    LocalConnection one(2);
    const LocalConnection bystander(3);
    const std::set<std::uint16_t> ports{one.port(), bystander.port()};
    const Connections before = connectionsAt(ports);
    EXPECT_EQ(peerOfShut(before, before), std::nullopt);
    one.shutServer();
    EXPECT_EQ(peerOfShut(before, connectionsAt(ports)), "127.0.0.2");
    one.reset();
    EXPECT_EQ(peerOfShut(before, connectionsAt(ports)), "127.0.0.2");
    EXPECT_EQ(peerOfShut({}, connectionsAt(ports)), std::nullopt) << "nobody knows it";
}

TEST(PeerOfShut, IsNobodyWhereSeveralCouldBeMeant) {
    const LocalConnection one(2);
    const LocalConnection another(2);
    const LocalConnection third(3);
    const std::set<std::uint16_t> ports{one.port(), another.port(), third.port()};
    const Connections before = connectionsAt(ports);
    one.shutServer();
    another.shutServer();
    EXPECT_EQ(peerOfShut(before, connectionsAt(ports)), "127.0.0.2") << "both are of one host";
    third.shutServer();
    EXPECT_EQ(peerOfShut(before, connectionsAt(ports)), std::nullopt);
}

}  // namespace
}  // namespace eyrie::wire
