// SPDX-License-Identifier: Apache-2.0
#include "tests/support/viewer_client.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>

namespace eyrie::test {
namespace {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using Clock = std::chrono::steady_clock;

}  // namespace

class ViewerClient::Impl {
public:
    absl::Status open(std::uint16_t port, const std::string& query) {
        boost::system::error_code error;
        stream_.next_layer().connect({asio::ip::address_v4::loopback(), port}, error);
        if (!error)
            stream_.handshake(fmt::format("127.0.0.1:{}", port), "/ws" + query, error);
        stream_.binary(true);
        stream_.read_message_max(64 << 20);
        return error ? absl::UnavailableError(fmt::format("port {}: {}", port, error.message()))
                     : absl::OkStatus();
    }

    absl::Status write(const std::string& bytes) {
        boost::system::error_code error;
        stream_.write(asio::buffer(bytes), error);
        return error ? absl::UnavailableError(error.message()) : absl::OkStatus();
    }

    /// A read that does not end in time stays under way for the next call.
    absl::StatusOr<std::string> read(Milliseconds limit) {
        if (!reading_) {
            reading_ = true;
            stream_.async_read(buffer_, [this](boost::system::error_code error, std::size_t) {
                reading_ = false;
                readError_ = error;
            });
        }
        io_.restart();
        const auto end = Clock::now() + limit;
        while (reading_ && io_.run_one_until(end) != 0) {
        }
        if (reading_)
            return absl::DeadlineExceededError("no message in time");
        if (readError_)
            return absl::UnavailableError(readError_.message());
        std::string bytes = boost::beast::buffers_to_string(buffer_.data());
        buffer_.consume(buffer_.size());
        return bytes;
    }

private:
    asio::io_context io_;
    websocket::stream<asio::ip::tcp::socket> stream_{io_};
    boost::beast::flat_buffer buffer_;
    bool reading_ = false;
    boost::system::error_code readError_;
};

ViewerClient::ViewerClient(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ViewerClient::~ViewerClient() = default;

absl::StatusOr<std::unique_ptr<ViewerClient>> ViewerClient::connect(std::uint16_t port,
                                                                    const std::string& query) {
    auto impl = std::make_unique<Impl>();
    if (const absl::Status status = impl->open(port, query); !status.ok())
        return status;
    return std::unique_ptr<ViewerClient>(new ViewerClient(std::move(impl)));
}

absl::Status ViewerClient::send(const v1::ViewerRequest& request) {
    return impl_->write(request.SerializeAsString());
}

absl::StatusOr<v1::ViewerResponse> ViewerClient::receive(Milliseconds limit) {
    const absl::StatusOr<std::string> bytes = impl_->read(limit);
    if (!bytes.ok())
        return bytes.status();
    v1::ViewerResponse response;
    if (!response.ParseFromString(*bytes))
        return absl::InternalError("a message is no ViewerResponse");
    if (response.has_state())
        state_ = response.state();
    return response;
}

namespace {

std::string& pictureOf(v1::Frame& frame) {
    return frame.has_png() ? *frame.mutable_png() : *frame.mutable_jpeg();
}

}  // namespace

absl::Status ViewerClient::acknowledge(const v1::Frame& frame, std::size_t received) {
    v1::ViewerRequest request;
    request.mutable_frame_ack()->set_frame_number(frame.frame_number());
    if (received < frame.picture_bytes())
        request.mutable_frame_ack()->set_received_bytes(received);
    return send(request);
}

absl::StatusOr<v1::Frame> ViewerClient::frameOf(const v1::ViewRequest& view, Milliseconds limit) {
    return frameOf(view, limit, Wanted::Any);
}

absl::StatusOr<v1::Frame> ViewerClient::exactFrameOf(const v1::ViewRequest& view,
                                                     Milliseconds limit) {
    return frameOf(view, limit, Wanted::Exact);
}

absl::StatusOr<v1::Frame> ViewerClient::frameOf(const v1::ViewRequest& view, Milliseconds limit,
                                                Wanted wanted) {
    v1::ViewerRequest request;
    *request.mutable_view() = view;
    if (const absl::Status status = send(request); !status.ok())
        return status;
    v1::Frame frame;
    const auto end = Clock::now() + limit;
    while (Clock::now() < end) {
        const auto left = std::chrono::duration_cast<Milliseconds>(end - Clock::now());
        const absl::StatusOr<v1::ViewerResponse> response = receive(left);
        if (absl::IsDeadlineExceeded(response.status()))
            break;
        if (!response.ok())
            return response.status();
        if (response->has_frame())
            frame = response->frame();
        else if (response->has_frame_part())
            pictureOf(frame) += response->frame_part().bytes();
        else
            continue;
        const std::size_t received = pictureOf(frame).size();
        if (const absl::Status status = acknowledge(frame, received); !status.ok())
            return status;
        if (received == frame.picture_bytes() && frame.view_sequence() >= view.sequence() &&
            (wanted == Wanted::Any || frame.has_png()))
            return frame;
    }
    return absl::DeadlineExceededError(
        fmt::format("no frame of view {} in time; the state's problem is '{}'", view.sequence(),
                    state_.problem()));
}

}  // namespace eyrie::test
