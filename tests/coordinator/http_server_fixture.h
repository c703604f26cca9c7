// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "coordinator/http/server.h"
#include "eyrie/v1/viewer.pb.h"
#include "tests/coordinator/fake_frame_source.h"

namespace eyrie::http {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace fs = std::filesystem;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using coordinator::FakeFrameSource;
using Response = beast::http::response<beast::http::string_body>;

/// A built UI with a secret beside it.
class WebFolder {
public:
    WebFolder() : root_(fs::temp_directory_path() / fmt::format("eyrie-web-{}", ::getpid())) {
        write("web/index.html", "<!doctype html><title>page</title>");
        write("web/assets/main-1234.js", "export {};");
        write("web/icon.svg", "<svg/>");
        write("secret.txt", "SECRET");
        fs::create_symlink(root_ / "secret.txt", root_ / "web" / "link.txt");
    }
    ~WebFolder() { fs::remove_all(root_); }

    fs::path path() const { return root_ / "web"; }

    void write(const fs::path& name, std::string_view text) const {
        fs::create_directories((root_ / name).parent_path());
        std::ofstream(root_ / name) << text;
    }

private:
    fs::path root_;
};

/// A server of frames that tests make, and connections to it.
class HttpServer : public testing::Test {
protected:
    void start(ServerOptions options = {}) {
        options.port = 0;
        options.webFolder = web_.path();
        auto server = Server::start(options, frames_);
        ASSERT_TRUE(server.ok()) << server.status();
        server_ = *std::move(server);
    }

    std::string hostAndPort() const {
        std::string url = server_->url();
        return url.substr(7, url.size() - 8);
    }
    std::uint16_t port() const {
        return static_cast<std::uint16_t>(
            std::stoi(hostAndPort().substr(hostAndPort().rfind(':') + 1)));
    }

    tcp::socket connect() {
        tcp::socket socket(io_);
        socket.connect({asio::ip::make_address("127.0.0.1"), port()});
        return socket;
    }

    /// One that has sent `bytes` and takes no more of the answer than that at a time.
    tcp::socket connect(const std::string& bytes, int receiveBytes) {
        tcp::socket socket(io_, tcp::v4());
        socket.set_option(asio::socket_base::receive_buffer_size(receiveBytes));
        socket.connect({asio::ip::make_address("127.0.0.1"), port()});
        asio::write(socket, asio::buffer(bytes));
        return socket;
    }

    /// Sends `bytes` and reads until the server closes or a whole response has come.
    Response exchange(const std::string& bytes) {
        tcp::socket socket = connect();
        asio::write(socket, asio::buffer(bytes));
        return readResponse(socket);
    }

    static Response readResponse(tcp::socket& socket) {
        beast::flat_buffer buffer;
        Response response;
        beast::error_code error;
        beast::http::read(socket, buffer, response, error);
        EXPECT_FALSE(error) << error.message();
        return response;
    }

    Response get(const std::string& target) {
        return exchange(fmt::format("GET {} HTTP/1.1\r\nHost: {}\r\n\r\n", target, hostAndPort()));
    }

    using Socket = websocket::stream<beast::tcp_stream>;

    std::unique_ptr<Socket> openSocket(const std::string& origin = "") {
        auto socket = std::make_unique<Socket>(beast::tcp_stream(connect()));
        socket->set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
            if (!origin.empty())
                request.set(beast::http::field::origin, origin);
        }));
        beast::error_code error;
        socket->handshake(hostAndPort(), "/ws", error);
        EXPECT_FALSE(error) << error.message();
        socket->binary(true);
        return socket;
    }

    /// The next message but for signs of life, which come whenever the machine is slow. Throws
    /// where none comes, for who waits for a certain one would wait for ever.
    static v1::ViewerResponse read(Socket& socket) {
        beast::flat_buffer buffer;
        while (buffer.size() == 0) socket.read(buffer);
        v1::ViewerResponse response;
        EXPECT_TRUE(response.ParseFromArray(buffer.data().data(), static_cast<int>(buffer.size())));
        return response;
    }

    static v1::Frame readFrame(Socket& socket) {
        for (;;) {
            v1::ViewerResponse response = read(socket);
            if (response.has_frame())
                return response.frame();
            if (!response.has_state())
                return {};
        }
    }

    static std::string viewBytes(std::uint64_t sequence, int width = 64, int height = 48) {
        v1::ViewerRequest request;
        v1::ViewRequest& view = *request.mutable_view();
        view.set_sequence(sequence);
        view.set_width(width);
        view.set_height(height);
        view.set_tau_pixels(1);
        for (const double value : {static_cast<double>(sequence), -10.0, 3.0})
            view.mutable_camera()->add_eye(value);
        for (int i = 0; i < 3; ++i) view.mutable_camera()->add_target(0);
        return request.SerializeAsString();
    }

    static std::string ackBytes(std::uint64_t frameNumber) {
        v1::ViewerRequest request;
        request.mutable_frame_ack()->set_frame_number(frameNumber);
        return request.SerializeAsString();
    }

    /// The code with which the server closes the connection.
    static int closeCode(Socket& socket) {
        beast::error_code error;
        while (!error) {
            beast::flat_buffer buffer;
            socket.read(buffer, error);
        }
        // Where the server has closed the connection, too, the stream finds nothing left to shut
        // down.
        EXPECT_TRUE(error == websocket::error::closed || error == asio::error::not_connected)
            << error.message();
        return socket.reason().code;
    }

    WebFolder web_;
    FakeFrameSource frames_;
    asio::io_context io_;
    std::unique_ptr<Server> server_;
};

}  // namespace eyrie::http
