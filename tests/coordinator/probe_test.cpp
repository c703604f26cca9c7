// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/probe.h"

#include <gmock/gmock.h>

#include "tests/coordinator/http_server_fixture.h"

namespace eyrie::http {
namespace {

/// A server for its own machine turns away who asks for another host than it has.
TEST_F(HttpServer, IsProbedUnderItsIpv6AddressAsUrlsHaveIt) {
    ServerOptions options;
    options.host = "::1";
    options.port = 0;
    options.webFolder = web_.path();
    auto server = Server::start(options, frames_);
    if (!server.ok())
        GTEST_SKIP() << server.status();
    server_ = *std::move(server);
    Probed probed{.host = "::1", .port = port(), .path = "/"};
    const std::chrono::seconds limit(20);
    EXPECT_TRUE(probe(probed, limit).ok()) << probe(probed, limit);
    probed.path = "/nowhere";
    EXPECT_THAT(std::string(probe(probed, limit).message()),
                testing::HasSubstr("http://" + hostAndPort() + "/nowhere: it answers 404"));
}

}  // namespace
}  // namespace eyrie::http
