// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/web_socket.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>

#include "coordinator/http/message_rate.h"
#include "coordinator/stream/viewer.h"

namespace eyrie::http {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using beast::error_code;
using boost::asio::ip::tcp;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxMessageBytes = 64 * 1024;
constexpr std::chrono::seconds kHandshakeTimeout{10};
/// A peer that is silent for so long, pings included, is gone.
constexpr std::chrono::seconds kIdleTimeout{30};
/// While pictures are under way, the round trip is measured so often.
constexpr std::chrono::milliseconds kPulse{1000};
constexpr char kPulsePayload[] = "pulse";
/// A program has closed the session: viewer.proto.
constexpr std::uint16_t kSessionClosed = 4001;
/// How soon the end of what a viewer had asked for is noticed.
constexpr std::chrono::milliseconds kDrainPoll{5};
/// For the answer to the goodbye of a server that shuts down; who takes longer is cut off.
constexpr std::chrono::milliseconds kGoodbyeTimeout{750};

class WebSocket : public Session, public std::enable_shared_from_this<WebSocket> {
public:
    WebSocket(Stream stream, std::string received, stream::Joining joining, Context& context,
              Slot slot)
        : stream_(std::move(stream)),
          writeDeadline_(stream_.get_executor()),
          pulse_(stream_.get_executor()),
          pause_(stream_.get_executor()),
          drain_(stream_.get_executor()),
          lifeSign_(stream_.get_executor()),
          rate_(context.options.messagesPerSecond),
          received_(std::move(received)),
          joining_(std::move(joining)),
          context_(context),
          slot_(std::move(slot)) {
        context_.sessions.insert(this);
    }

    ~WebSocket() override {
        if (isCounted_)
            context_.telemetry->metrics.viewers(-1);
        abandon();
        context_.sessions.erase(this);
        context_.sessionEnded();
    }

    void accept() {
        error_code ignored;
        beast::get_lowest_layer(stream_).socket().set_option(tcp::no_delay(true), ignored);
        stream_.set_option(websocket::stream_base::timeout{kHandshakeTimeout, kIdleTimeout, true});
        stream_.read_message_max(kMaxMessageBytes);
        stream_.binary(true);
        stream_.auto_fragment(false);
        stream_.async_accept(boost::asio::buffer(received_),
                             [self = shared_from_this()](error_code error) {
                                 if (!error)
                                     self->accepted();
                             });
    }

    void shutDown() override {
        if (viewer_ == nullptr)
            return beast::get_lowest_layer(stream_).cancel();
        viewer_->drain();
        const auto now = std::chrono::steady_clock::now();
        sayGoodbye(now + context_.options.drainTimeout);
    }

    void abandon() override {
        if (viewer_ == nullptr)
            return;
        viewer_->stop();
        // The slot stays taken until the viewer's threads have ended.
        boost::asio::post(context_.reaper,
                          [viewer = std::move(viewer_), slot = std::move(slot_)]() mutable {
                              viewer.reset();
                              slot.reset();
                          });
    }

private:
    /// Once the viewer has nothing more to send, or at `deadline`.
    void sayGoodbye(std::chrono::steady_clock::time_point deadline) {
        if (viewer_ == nullptr)
            return;
        const bool isLate = std::chrono::steady_clock::now() >= deadline;
        if (isLate || (!isWriting_ && viewer_->hasDrained())) {
            close({websocket::close_code::going_away, "the server is shutting down"});
            return awaitAnswer();
        }
        drain_.expires_after(kDrainPoll);
        drain_.async_wait([weak = weak_from_this(), deadline](error_code error) {
            const auto self = weak.lock();
            if (!error && self != nullptr)
                self->sayGoodbye(deadline);
        });
    }

    /// To a goodbye: a viewer that is gone, or stopped, gives none.
    void awaitAnswer() {
        drain_.expires_after(kGoodbyeTimeout);
        drain_.async_wait([weak = weak_from_this()](error_code error) {
            const auto self = weak.lock();
            if (!error && self != nullptr)
                self->end();
        });
    }

    void accepted() {
        received_.clear();
        isCounted_ = true;
        context_.telemetry->metrics.viewers(1);
        viewer_ = std::make_shared<stream::Viewer>(
            context_.viewing, joining_,
            [weak = weak_from_this(), executor = stream_.get_executor()] {
                boost::asio::post(executor, [weak] {
                    if (const auto self = weak.lock())
                        self->write();
                });
            });
        stream_.control_callback([this](websocket::frame_type kind, beast::string_view payload) {
            if (kind == websocket::frame_type::pong && payload == kPulsePayload)
                pongRead();
        });
        showLife();
        read();
    }

    /// Scripts see no pings: a page whose connection died without being closed knows it by this.
    void showLife() {
        lifeSign_.expires_after(context_.options.lifeSign);
        lifeSign_.async_wait([weak = weak_from_this()](error_code error) {
            const auto self = weak.lock();
            if (error || self == nullptr || self->isClosing_)
                return;
            if (!self->isWriting_)
                self->send({});  // a ViewerResponse that says nothing
            self->showLife();
        });
    }

    void read() {
        stream_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
            self->messageRead(error);
        });
    }

    void messageRead(error_code error) {
        if (error)
            return end();
        if (isClosing_)
            return discard();
        if (!stream_.got_binary())
            return close({websocket::close_code::unknown_data, "messages are binary here"});
        const auto data = buffer_.data();
        count(observe::Direction::In, data.size());
        const absl::Status status =
            viewer_->receive({static_cast<const std::byte*>(data.data()), data.size()});
        buffer_.clear();
        if (!status.ok())
            return close({websocket::close_code::bad_payload,
                          std::string(status.message().data(), status.message().size())});
        readInTime();
    }

    /// The next message, when it is due; until then the peer's wait where they are.
    void readInTime() {
        const Clock::duration wait = rate_.take(Clock::now());
        if (wait == Clock::duration::zero())
            return read();
        pause_.expires_after(wait);
        pause_.async_wait([self = shared_from_this()](error_code error) {
            if (!error && !self->isEnded_)
                self->read();
        });
    }

    /// Reads on until the peer's own close arrives.
    void discard() {
        buffer_.clear();
        read();
    }

    /// Sends what the viewer has, one message at a time, so that nothing piles up here.
    void write() {
        if (isClosing_ || viewer_ == nullptr)
            return;
        if (viewer_->isReplaced())
            return end();
        if (viewer_->isClosed())
            return closedByProgram();
        if (isWriting_)
            return;
        std::optional<std::string> message = viewer_->takeMessage();
        if (!message.has_value())
            return;
        if (!isPulsing_)
            beat();
        send(*std::move(message));
    }

    void send(std::string message) {
        isWriting_ = true;
        outgoing_ = std::move(message);
        expectProgress();
        stream_.async_write(boost::asio::buffer(outgoing_),
                            [self = shared_from_this(), begun = std::chrono::steady_clock::now()](
                                error_code error, std::size_t bytes) {
                                self->count(observe::Direction::Out, bytes);
                                self->context_.telemetry->metrics.took(
                                    observe::Stage::Send, std::chrono::steady_clock::now() - begun);
                                self->writeDeadline_.cancel();
                                self->isWriting_ = false;
                                if (!error)
                                    self->write();
                            });
    }

    /// A peer that takes nothing within the time is cut off.
    void expectProgress() {
        writeDeadline_.expires_after(writeTimeout());
        writeDeadline_.async_wait([weak = weak_from_this()](error_code error) {
            const auto self = weak.lock();
            if (!error && self != nullptr)
                self->end();
        });
    }

    /// Measures the round trip, and cuts off a peer that acknowledges nothing within the time: it
    /// may take what the system buffers and still not read. Until nothing is under way.
    void beat() {
        isPulsing_ = true;
        if (!pingedAt_) {
            pingedAt_ = std::chrono::steady_clock::now();
            stream_.async_ping(kPulsePayload, [self = shared_from_this()](error_code) {});
        }
        pulse_.expires_after(std::min<std::chrono::milliseconds>(kPulse, writeTimeout() / 4));
        pulse_.async_wait([weak = weak_from_this()](error_code error) {
            const auto self = weak.lock();
            if (!error && self != nullptr && self->viewer_ != nullptr)
                self->checkUnderWay();
        });
    }

    void checkUnderWay() {
        const auto waited = viewer_->unacknowledgedFor();
        isPulsing_ = waited.has_value() || isWriting_;
        if (waited > writeTimeout())
            end();
        else if (isPulsing_)
            beat();
    }

    void pongRead() {
        if (pingedAt_ && viewer_ != nullptr)
            viewer_->roundTrip(std::chrono::steady_clock::now() - *pingedAt_);
        pingedAt_.reset();
    }

    void count(observe::Direction direction, std::size_t bytes) {
        context_.telemetry->metrics.bytes(observe::Peer::WebSocket, direction, bytes);
    }

    std::chrono::milliseconds writeTimeout() const { return context_.options.writeTimeout; }

    void closedByProgram() {
        websocket::close_reason reason(kSessionClosed);
        reason.reason = "this session was closed";
        close(reason);
    }

    void close(const websocket::close_reason& reason) {
        if (std::exchange(isClosing_, true))
            return;
        abandon();
        stream_.async_close(reason, [self = shared_from_this()](error_code) { self->end(); });
    }

    void end() {
        isClosing_ = true;
        abandon();
        writeDeadline_.cancel();
        pulse_.cancel();
        pause_.cancel();
        drain_.cancel();
        lifeSign_.cancel();
        isEnded_ = true;
        beast::get_lowest_layer(stream_).close();
    }

    websocket::stream<Stream> stream_;
    boost::asio::steady_timer writeDeadline_;
    boost::asio::steady_timer pulse_;
    boost::asio::steady_timer pause_;  ///< before the next message is read
    boost::asio::steady_timer drain_;
    boost::asio::steady_timer lifeSign_;
    MessageRate rate_;
    bool isPulsing_ = false;
    std::optional<std::chrono::steady_clock::time_point> pingedAt_;  ///< and not answered yet
    std::string received_;
    const stream::Joining joining_;
    beast::flat_buffer buffer_;
    std::string outgoing_;
    bool isWriting_ = false;
    bool isClosing_ = false;
    bool isEnded_ = false;
    bool isCounted_ = false;  ///< among the viewers
    Context& context_;
    Slot slot_;
    std::shared_ptr<stream::Viewer> viewer_;
};

}  // namespace

void openWebSocket(Stream stream, std::string received, const stream::Joining& joining,
                   Context& context, Slot slot) {
    std::make_shared<WebSocket>(std::move(stream), std::move(received), joining, context,
                                std::move(slot))
        ->accept();
}

}  // namespace eyrie::http
