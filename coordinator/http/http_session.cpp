// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/http_session.h"

#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "coordinator/http/observe_routes.h"
#include "coordinator/http/origin.h"
#include "coordinator/http/router.h"
#include "coordinator/http/web_socket.h"

namespace eyrie::http {
namespace {

namespace beast = boost::beast;
using beast::error_code;
using boost::asio::ip::tcp;
using Request = beast::http::request<beast::http::string_body>;
using Reply = beast::http::response<beast::http::string_body>;

constexpr std::uint32_t kMaxHeaderBytes = 16 * 1024;
constexpr std::uint64_t kMaxBodyBytes = 4 * 1024;

/// The page runs its own scripts and styles only, talks to this server only, and may be framed by
/// it only.
constexpr const char* kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; worker-src 'self'; manifest-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'self'";

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

/// What came is no HTTP, as opposed to: nothing more came.
bool isMalformed(error_code error) {
    namespace http = beast::http;
    return error.category() == make_error_code(http::error::bad_method).category() &&
           error != http::error::end_of_stream && error != http::error::partial_message;
}

class HttpSession : public Session, public std::enable_shared_from_this<HttpSession> {
public:
    HttpSession(tcp::socket socket, Context& context, Slot slot)
        : stream_(std::move(socket)),
          buffer_(2 * kMaxHeaderBytes),
          context_(context),
          slot_(std::move(slot)) {
        context_.sessions.insert(this);
    }

    ~HttpSession() override {
        context_.sessions.erase(this);
        context_.sessionEnded();
    }

    void shutDown() override { stream_.cancel(); }
    void abandon() override {}

    void read() {
        parser_.emplace();
        parser_->header_limit(kMaxHeaderBytes);
        parser_->body_limit(kMaxBodyBytes);
        stream_.expires_after(context_.options.headerTimeout);
        beast::http::async_read(stream_, buffer_, *parser_,
                                [self = shared_from_this()](error_code error, std::size_t bytes) {
                                    self->count(observe::Direction::In, bytes);
                                    self->requestRead(error);
                                });
    }

private:
    void requestRead(error_code error) {
        namespace http = beast::http;
        if (error == http::error::header_limit)
            return reply(textResponse(431, "The request's header is longer than 16 KiB."), false);
        if (error == http::error::body_limit)
            return reply(textResponse(413, "Requests have no body here."), false);
        if (isMalformed(error))
            return reply(textResponse(400, "This is not HTTP/1.1."), false);
        if (error)
            return;  // closed or too slow; the socket goes with this session
        const Request request = parser_->release();
        if (pathOf(view(request.target())) == "/ws")
            return upgrade(request);
        isHead_ = request.method() == http::verb::head;
        if (const auto observed =
                observationResponse(view(request.method_string()), view(request.target()),
                                    *context_.telemetry, context_.frames))
            return reply(*observed, request.keep_alive());
        reply(route(view(request.method_string()), view(request.target()), context_.files,
                    context_.frames),
              request.keep_alive());
    }

    void upgrade(const Request& request) {
        namespace http = beast::http;
        if (!beast::websocket::is_upgrade(request))
            return reply(textResponse(426, "This is a WebSocket; open / in a browser instead."),
                         false);
        if (!isAllowedOrigin(view(request[http::field::origin]), view(request[http::field::host]),
                             context_.isLoopback))
            return reply(textResponse(403, "Pages of other sites may not connect to this server."),
                         false);
        std::ostringstream received;
        received << request << beast::buffers_to_string(buffer_.data());
        stream_.expires_never();
        openWebSocket(stream_.release_socket(), received.str(), context_, std::move(slot_));
    }

    void reply(const Response& response, bool keepAlive) {
        namespace http = beast::http;
        context_.telemetry->metrics.refused(response.status);
        reply_ = Reply(static_cast<http::status>(response.status), 11);
        reply_.set(http::field::content_type, response.contentType);
        reply_.set(http::field::cache_control, response.cacheControl);
        reply_.set("Content-Security-Policy", kContentSecurityPolicy);
        reply_.set("X-Content-Type-Options", "nosniff");
        reply_.set("Referrer-Policy", "no-referrer");
        reply_.set("Cross-Origin-Resource-Policy", "same-origin");
        if (response.status == 405)
            reply_.set(http::field::allow, "GET, HEAD");
        if (response.status == 426)
            reply_.set(http::field::upgrade, "websocket");
        reply_.content_length(response.body->size());
        if (!isHead_)
            reply_.body() = *response.body;
        reply_.keep_alive(keepAlive);
        stream_.expires_after(context_.options.headerTimeout);
        http::async_write(
            stream_, reply_,
            [self = shared_from_this(), keepAlive](error_code error, std::size_t bytes) {
                self->count(observe::Direction::Out, bytes);
                if (!error && keepAlive)
                    self->read();
                else
                    self->finish();
            });
    }

    void count(observe::Direction direction, std::size_t bytes) {
        context_.telemetry->metrics.bytes(observe::Peer::Http, direction, bytes);
    }

    /// Lets the peer read the reply before the connection goes.
    void finish() {
        error_code ignored;
        stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    }

    beast::tcp_stream stream_;
    beast::flat_buffer buffer_;
    std::optional<beast::http::request_parser<beast::http::string_body>> parser_;
    Reply reply_;
    bool isHead_ = false;
    Context& context_;
    Slot slot_;
};

}  // namespace

void openHttpSession(tcp::socket socket, Context& context, Slot slot) {
    std::make_shared<HttpSession>(std::move(socket), context, std::move(slot))->read();
}

}  // namespace eyrie::http
