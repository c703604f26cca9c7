// SPDX-License-Identifier: Apache-2.0
// Peers that gRPC's ports refuse before any call: plaintext ones, and those without a right
// certificate.
#include <array>
#include <functional>
#include <memory>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/write.hpp>
#include <gmock/gmock.h>

#include "access/failed_handshakes.h"
#include "coordinator/coordinator.h"
#include "service/gl_thread.h"
#include "service/render_server.h"
#include "tests/service/eventually.h"
#include "tests/service/fake_drawer.h"
#include "tests/support/certificates.h"

namespace eyrie {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

std::uint64_t failedSoFar() { return access::FailedHandshakes::atGrpcPorts().soFar(); }

/// Something that listens by gRPC.
struct Port {
    std::string address;
    std::shared_ptr<void> server;
};

using Start = std::function<Port(const wire::Security&)>;

Port startCoordinator(const wire::Security& security) {
    coordinator::CoordinatorOptions options;
    options.security = security;
    std::shared_ptr<coordinator::Coordinator> server =
        coordinator::Coordinator::start(options).value();
    return {server->grpcAddresses().front(), server};
}

Port startRenderer(const wire::Security& security) {
    struct Renderer {
        std::unique_ptr<service::GlThread> thread =
            service::GlThread::start(
                service::fakeDrawers(std::make_shared<service::FakeDrawerControl>()))
                .value();
        std::unique_ptr<service::RenderServer> server;
    };
    auto renderer = std::make_shared<Renderer>();
    renderer->server =
        service::RenderServer::start("127.0.0.1:0", *renderer->thread, security).value();
    return {renderer->server->address(), renderer};
}

tcp::socket connectTo(const Port& port, asio::io_context& io) {
    tcp::socket socket(io);
    const std::string number = port.address.substr(port.address.rfind(':') + 1);
    socket.connect(
        {asio::ip::make_address("127.0.0.1"), static_cast<std::uint16_t>(std::stoi(number))});
    return socket;
}

class GrpcHandshakes : public testing::TestWithParam<std::pair<std::string, Start>> {
protected:
    GrpcHandshakes() {
        wire::Security security;
        security.tls = authority_.issue("server");
        port_ = GetParam().second(security);
    }

    tcp::socket connect() { return connectTo(port_, io_); }

    /// Whether the server has anything to say to a client that shows `files`, and believes their
    /// authority.
    bool getsIn(const access::TlsFiles& files) {
        asio::ssl::context context(asio::ssl::context::tls_client);
        context.load_verify_file(files.authority);
        context.set_verify_mode(asio::ssl::verify_peer);
        if (!files.certificate.empty()) {
            context.use_certificate_chain_file(files.certificate);
            context.use_private_key_file(files.key, asio::ssl::context::pem);
        }
        constexpr std::array<unsigned char, 3> kHttp2{2, 'h', '2'};
        SSL_CTX_set_alpn_protos(context.native_handle(), kHttp2.data(), kHttp2.size());
        asio::ssl::stream<tcp::socket> stream(connect(), context);
        error_code error;
        stream.handshake(asio::ssl::stream_base::client, error);
        std::array<char, 64> answer{};
        return !error && stream.read_some(asio::buffer(answer), error) > 0;
    }

    asio::io_context io_;
    const test::Authority authority_{"the authority"};
    const test::Authority other_{"another authority"};
    Port port_;
};

INSTANTIATE_TEST_SUITE_P(At, GrpcHandshakes,
                         testing::Values(std::pair<std::string, Start>("Coordinator",
                                                                       startCoordinator),
                                         std::pair<std::string, Start>("Renderer", startRenderer)),
                         [](const auto& of) { return of.param.first; });

TEST_P(GrpcHandshakes, AreCountedOfEveryPeerThatIsRefusedAndOfNoOther) {
    const std::uint64_t before = failedSoFar();
    const auto becomes = [&](std::uint64_t count) {
        return eventually([&] { return failedSoFar() - before >= count; });
    };
    EXPECT_TRUE(getsIn(authority_.issue("client")));
    connect().close();  // who only looks whether the port is open
    {
        tcp::socket socket = connect();
        asio::write(socket, asio::buffer(std::string("\x16\x03\x01", 3)));
    }
    {
        tcp::socket socket = connect();
        asio::write(socket, asio::buffer(std::string("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n")));
        ASSERT_TRUE(becomes(1)) << "in the clear";
    }
    EXPECT_FALSE(getsIn({"", "", authority_.file()}));
    ASSERT_TRUE(becomes(2)) << "shows no certificate";
    access::TlsFiles foreign = other_.issue("client");
    foreign.authority = authority_.file();
    EXPECT_FALSE(getsIn(foreign));
    ASSERT_TRUE(becomes(3)) << "shows one of another authority";
    EXPECT_FALSE(getsIn(authority_.issue("old", {.validToSeconds = -1800})));
    ASSERT_TRUE(becomes(4)) << "shows one that has expired";
    access::TlsFiles disbelieving = authority_.issue("client");
    disbelieving.authority = other_.file();
    EXPECT_FALSE(getsIn(disbelieving));
    ASSERT_TRUE(becomes(5)) << "does not believe the server's, and says so";
    EXPECT_TRUE(getsIn(authority_.issue("client")));
    EXPECT_EQ(failedSoFar() - before, 5U);
}

TEST(GrpcHandshake, OfWhoSaysNothingIsGivenUpAndCounted) {
    const test::Authority authority("the authority");
    wire::Security security;
    security.tls = authority.issue("server");
    const Port port = startCoordinator(security);
    const std::uint64_t before = failedSoFar();
    asio::io_context io;
    tcp::socket mute = connectTo(port, io);
    std::array<char, 1> byte{};
    error_code error;
    mute.read_some(asio::buffer(byte), error);  // ten seconds
    EXPECT_TRUE(error) << "it was answered";
    EXPECT_TRUE(eventually([&] { return failedSoFar() - before == 1; }));
}

}  // namespace
}  // namespace eyrie
