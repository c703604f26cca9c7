// SPDX-License-Identifier: Apache-2.0
#include "wire/handshake_log.h"

#include <string>

#include <gmock/gmock.h>

#include "local_connection.h"

namespace eyrie::wire {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// As gRPC 1.51 says it.
constexpr char kWrongVersion[] =
    "UNKNOWN:Tls handshake failed: SSL_ERROR_SSL: error:0A00010B:SSL routines::wrong version "
    "number {file:\"./src/core/lib/security/transport/security_handshaker.cc\", file_line:393, "
    "tsi_error:\"TSI_PROTOCOL_FAILURE\", tsi_code:10}";
constexpr char kHungUp[] =
    "UNKNOWN:Handshake read failed {file_line:487, children:[INTERNAL:Socket closed "
    "{target_address:\"ipv4:127.0.0.1:48670\", grpc_status:14, fd:8}]}";
constexpr char kTimedOut[] =
    "UNKNOWN:Handshake read failed {file_line:487, children:[UNKNOWN:FD Shutdown {file_line:200, "
    "children:[UNKNOWN:Handshake timed out {file_line:167}]}]}";
constexpr char kNoAlpn[] =
    "UNKNOWN:Cannot check peer: missing selected ALPN property. {file_line:146}";

constexpr char kBothEnds[] = "./src/core/lib/security/transport/security_handshaker.cc";
constexpr char kOurEnd[] = "./src/core/ext/transport/chttp2/server/chttp2_server.cc";

std::string atBothEnds(const std::string& error) { return "Security handshake failed: " + error; }
std::string atOurEnd(const std::string& error) { return "Handshaking failed: " + error; }

TEST(WhyHandshakeFailed, IsToldInFewWordsAndOnlyOfWhoWasRefused) {
    const auto why = [](const char* error) { return whyHandshakeFailed(error).value_or("none"); };
    EXPECT_EQ(why(kWrongVersion), "wrong version number");
    EXPECT_EQ(why(kTimedOut), "it was not finished in time");
    EXPECT_EQ(why(kNoAlpn), "Cannot check peer: missing selected ALPN property.");
    EXPECT_EQ(why(kHungUp), "none");
    EXPECT_EQ(why("UNKNOWN:Server shutdown {}"), "none");
    EXPECT_EQ(why(""), "none");
}

class HandshakeLogTest : public testing::Test {
protected:
    /// What is to be told of a handshake over `connection` that fails with `error`.
    std::optional<std::string> fail(const LocalConnection& connection,
                                    const std::string& error = kWrongVersion) {
        log_.watch(connection.port());
        EXPECT_EQ(log_.note(kBothEnds, atBothEnds(error), now_), std::nullopt);
        connection.shutServer();
        return log_.note(kOurEnd, atOurEnd(error), now_);
    }

    access::FailedHandshakes handshakes_;
    HandshakeLog log_{handshakes_};
    HandshakeLog::Clock::time_point now_{seconds(1000)};
};

TEST_F(HandshakeLogTest, CountsAndTellsWhoCouldNotConnectAndWhy) {
    EXPECT_THAT(
        fail(LocalConnection(2)).value_or(""),
        testing::StartsWith("no encrypted connection with 127.0.0.2: wrong version number"));
    EXPECT_EQ(fail(LocalConnection(2)), std::nullopt) << "within a minute";
    EXPECT_EQ(handshakes_.soFar(), 2U);
    EXPECT_EQ(fail(LocalConnection(3), kHungUp), std::nullopt);
    EXPECT_EQ(handshakes_.soFar(), 2U) << "who only looks whether the port is open";
}

TEST_F(HandshakeLogTest, IsSilentOnThisProcesssOwnConnectionsToOthersAndOnOtherLines) {
    const std::string ours = atOurEnd(kWrongVersion);
    EXPECT_EQ(log_.note(kBothEnds, atBothEnds(kWrongVersion), now_), std::nullopt);
    EXPECT_EQ(log_.note("./src/core/lib/surface/server.cc", ours, now_), std::nullopt);
    EXPECT_EQ(log_.note(kOurEnd, "Set up of transport failed: " + ours, now_), std::nullopt);
    EXPECT_EQ(handshakes_.soFar(), 0U);
}

TEST_F(HandshakeLogTest, LooksAFewTimesASecondAndCountsTheOthers) {
    int told = 0;
    const int tries = HandshakeLog::kMaxLooks + 3;
    for (int i = 0; i < tries; ++i)
        told += fail(LocalConnection(static_cast<std::uint8_t>(i + 1))).has_value() ? 1 : 0;
    EXPECT_EQ(told, HandshakeLog::kMaxLooks);
    EXPECT_EQ(handshakes_.soFar(), static_cast<std::uint64_t>(tries));
    now_ += milliseconds(1000);
    EXPECT_TRUE(fail(LocalConnection(100)).has_value());
}

}  // namespace
}  // namespace eyrie::wire
