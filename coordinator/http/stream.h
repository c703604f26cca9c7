// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <utility>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core/role.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/teardown.hpp>

namespace eyrie::http {

/// A connection, plain or encrypted, as Asio's AsyncStream with Beast's time limits. What runs over
/// it need not know which. Moves, also between operations.
class Stream {
public:
    using Tcp = boost::beast::tcp_stream;
    using executor_type = Tcp::executor_type;
    using error_code = boost::beast::error_code;

    explicit Stream(boost::asio::ip::tcp::socket socket)
        : tcp_(std::make_unique<Tcp>(std::move(socket))) {}

    /// Encrypted; needs the handshake before anything else. `context` may go once this is made.
    Stream(boost::asio::ip::tcp::socket socket, boost::asio::ssl::context& context)
        : Stream(std::move(socket)) {
        tls_ = std::make_unique<Tls>(*tcp_, context);
    }

    executor_type get_executor() { return tcp_->get_executor(); }
    boost::asio::ip::tcp::socket& socket() { return tcp_->socket(); }
    void expires_after(std::chrono::milliseconds time) { tcp_->expires_after(time); }
    void expires_at(std::chrono::steady_clock::time_point time) { tcp_->expires_at(time); }
    void expires_never() { tcp_->expires_never(); }
    void cancel() { tcp_->cancel(); }
    void close() { tcp_->close(); }

    bool isEncrypted() const { return tls_ != nullptr; }

    /// Only of an encrypted one. `handler` takes an error_code.
    template <typename Handler>
    void asyncHandshake(Handler&& handler) {
        tls_->async_handshake(boost::asio::ssl::stream_base::server,
                              std::forward<Handler>(handler));
    }

    template <typename Buffers, typename Handler>
    void async_read_some(const Buffers& buffers, Handler&& handler) {
        if (tls_)
            tls_->async_read_some(buffers, std::forward<Handler>(handler));
        else
            tcp_->async_read_some(buffers, std::forward<Handler>(handler));
    }

    template <typename Buffers, typename Handler>
    void async_write_some(const Buffers& buffers, Handler&& handler) {
        if (tls_)
            tls_->async_write_some(buffers, std::forward<Handler>(handler));
        else
            tcp_->async_write_some(buffers, std::forward<Handler>(handler));
    }

    /// Says that nothing more comes. `handler` takes an error_code.
    template <typename Handler>
    void asyncShutDown(boost::beast::role_type role, Handler&& handler) {
        if (tls_)
            tls_->async_shutdown(std::forward<Handler>(handler));
        else
            boost::beast::websocket::async_teardown(role, tcp_->socket(),
                                                    std::forward<Handler>(handler));
    }

private:
    using Tls = boost::asio::ssl::stream<Tcp&>;

    std::unique_ptr<Tcp> tcp_;
    std::unique_ptr<Tls> tls_;  ///< over *tcp_
};

/// What Beast's WebSocket finds by the type of its stream.
template <typename Handler>
void async_teardown(boost::beast::role_type role, Stream& stream, Handler&& handler) {
    stream.asyncShutDown(role, std::forward<Handler>(handler));
}
inline void beast_close_socket(Stream& stream) { stream.close(); }

}  // namespace eyrie::http
