// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/http_session.h"

#include <chrono>
#include <optional>
#include <sstream>
#include <stop_token>
#include <string_view>
#include <utility>

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <fmt/format.h>

#include "coordinator/http/api_calls.h"
#include "coordinator/http/event_stream.h"
#include "coordinator/http/late_close.h"
#include "coordinator/http/observe_routes.h"
#include "coordinator/http/origin.h"
#include "coordinator/http/peer.h"
#include "coordinator/http/problem.h"
#include "coordinator/http/reply.h"
#include "coordinator/http/request.h"
#include "coordinator/http/router.h"
#include "coordinator/http/stream.h"
#include "coordinator/http/web_socket.h"
#include "coordinator/http/write_pace.h"
#include "fabric/log.h"

namespace eyrie::http {
namespace {

namespace beast = boost::beast;
using beast::error_code;
using boost::asio::ip::tcp;

constexpr std::uint32_t kMaxHeaderBytes = 16 * 1024;
constexpr std::uint64_t kMiB = 1024 * 1024;
constexpr std::uint64_t kMaxBodyBytes = kMiB;

/// Of changes by those who may make them, as a flight with all the keys it may have.
constexpr std::uint64_t kMaxChangeBytes = 8 * kMiB;

/// Bodies above kMaxBodyBytes that are held at once.
constexpr std::size_t kMaxLongBodies = 16;

/// How often a client that has sent more than its request is looked at.
constexpr std::chrono::milliseconds kLookAgain{100};

/// In this header a page says where it is when it asks why it may not connect: browsers send no
/// Origin with what a page asks of its own server, which behind a proxy they take the proxy for.
constexpr const char* kPageOrigin = "Eyrie-Page-Origin";

constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";

constexpr std::string_view kNoWebSocket =
    "this address is for WebSockets; open / in a browser instead, and have a proxy in between pass "
    "on the headers Upgrade and Connection";

absl::Status strangersPage(std::string_view origin, std::string_view host) {
    return absl::PermissionDeniedError(
        fmt::format("pages of {} may not connect to this server, which was asked as {}; a proxy in "
                    "between has to pass on the browser's Host",
                    origin, host));
}

/// What came is no HTTP, as opposed to: nothing more came.
bool isMalformed(error_code error) {
    namespace http = beast::http;
    return error.category() == make_error_code(http::error::bad_method).category() &&
           error != http::error::end_of_stream && error != http::error::partial_message;
}

class HttpSession : public Session, public std::enable_shared_from_this<HttpSession> {
public:
    HttpSession(tcp::socket socket, Context& context, Slot slot)
        : address_(addressOf(socket)),
          stream_(context.tls ? Stream(std::move(socket), context.tls->current())
                              : Stream(std::move(socket))),
          buffer_(2 * kMaxHeaderBytes),
          context_(context),
          patience_(stream_.get_executor()),
          looksAgain_(stream_.get_executor()),
          drained_(stream_.get_executor()),
          slot_(std::move(slot)) {
        context_.sessions.insert(this);
    }

    ~HttpSession() override {
        dropLongBody();
        context_.sessions.erase(this);
        context_.sessionEnded();
    }

    /// What has been asked for is still answered, for drainTimeout at most.
    void shutDown() override {
        isEnding_ = true;
        if (!isCalling_ && body_ == nullptr)
            return stream_.cancel();
        drained_.expires_after(context_.options.drainTimeout);
        drained_.async_wait([weak = weak_from_this()](error_code error) {
            if (const auto self = weak.lock(); self && !error)
                self->giveUp();
        });
    }
    void abandon() override {}

    void begin() {
        await();
        if (!stream_.isEncrypted())
            return read();
        stream_.expires_after(context_.options.headerTimeout);
        stream_.asyncHandshake([self = shared_from_this()](error_code error) {
            if (error)
                return self->noteFailedHandshake(error);
            if (!self->isDropped_)
                self->read();
        });
    }

private:
    /// Until a request has come it may have to make room for another connection.
    void await() {
        context_.crowd.await(waiting_, address_, [this] {
            isDropped_ = true;
            waiting_.end();
            slot_.reset();
            stream_.close();
        });
    }

    /// Who only looks whether the port is open, as probes do, has not failed.
    void noteFailedHandshake(error_code error) {
        const bool hasFailed = error == beast::error::timeout ||
                               error.category() == boost::asio::error::get_ssl_category();
        if (isDropped_ || !hasFailed)
            return;
        context_.telemetry->metrics.handshakeFailed();
        if (context_.handshakes.isDue(address_, access::RareWarnings::Clock::now()))
            spdlog::warn(
                "no encrypted connection with {}: {}; more from there within a minute are "
                "not told",
                address_, error.message());
    }

    void read() {
        parser_.emplace();
        parser_->header_limit(kMaxHeaderBytes);
        parser_->body_limit(kMaxChangeBytes);  // until it is known who asks for what
        isHead_ = false;                       // until it has come; what does not come is told why
        stream_.expires_never();  // it would close the connection, and nobody would be told why
        isReading_ = true;
        patience_.expires_after(context_.options.headerTimeout);
        patience_.async_wait([weak = weak_from_this()](error_code error) {
            if (const auto self = weak.lock(); self && !error)
                self->stopReading();
        });
        beast::http::async_read_header(
            stream_, buffer_, *parser_,
            [self = shared_from_this()](error_code error, std::size_t bytes) {
                self->count(observe::Direction::In, bytes);
                if (error || self->parser_->is_done())
                    return self->requestRead(error);
                if (self->admitBody())
                    self->askForBody();
            });
    }

    /// Whether a body as long as the header says may come; otherwise that is answered.
    bool admitBody() {
        parser_->body_limit(kMaxBodyBytes);
        if (parser_->content_length().value_or(0) <= kMaxBodyBytes)
            return true;
        const Asked asked = askedBy(parser_->get(), address_);
        if (!isChange(asked)) {
            requestRead(beast::http::error::body_limit);
            return false;
        }
        std::optional<Response> refusal = context_.access.answer(asked, context_.frames);
        if (!refusal && context_.longBodies == kMaxLongBodies)
            refusal = toResponse(api::busyAnswer());
        if (refusal) {
            doneReading();
            isUnread_ = true;
            reply(*refusal, false);
            return false;
        }
        parser_->body_limit(kMaxChangeBytes);
        hasLongBody_ = true;
        ++context_.longBodies;
        return true;
    }

    void dropLongBody() {
        if (std::exchange(hasLongBody_, false))
            --context_.longBodies;
    }

    void askForBody() {
        if (waitsToGoOn(parser_->get()))
            return goOn();
        readBody();
    }

    /// Whoever asks: bodies of those who do not wait for it come, too.
    void goOn() {
        boost::asio::async_write(stream_, boost::asio::buffer(kContinue.data(), kContinue.size()),
                                 [self = shared_from_this()](error_code error, std::size_t bytes) {
                                     self->count(observe::Direction::Out, bytes);
                                     if (error)
                                         return self->requestRead(error);
                                     self->readBody();
                                 });
    }

    void readBody() {
        beast::http::async_read(stream_, buffer_, *parser_,
                                [self = shared_from_this()](error_code error, std::size_t bytes) {
                                    self->count(observe::Direction::In, bytes);
                                    self->requestRead(error);
                                });
    }

    void stopReading() {
        if (!isReading_ || patience_.expiry() > std::chrono::steady_clock::now())
            return;  // of the request before
        isTooSlow_ = true;
        stream_.cancel();
    }

    void doneReading() {
        isReading_ = false;
        patience_.cancel();
        waiting_.end();
    }

    /// What is longer than any body may be is found out before it is known who asks.
    std::string tooLong() const {
        const bool isLongest = !parser_->is_header_done();  // nothing else ends it there
        const bool saysNoLength =
            !isLongest && parser_->chunked() && isChange(askedBy(parser_->get(), address_));
        return fmt::format("the body is longer than {} MiB; make it shorter{}",
                           (isLongest ? kMaxChangeBytes : kMaxBodyBytes) / kMiB,
                           saysNoLength ? fmt::format(", or say its Content-Length: with that it "
                                                      "may have {} MiB",
                                                      kMaxChangeBytes / kMiB)
                                        : "");
    }

    void requestRead(error_code error) {
        namespace http = beast::http;
        doneReading();
        if (isDropped_)
            return;
        if (error == http::error::header_limit)
            return refuseUnread(431, "the header is longer than 16 KiB; make it shorter");
        if (error == http::error::body_limit)
            return refuseUnread(413, tooLong());
        if (isTooSlow_ && (buffer_.size() > 0 || parser_->got_some()))
            return refuseUnread(408, "the request did not come in time; send it at once");
        if (isMalformed(error))
            return refuseUnread(400, "this is not HTTP/1.1; ask by that");
        if (error)
            return;  // closed, or nothing came; the socket goes with this session
        Request request = parser_->release();
        isHead_ = request.method() == http::verb::head;
        if (const absl::Status host = takeHost(request, stream_.isEncrypted()); !host.ok())
            return refuseUnread(absl::IsFailedPrecondition(host) ? 421 : 400,
                                {host.message().data(), host.message().size()});
        const Asked asked = askedBy(request, address_);
        if (const std::optional<Response> answer = context_.access.answer(asked, context_.frames))
            return reply(*answer, request.keep_alive() && answer->status < 400);
        if (pathOf(view(request.target())) == "/ws")
            return upgrade(request, context_.access.roleOf(asked));
        if (const auto observed = observationResponse(view(request.method_string()),
                                                      view(request.target()), *context_.telemetry,
                                                      context_.options.gate.get(), context_.frames))
            return reply(*observed, request.keep_alive());
        if (isApiCall(pathOf(view(request.target()))) && context_.options.api != nullptr)
            return call(request, context_.access.roleOf(asked));
        reply(route(view(request.method_string()), view(request.target()), context_.files,
                    context_.frames),
              request.keep_alive());
    }

    /// Who sends no request as they should, be it by mistake or to do harm, is told to the log.
    void refuseUnread(int status, std::string_view why) {
        if (context_.unread.isDue(address_, access::RareWarnings::Clock::now()))
            spdlog::warn(
                "a request from {} is answered with {}: {}; more such within a minute are not told",
                address_, status, why.substr(0, why.find(';')));
        isUnread_ = true;
        reply(problemResponse(status, why), false);
    }

    /// Scripts do not learn why a WebSocket was refused: to a plain GET all that would refuse one
    /// is answered as well, and nobody gets a seat.
    void upgrade(const Request& request, access::Role role) {
        namespace http = beast::http;
        const bool isUpgrade = beast::websocket::is_upgrade(request);
        const std::string_view host = view(request[http::field::host]);
        const std::string_view origin =
            view(request.count(http::field::origin) == 0 ? request[kPageOrigin]
                                                         : request[http::field::origin]);
        if (!isAllowedOrigin(origin, host, context_.localNamesOnly))
            return refuse(strangersPage(origin, host));
        auto joining = stream::joiningOf(view(request.target()));
        if (!joining.ok())
            return reply(problemResponse(400, std::string(joining.status().message())), false);
        joining->mayControl = role >= access::Role::Control;
        absl::StatusOr<Crowd::Place> seat = context_.crowd.seat(address_, joining->session);
        if (!seat.ok()) {
            if (isUpgrade)
                noteNoSeat(seat.status());
            return refuse(seat.status());
        }
        if (!isUpgrade)
            return reply(problemResponse(426, kNoWebSocket), false);
        std::ostringstream received;
        received << request << beast::buffers_to_string(buffer_.data());
        stream_.expires_never();
        openWebSocket(std::move(stream_), received.str(), *joining, context_,
                      std::make_shared<std::pair<Slot, Slot>>(std::move(slot_), *std::move(seat)));
    }

    void noteNoSeat(const absl::Status& why) {
        context_.telemetry->metrics.overQuota(observe::Quota::Viewers);
        if (context_.seats.isDue(address_, access::RareWarnings::Clock::now()))
            spdlog::warn(
                "a viewer from {} is turned away: {}; more from there within a minute are "
                "not told",
                address_, std::string(why.message()));
    }

    /// Of a viewer, for a while: others may leave, and proxies be set right.
    void refuse(const absl::Status& why) {
        Response refused = problemResponse(why);
        refused.headers.emplace_back("Retry-After", "5");
        reply(refused, false);
    }

    /// On a thread of its own; what ends the connection ends the call.
    void call(const Request& request, access::Role role) {
        namespace http = beast::http;
        if (!isAllowedOrigin(view(request[http::field::origin]), view(request[http::field::host]),
                             context_.localNamesOnly))
            return reply(problemResponse(403, "pages of other sites may not call this server"),
                         false);
        if (const auto refused = context_.options.api->refusal(address_))
            return reply(toResponse(*refused), request.keep_alive());
        gone_ = std::stop_source();
        isCalling_ = true;
        watch();
        const bool isTaken = context_.callers.post([self = shared_from_this(),
                                                    asked = restRequest(request, gone_, role),
                                                    keepAlive = request.keep_alive()]() mutable {
            api::RestAnswer answer = self->context_.options.api->answer(asked);
            const auto executor = self->stream_.get_executor();
            // The session ends on its own thread.
            boost::asio::post(executor, [self = std::move(self), answer, keepAlive] {
                if (!std::exchange(self->isCalling_, false))
                    return;  // it was too late
                self->looksAgain_.cancel();
                if (answer.events == nullptr || self->isEnding_)
                    return self->reply(toResponse(answer), keepAlive);
                openEventStream(std::move(self->stream_), headersOf(toResponse(answer)).base(),
                                answer.events, self->context_, std::move(self->slot_));
            });
        });
        if (isTaken)
            return;
        isCalling_ = false;
        reply(toResponse(api::busyAnswer()), request.keep_alive());
    }

    /// The server ends before its call does.
    void giveUp() {
        if (!std::exchange(isCalling_, false))
            return;  // what is being written has a second more, as viewers' good-byes have
        looksAgain_.cancel();
        gone_.request_stop();
        Response response = problemResponse(503, "this server is stopping; ask again in a bit");
        response.headers.emplace_back("Retry-After", "1");
        reply(response, false);
    }

    /// Notices that the client has gone while its call is being done.
    void watch() {
        stream_.expires_never();
        stream_.socket().async_wait(tcp::socket::wait_read,
                                    [weak = weak_from_this()](error_code error) {
                                        const auto self = weak.lock();
                                        if (!self)
                                            return;
                                        if (error)
                                            self->gone_.request_stop();
                                        else
                                            self->look();
                                    });
    }

    /// Something came: the end, or, before that, the next request or TLS's own farewell.
    void look() {
        if (!isCalling_)
            return;
        if (hasHungUp(stream_.socket().native_handle())) {
            gone_.request_stop();
            return;
        }
        looksAgain_.expires_after(kLookAgain);
        looksAgain_.async_wait([weak = weak_from_this()](error_code error) {
            if (const auto self = weak.lock(); self && !error)
                self->look();
        });
    }

    void reply(const Response& response, bool keepAlive) {
        namespace http = beast::http;
        dropLongBody();
        context_.telemetry->metrics.refused(response.status);
        reply_ = headersOf(response);
        if (response.status == 405 && reply_.count(http::field::allow) == 0)
            reply_.set(http::field::allow, "GET, HEAD");
        if (response.status == 426)
            reply_.set(http::field::upgrade, "websocket");
        body_ = response.body;
        reply_.content_length(body_->size());
        if (!isHead_)
            reply_.body() = {body_->data(), body_->size()};
        reply_.keep_alive(keepAlive && !isEnding_);
        limitUnsent(stream_.socket().native_handle());
        serializer_.emplace(reply_);
        pace_.emplace(WritePace::Clock::now(), context_.options.writeTimeout);
        write();
    }

    /// What the peer has room for, and then the rest.
    void write() {
        stream_.expires_at(pace_->deadline(WritePace::Clock::now()));
        beast::http::async_write_some(
            stream_, *serializer_,
            [self = shared_from_this()](error_code error, std::size_t bytes) {
                self->count(observe::Direction::Out, bytes);
                self->pace_->took(bytes);
                if (!error && !self->serializer_->is_done())
                    return self->write();
                self->written(error);
            });
    }

    void written(error_code error) {
        if (error == beast::error::timeout)
            context_.telemetry->metrics.refused(408);
        body_.reset();
        if (error || isEnding_ || !reply_.keep_alive())
            return finish();
        await();
        read();
    }

    void count(observe::Direction direction, std::size_t bytes) {
        context_.telemetry->metrics.bytes(observe::Peer::Http, direction, bytes);
    }

    /// Lets the peer read the reply before the connection goes.
    void finish() {
        if (stream_.isEncrypted())
            return stream_.asyncShutDown(
                beast::role_type::server,
                [self = shared_from_this()](error_code) { self->sayNoMore(); });
        sayNoMore();
    }

    void sayNoMore() {
        error_code ignored;
        stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
        if (isUnread_ && !isTooSlow_ && !isEnding_)
            closeOnceRead(std::move(stream_), address_, context_, std::move(slot_));
    }

    const std::string address_;
    Crowd::Waiting waiting_;
    bool isDropped_ = false;
    Stream stream_;
    beast::flat_buffer buffer_;
    std::optional<beast::http::request_parser<beast::http::string_body>> parser_;
    Reply reply_;
    std::shared_ptr<const std::string> body_;  ///< the reply's
    std::optional<beast::http::serializer<false, Reply::body_type>> serializer_;
    std::optional<WritePace> pace_;
    bool isHead_ = false;
    bool isCalling_ = false;  ///< a call of the API is being done
    std::stop_source gone_;   ///< its client has
    bool isEnding_ = false;   ///< the server is
    Context& context_;
    boost::asio::steady_timer patience_;  ///< with a request that is on its way
    bool isReading_ = false;
    bool isTooSlow_ = false;
    bool isUnread_ = false;  ///< the request was refused before all of it had come
    bool hasLongBody_ = false;
    boost::asio::steady_timer looksAgain_;  ///< at a client whose call is being done
    boost::asio::steady_timer drained_;     ///< when the server waits no longer for its call
    Slot slot_;
};

}  // namespace

void openHttpSession(tcp::socket socket, Context& context, Slot slot) {
    std::make_shared<HttpSession>(std::move(socket), context, std::move(slot))->begin();
}

}  // namespace eyrie::http
