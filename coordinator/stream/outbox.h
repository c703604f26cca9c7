// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "coordinator/stream/link_estimate.h"
#include "coordinator/stream/pacer.h"
#include "coordinator/stream/viewer_messages.h"

namespace eyrie::stream {

/// A frame on its way to one browser.
struct OutgoingFrame {
    EncodedFrame encoded;
    std::shared_ptr<const coordinator::RenderedFrame> rendered;
    Clock::time_point started;  ///< its rendering, or the encoding of one that was drawn before
};

/// What waits to be sent to one browser, and what is under way to it: at most one word (of a
/// picture that is there, so there is no other before it is taken), one state, one frame, and the
/// rest of one still picture.
///
/// Moving frames go whole, as many at once as the Pacer says and no more than would take half a
/// second on a link that has become ten times slower. Still pictures go in parts, a tenth of a
/// second's worth at a time, and a newer frame takes the place of what is left of them. Not
/// thread-safe.
class Outbox {
public:
    /// `framesInFlight` replaces the Pacer's rule.
    explicit Outbox(std::optional<int> framesInFlight) : pacer_(framesInFlight) {}

    /// Replaces one that has not been taken.
    void putState(std::string message) { state_ = std::move(message); }
    void putFrame(OutgoingFrame frame);
    /// The word to show the picture of a swap: goes before anything else.
    void putWord(std::string message) { word_ = std::move(message); }

    /// The view is no longer wanted: what is left of a still picture, or one that waits, is
    /// dropped.
    void dropStill();

    bool hasMessage(Clock::time_point now) const;
    /// The next message: the word, else the state, else a part of a still picture, else the frame.
    std::optional<std::string> take(Clock::time_point now);

    /// A frame has not been taken yet: a finer one of the same view would only take its place.
    bool isWaiting() const { return waiting_.has_value(); }
    /// A word, a frame, or the rest of one, has not been taken yet.
    bool hasUnsent() const { return word_ || waiting_ || rest_; }

    /// Whether one more frame may be started while `underWay` are being made.
    bool hasRoom(int underWay) const;

    void acknowledged(const FrameAck& ack, Clock::time_point now);
    void rendered(Clock::duration time) { pacer_.rendered(time); }
    void roundTrip(Clock::duration time, Clock::time_point now) { link_.roundTrip(time, now); }

    const LinkEstimate& link() const { return link_; }

private:
    bool mayTakeFrame(Clock::time_point now) const;
    bool mayTakePart(Clock::time_point now) const;
    std::string takeFrame(Clock::time_point now);
    std::string takePart(Clock::time_point now);

    Pacer pacer_;
    LinkEstimate link_;
    std::optional<std::string> word_;
    std::optional<std::string> state_;
    std::optional<OutgoingFrame> waiting_;
    struct Rest {
        std::uint64_t frameNumber = 0;
        std::shared_ptr<const EncodedPicture> picture;
        std::size_t offset = 0;  ///< of what has not been taken
    };
    std::optional<Rest> rest_;
};

}  // namespace eyrie::stream
