// SPDX-License-Identifier: Apache-2.0
// Server-sent events: HTML Living Standard, section 9.2; chunks: RFC 9112, section 7.1.
#include "coordinator/http/event_stream.h"

#include <array>
#include <chrono>
#include <sstream>
#include <string>
#include <utility>

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/write.hpp>
#include <fmt/format.h>

#include "coordinator/api/rest_door.h"

namespace eyrie::http {
namespace {

namespace beast = boost::beast;
using beast::error_code;

/// Proxies close connections that are silent for a minute.
constexpr std::chrono::seconds kBeat{15};
/// A client has nothing to say; one that says more than this is none.
constexpr std::size_t kMaxUnexpectedBytes = 64 * 1024;

std::string chunk(const std::string& text) {
    return fmt::format("{:x}\r\n{}\r\n", text.size(), text);
}

class EventStream : public Session, public std::enable_shared_from_this<EventStream> {
public:
    EventStream(Stream stream, std::shared_ptr<api::MessageStream> messages, Context& context,
                Slot slot)
        : stream_(std::move(stream)),
          writeDeadline_(stream_.get_executor()),
          beat_(stream_.get_executor()),
          messages_(std::move(messages)),
          context_(context),
          slot_(std::move(slot)) {
        stream_.expires_never();
        context_.sessions.insert(this);
    }

    ~EventStream() override {
        abandon();
        context_.sessions.erase(this);
        context_.sessionEnded();
    }

    void begin(std::string head) {
        outgoing_ = std::move(head);
        read();
        write();
    }

    void shutDown() override { finish(); }
    /// No more of them come afterwards.
    void abandon() override { messages_.reset(); }

private:
    void ask() {
        if (messages_ == nullptr)
            return;
        messages_->next([weak = weak_from_this(), executor = stream_.get_executor()](
                            const absl::StatusOr<api::MessageStream::Message>& message) {
            boost::asio::post(executor, [weak, message] {
                const auto self = weak.lock();
                if (self == nullptr)
                    return;
                if (message.ok())
                    self->send(api::eventOf(**message), true);
                else
                    self->finish();
            });
        });
    }

    /// After what is being written; at most a message and a beat are.
    void send(const std::string& event, bool isMessage) {
        if (isFinishing_)
            return;
        outgoing_ += chunk(event);
        asksAfterwards_ = asksAfterwards_ || isMessage;
        if (!isWriting_)
            write();
    }

    void write() {
        isWriting_ = true;
        writing_ = std::exchange(outgoing_, "");
        const bool asks = std::exchange(asksAfterwards_, false);
        beat_.cancel();
        writeDeadline_.expires_after(context_.options.writeTimeout);
        writeDeadline_.async_wait([weak = weak_from_this()](error_code error) {
            const auto self = weak.lock();
            if (error || self == nullptr)
                return;
            self->context_.telemetry->metrics.refused(408);
            self->end();
        });
        boost::asio::async_write(
            stream_, boost::asio::buffer(writing_),
            [self = shared_from_this(), asks](error_code error, std::size_t bytes) {
                self->written(error, bytes, asks);
            });
    }

    void written(error_code error, std::size_t bytes, bool asks) {
        context_.telemetry->metrics.bytes(observe::Peer::Http, observe::Direction::Out, bytes);
        writeDeadline_.cancel();
        isWriting_ = false;
        if (error)
            return end();
        if (asks)
            ask();
        if (!outgoing_.empty())
            return write();
        if (isFinishing_)
            return close();
        beat();
    }

    void beat() {
        beat_.expires_after(kBeat);
        beat_.async_wait([weak = weak_from_this()](error_code error) {
            const auto self = weak.lock();
            if (!error && self != nullptr)
                self->send(":\n\n", false);
        });
    }

    /// Notices that the client has gone.
    void read() {
        stream_.async_read_some(boost::asio::buffer(unexpected_),
                                [self = shared_from_this()](error_code error, std::size_t bytes) {
                                    self->unexpectedBytes_ += bytes;
                                    if (error || self->unexpectedBytes_ > kMaxUnexpectedBytes)
                                        self->end();
                                    else
                                        self->read();
                                });
    }

    /// The last chunk, and then the end.
    void finish() {
        if (std::exchange(isFinishing_, true))
            return;
        abandon();
        outgoing_ += chunk("");
        if (!isWriting_)
            write();
    }

    void close() {
        if (stream_.isEncrypted())
            return stream_.asyncShutDown(beast::role_type::server,
                                         [self = shared_from_this()](error_code) { self->end(); });
        error_code ignored;
        stream_.socket().shutdown(boost::asio::socket_base::shutdown_send, ignored);
        end();
    }

    void end() {
        isFinishing_ = true;
        abandon();
        writeDeadline_.cancel();
        beat_.cancel();
        stream_.close();
    }

    Stream stream_;
    boost::asio::steady_timer writeDeadline_;
    boost::asio::steady_timer beat_;
    std::shared_ptr<api::MessageStream> messages_;  ///< null: no more are to come
    std::string outgoing_;
    std::string writing_;
    std::array<char, 1024> unexpected_{};
    std::size_t unexpectedBytes_ = 0;
    bool isWriting_ = false;
    bool asksAfterwards_ = true;  ///< when what is outgoing has been written
    bool isFinishing_ = false;
    Context& context_;
    Slot slot_;
};

}  // namespace

void openEventStream(Stream stream, const beast::http::response_header<>& head,
                     std::shared_ptr<api::MessageStream> messages, Context& context, Slot slot) {
    beast::http::response<beast::http::empty_body> begun(head);
    begun.chunked(true);
    begun.keep_alive(false);
    begun.set("X-Accel-Buffering", "no");  // nginx would hold events back
    std::ostringstream text;
    text << begun.base();
    std::make_shared<EventStream>(std::move(stream), std::move(messages), context, std::move(slot))
        ->begin(text.str());
}

}  // namespace eyrie::http
