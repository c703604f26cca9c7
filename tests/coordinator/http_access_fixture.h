// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coordinator/http/access.h"
#include "coordinator/http/server.h"
#include "tests/coordinator/fake_frame_source.h"

namespace eyrie::http {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

inline constexpr char kViewToken[] = "view-0123456789abcdef0123456789";
inline constexpr char kControlToken[] = "control-0123456789abcdef0123456789";
inline constexpr char kAdminToken[] = "admin-0123456789abcdef0123456789";

inline std::string bearer(const std::string& token) {
    return fmt::format("Authorization: Bearer {}\r\n", token);
}

inline constexpr char kUpgrade[] =
    "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";

/// A server that knows those tokens, and clients whose requests are any text.
class HttpAccess : public testing::Test {
protected:
    void start(ServerOptions options = {}, bool withTokens = true) {
        options.port = 0;
        if (withTokens)
            options.gate = gate_ = std::make_shared<access::Gate>(
                *access::Tokens::parse(fmt::format("view {}\ncontrol {}\nadmin {}\n", kViewToken,
                                                   kControlToken, kAdminToken),
                                       "t"));
        auto server = Server::start(options, frames_);
        ASSERT_TRUE(server.ok()) << server.status();
        server_ = *std::move(server);
        const std::string url = server_->url();
        port_ = static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
    }

    /// From another address of this machine, which may stand for another machine.
    tcp::socket connect(const char* from = "127.0.0.1") {
        tcp::socket socket(io_, tcp::v4());
        socket.bind({asio::ip::make_address(from), 0});
        socket.connect({asio::ip::make_address("127.0.0.1"), port_});
        return socket;
    }

    std::string request(const std::string& method, const std::string& target,
                        const std::string& headers = "") const {
        return fmt::format("{} {} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nConnection: close\r\n{}\r\n",
                           method, target, port_, headers);
    }

    /// The header of the answer, and what of the body comes with it.
    static std::string answerOn(tcp::socket& socket) {
        std::string text;
        error_code error;
        std::array<char, 4096> part{};
        while (text.find("\r\n\r\n") == std::string::npos && !error)
            text.append(part.data(), socket.read_some(asio::buffer(part), error));
        if (!text.starts_with("HTTP/1.1 101"))
            asio::read(socket, asio::dynamic_buffer(text), error);
        return text;
    }

    std::string ask(const std::string& text, const char* from = "127.0.0.1") {
        tcp::socket socket = connect(from);
        asio::write(socket, asio::buffer(text));
        return answerOn(socket);
    }

    int statusOf(const std::string& text) {
        const std::string answer = ask(text);
        return answer.starts_with("HTTP/1.1 ") ? std::stoi(answer.substr(9)) : 0;
    }

    int upgradeStatus(const std::string& headers) {
        return statusOf(fmt::format("GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{}{}\r\n", port_,
                                    kUpgrade, headers));
    }

    coordinator::FakeFrameSource frames_;
    asio::io_context io_;
    std::shared_ptr<access::Gate> gate_;
    std::unique_ptr<Server> server_;
    std::uint16_t port_ = 0;
};

}  // namespace eyrie::http
