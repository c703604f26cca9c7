// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/seat.h"

#include <algorithm>

namespace eyrie::stream {
namespace {

/// Of round trips, over networks that have slow links; within a house they are shorter.
constexpr std::chrono::milliseconds kFarAway{8};

}  // namespace

bool Seat::mayGetVideo() const {
    return showsVideo && outbox.link().shortestRoundTrip() >= kFarAway;
}

std::optional<QualityClass> Seat::due(const Progress& progress, Clock::time_point now) const {
    if (isServed || !outbox.hasRoom(0))
        return std::nullopt;
    const std::optional<Fineness> fineness = progress.next(delivered, now);
    if (!fineness)
        return std::nullopt;
    if (*fineness == Fineness::Moving && quality.codec() == Codec::H264) {
        // The next one needs the one that waits, which is not to be replaced.
        if (outbox.isWaiting())
            return std::nullopt;
        const int level = std::max(quality.index(), progress.newest()->level);
        return QualityClass{*fineness, QualityControl::streamLevel(level), Codec::H264};
    }
    if (*fineness == Fineness::Moving)
        return QualityClass{*fineness, std::max(quality.index(), progress.newest()->level)};
    // A finer one of the same view would only take the place of one that waits.
    return outbox.isWaiting() ? std::nullopt : std::optional(QualityClass{*fineness, 0});
}

bool Seat::isReadyForMore(const Progress& progress) const {
    const bool hasNewest =
        progress.newest() == nullptr || delivered.picture == progress.newest()->number;
    return hasNewest && outbox.hasRoom(progress.rendering() + (isServed ? 1 : 0));
}

void Seat::give(std::shared_ptr<const EncodedPicture> encoded, const QualityClass& as,
                const Picture& picture, const Progress& progress, Clock::time_point now) {
    const double pixels = static_cast<double>(picture.view.frame.width) * picture.view.frame.height;
    // Keys are larger than what follows, and few.
    if (as.fineness == Fineness::Moving && !(encoded->video && encoded->video->isKey))
        quality.encoded(as.level, encoded->bytes.size(), pixels,
                        encoded->video ? Codec::H264 : Codec::Jpeg);
    if (encoded->video)
        video = encoded->video;
    else if (outbox.isWaiting())
        video.reset();  // what waits is replaced, and may be of a stream
    EncodedFrame frame;
    frame.frameNumber = ++lastFrameNumber_;
    frame.picture = std::move(encoded);
    frame.liftedCamera = picture.liftedCamera;
    const ViewRequest& view = progress.answered(picture);
    if (view.viewer == id)
        frame.viewSequence = view.sequence;
    else
        frame.ledView = view;
    // One that had to wait for its room says nothing of how long frames take.
    outbox.putFrame({std::move(frame), picture.frame, isAwaiting ? picture.started : now});
}

void Seat::tell() {
    const std::lock_guard lock(telling_);
    if (messageReady_)
        messageReady_();
}

void Seat::close() {
    const std::lock_guard lock(telling_);
    messageReady_ = nullptr;
}

}  // namespace eyrie::stream
