// SPDX-License-Identifier: Apache-2.0
// HTTP over TLS: who is served, by which certificate, and who is cut off.
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/write.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/http/access.h"
#include "coordinator/http/server.h"
#include "tests/coordinator/http_access_fixture.h"
#include "tests/support/certificates.h"

namespace eyrie::http {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;
using testing::Not;

/// As HttpAccess, over TLS.
class Https : public HttpAccess {
protected:
    void start(const test::Authority::Holder& holder = {}) {
        ServerOptions options;
        options.tls = authority_.issue("server", holder);
        HttpAccess::start(options);
    }

    /// The answer to a request by who believes `authority`; empty: no connection was made.
    std::string ask(const std::string& text, const test::Authority& authority) {
        asio::ssl::context context(asio::ssl::context::tls_client);
        context.load_verify_file(authority.file());
        context.set_verify_mode(asio::ssl::verify_peer);
        asio::ssl::stream<tcp::socket> stream(connect(), context);
        stream.set_verify_callback(asio::ssl::host_name_verification("127.0.0.1"));
        error_code error;
        stream.handshake(asio::ssl::stream_base::client, error);
        std::string answer;
        if (!error)
            asio::write(stream, asio::buffer(text), error);
        if (!error)
            asio::read(stream, asio::dynamic_buffer(answer), error);
        return answer;
    }

    test::Authority authority_{"the authority"};
};

TEST_F(Https, WhoSendsAllOfABodyThatIsTooLongFirstReadsThatItIs) {
    start();
    const std::string answer = ask(
        request("POST", "/login", "Content-Length: 20000000\r\n") + std::string(20'000'000, ' '),
        authority_);
    EXPECT_THAT(answer.substr(0, 12), HasSubstr("HTTP/1.1 413"));
}

TEST_F(Https, ServesWhoBelievesItsAuthorityAndNobodyInTheClear) {
    start();
    EXPECT_TRUE(server_->url().starts_with("https://"));
    const std::string answer = ask(request("POST", "/login", bearer(kViewToken)), authority_);
    EXPECT_THAT(answer, HasSubstr("HTTP/1.1 200"));
    EXPECT_THAT(answer, HasSubstr("; Secure"));
    const test::Authority other("another");
    EXPECT_EQ(ask(request("GET", "/healthz"), other), "");
    EXPECT_THAT(HttpAccess::ask(request("GET", "/healthz")), Not(HasSubstr("HTTP/1.1 200")));
    EXPECT_THAT(ask(request("GET", "/healthz"), authority_), HasSubstr("HTTP/1.1 200"));
    connect().close();  // who only looks whether the port is open
    EXPECT_THAT(ask(request("GET", "/metrics", bearer(kViewToken)), authority_),
                HasSubstr("eyrie_peers_refused_total{door=\"http\",reason=\"handshake\"} 2\n"));
}

TEST_F(Https, IsMeantByTargetsOfItsSchemeAndByNoOthers) {
    start();
    const auto statusOf = [this](const std::string& scheme) {
        return ask(request("GET", fmt::format("{}://127.0.0.1:{}/healthz", scheme, port_)),
                   authority_)
            .substr(0, 12);
    };
    EXPECT_EQ(statusOf("https"), "HTTP/1.1 200");
    EXPECT_EQ(statusOf("http"), "HTTP/1.1 421");
}

TEST_F(Https, CarriesWebSockets) {
    start();
    asio::ssl::context context(asio::ssl::context::tls_client);
    asio::ssl::stream<tcp::socket> stream(connect(), context);
    stream.handshake(asio::ssl::stream_base::client);
    asio::write(stream,
                asio::buffer(fmt::format("GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{}{}\r\n",
                                         port_, kUpgrade, bearer(kViewToken))));
    std::string received(4096, '\0');
    received.resize(stream.read_some(asio::buffer(received)));
    EXPECT_THAT(received, HasSubstr("HTTP/1.1 101"));
    while (received.find("hill") == std::string::npos) {  // the state names the scene's object
        std::string more(4096, '\0');
        error_code error;
        more.resize(stream.read_some(asio::buffer(more), error));
        ASSERT_FALSE(error) << error.message();
        received += more;
    }
}

TEST_F(Https, TakesAReplacedCertificateForNewConnectionsAndKeepsTheOldOnes) {
    start();
    asio::ssl::context context(asio::ssl::context::tls_client);
    asio::ssl::stream<tcp::socket> old(connect(), context);
    old.handshake(asio::ssl::stream_base::client);
    EXPECT_THAT(ask(request("GET", "/healthz"), authority_), HasSubstr("HTTP/1.1 200"));
    // For another host, so that it shows which one is used.
    authority_.issue("server", {.name = "elsewhere.example"});
    const auto end = std::chrono::steady_clock::now() + seconds(20);
    while (!ask(request("GET", "/healthz"), authority_).empty()) {
        ASSERT_LT(std::chrono::steady_clock::now(), end) << "the new certificate is not taken";
        std::this_thread::sleep_for(milliseconds(100));
    }
    asio::write(old, asio::buffer(request("GET", "/healthz")));
    std::string answer;
    error_code ignored;
    asio::read(old, asio::dynamic_buffer(answer), ignored);
    EXPECT_THAT(answer, HasSubstr("HTTP/1.1 200"));
    authority_.issue("server");
    while (ask(request("GET", "/healthz"), authority_).empty()) {
        ASSERT_LT(std::chrono::steady_clock::now(), end) << "the third certificate is not taken";
        std::this_thread::sleep_for(milliseconds(100));
    }
}

TEST_F(Https, RefusesToStartWithFilesThatNobodyCouldUse) {
    const auto statusWith = [&](const access::TlsFiles& files) {
        ServerOptions options;
        options.port = 0;
        options.tls = files;
        return Server::start(options, frames_).status();
    };
    EXPECT_THAT(
        std::string(statusWith(authority_.issue("old", {.validToSeconds = -1800})).message()),
        HasSubstr("has expired"));
    EXPECT_THAT(
        std::string(statusWith(authority_.issue("new", {.validFromSeconds = 1800})).message()),
        HasSubstr("is not valid yet"));
    access::TlsFiles mixed = authority_.issue("one");
    mixed.key = authority_.issue("two").key;
    EXPECT_THAT(std::string(statusWith(mixed).message()), HasSubstr("goes with the certificate"));
    EXPECT_TRUE(absl::IsNotFound(statusWith({"/none.crt", mixed.key, ""})));
    std::filesystem::permissions(mixed.key, std::filesystem::perms(0644));
    EXPECT_TRUE(absl::IsPermissionDenied(statusWith({mixed.certificate, mixed.key, ""})));
}

TEST_F(Https, CutsOffAHandshakeThatIsNotFinished) {
    ServerOptions options;
    options.headerTimeout = milliseconds(1000);
    options.tls = authority_.issue("server");
    HttpAccess::start(options);
    tcp::socket mute = connect();
    asio::write(mute, asio::buffer(std::string("\x16\x03\x01", 3)));
    char byte = 0;
    error_code error;
    asio::read(mute, asio::buffer(&byte, 1), error);
    EXPECT_TRUE(error);
}

}  // namespace
}  // namespace eyrie::http
