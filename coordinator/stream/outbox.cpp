// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/outbox.h"

#include <algorithm>
#include <span>
#include <utility>

namespace eyrie::stream {
namespace {

/// Small enough that something newer never waits long behind one.
constexpr std::size_t kPartBytes = 32 * 1024;
/// Under way in parts at least, so that a link that is not known yet becomes known.
constexpr std::size_t kLeastInParts = 2 * kPartBytes;
constexpr double kSecondsInParts = 0.1;
/// 5 Mbit/s carry them in 0.4 s.
constexpr std::size_t kMostInFrames = 256 * 1024;

bool isStill(const OutgoingFrame& frame) {
    return frame.encoded.picture->fineness != Fineness::Moving;
}

std::size_t headBytes(const OutgoingFrame& frame) {
    const std::size_t whole = frame.encoded.picture->bytes.size();
    return isStill(frame) ? std::min(whole, kPartBytes) : whole;
}

}  // namespace

void Outbox::putFrame(OutgoingFrame frame) {
    dropStill();
    waiting_ = std::move(frame);
}

void Outbox::dropStill() {
    if (waiting_ && isStill(*waiting_))
        waiting_.reset();
    if (rest_)
        pacer_.withdrawn(rest_->frameNumber);
    rest_.reset();
}

bool Outbox::mayTakeFrame(Clock::time_point now) const {
    if (!waiting_ || pacer_.unacknowledged() >= pacer_.window())
        return false;
    const double perRoundTrip = link_.bytesPerSecond(now).value_or(0) *
                                std::chrono::duration<double>(link_.shortestRoundTrip()).count();
    const std::size_t most = std::max(kMostInFrames, static_cast<std::size_t>(perRoundTrip / 2));
    return link_.bytesUnderWay() == 0 || link_.bytesUnderWay() + headBytes(*waiting_) <= most;
}

bool Outbox::mayTakePart(Clock::time_point now) const {
    const double most = link_.bytesPerSecond(now).value_or(0) * kSecondsInParts;
    return rest_ && link_.bytesUnderWay() + kPartBytes <=
                        std::max(kLeastInParts, static_cast<std::size_t>(most));
}

bool Outbox::hasMessage(Clock::time_point now) const {
    return word_ || state_ || mayTakePart(now) || mayTakeFrame(now);
}

std::optional<std::string> Outbox::take(Clock::time_point now) {
    if (word_)
        return std::exchange(word_, std::nullopt);
    if (state_)
        return std::exchange(state_, std::nullopt);
    if (mayTakePart(now))
        return takePart(now);
    return mayTakeFrame(now) ? std::optional(takeFrame(now)) : std::nullopt;
}

std::string Outbox::takeFrame(Clock::time_point now) {
    OutgoingFrame frame = *std::exchange(waiting_, std::nullopt);
    EncodedFrame& encoded = frame.encoded;
    const std::size_t bytes = headBytes(frame);
    const bool isWhole = bytes == encoded.picture->bytes.size();
    encoded.linkBytesPerSecond = link_.bytesPerSecond(now).value_or(0);
    std::string message = frameMessage(encoded, *frame.rendered, bytes);
    pacer_.sent(encoded.frameNumber, frame.started, !isStill(frame));
    link_.sent(encoded.frameNumber, isWhole ? LinkEstimate::kWhole : bytes, message.size(), now);
    if (!isWhole)
        rest_ = Rest{encoded.frameNumber, std::move(encoded.picture), bytes};
    return message;
}

std::string Outbox::takePart(Clock::time_point now) {
    const std::span<const std::byte> left = std::span(rest_->picture->bytes).subspan(rest_->offset);
    const std::span<const std::byte> part = left.first(std::min(left.size(), kPartBytes));
    std::string message = framePartMessage(rest_->frameNumber, rest_->offset, part);
    rest_->offset += part.size();
    link_.sent(rest_->frameNumber, rest_->offset, message.size(), now);
    if (rest_->offset == rest_->picture->bytes.size())
        rest_.reset();
    return message;
}

bool Outbox::hasRoom(int underWay) const {
    return !rest_ && pacer_.unacknowledged() + underWay + (waiting_ ? 1 : 0) < pacer_.window();
}

void Outbox::acknowledged(const FrameAck& ack, Clock::time_point now) {
    const auto decoding = std::chrono::duration_cast<Clock::duration>(ack.decoding);
    link_.arrived(ack.frameNumber, ack.receivedBytes.value_or(LinkEstimate::kWhole),
                  now - decoding);
    if (!ack.receivedBytes)
        pacer_.acknowledged(ack.frameNumber, now);
}

}  // namespace eyrie::stream
