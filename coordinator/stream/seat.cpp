// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/seat.h"

#include <algorithm>

namespace eyrie::stream {
namespace {

/// Of round trips, over networks that have slow links; within a house they are shorter.
constexpr std::chrono::milliseconds kFarAway{8};

}  // namespace

bool Seat::mayGetVideo() const {
    return showsVideo && !screen && barrier.empty() &&
           outbox.link().shortestRoundTrip() >= kFarAway;
}

bool Seat::getsVideo() const {
    return quality.codec() == Codec::H264 && !screen && barrier.empty();
}

std::optional<QualityClass> Seat::due(const Progress& progress, Clock::time_point now) const {
    if (isServed || !outbox.hasRoom(0))
        return std::nullopt;
    const std::optional<Fineness> fineness = progress.next(delivered, now);
    if (!fineness)
        return std::nullopt;
    const std::optional<QualityClass> moving = movingClass(*progress.newest());
    if (!moving)
        return std::nullopt;
    if (*fineness == Fineness::Moving && getsVideo()) {
        // The next one needs the one that waits, which is not to be replaced.
        if (outbox.isWaiting())
            return std::nullopt;
        return QualityClass{*fineness, QualityControl::streamLevel(moving->level), Codec::H264,
                            moving->output};
    }
    if (*fineness == Fineness::Moving)
        return moving;
    // A finer one of the same view would only take the place of one that waits.
    return outbox.isWaiting()
               ? std::nullopt
               : std::optional(QualityClass{*fineness, 0, Codec::Jpeg, moving->output});
}

std::optional<QualityClass> Seat::movingClass(const Picture& picture) const {
    const auto wanted = shown(picture.view.frame.shown.front());
    const auto asked = wanted ? std::ranges::find(picture.shown, *wanted) : picture.shown.end();
    if (asked == picture.shown.end())
        return std::nullopt;
    const auto position = static_cast<std::size_t>(asked - picture.shown.begin());
    // Of separate eyes, the first.
    const auto& pictures = picture.frame->pictures;
    const auto made = std::ranges::find(pictures, position, &coordinator::PictureFacts::shown);
    if (made == pictures.end())
        return std::nullopt;
    const int level = std::max(quality.index(), picture.level);
    const std::size_t tiles = picture.frame->tiles.size();
    const bool asTiles = level == picture.level && (tiles == 1 || (tiles > 1 && showsTiles));
    return QualityClass{Fineness::Moving, level, Codec::Jpeg,
                        static_cast<std::size_t>(made - pictures.begin()), asTiles};
}

std::optional<coordinator::Shown> Seat::shown(const coordinator::Shown& asked) const {
    if (!screen)
        return asked;
    if (!screen->isChecked)
        return std::nullopt;
    return screen->problem.empty() ? screen->shown : asked;
}

bool Seat::isReadyForMore(const Progress& progress) const {
    const std::shared_ptr<const Picture>& newest = progress.newest();
    // One that is not of its screen is not for it.
    const bool hasNewest =
        newest == nullptr || delivered.picture == newest->number || !movingClass(*newest);
    return hasNewest && outbox.hasRoom(progress.rendering() + (isServed ? 1 : 0));
}

void Seat::give(std::shared_ptr<const EncodedPicture> encoded, const QualityClass& as,
                const Picture& picture, const Progress& progress, Clock::time_point now,
                std::uint64_t swap) {
    const double pixels = static_cast<double>(picture.view.frame.width) * picture.view.frame.height;
    // Keys are larger than what follows, and few.
    if (as.fineness == Fineness::Moving && !(encoded->video && encoded->video->isKey))
        quality.encoded(as.level, encoded->bytes.size(), pixels,
                        encoded->video ? Codec::H264 : Codec::Jpeg);
    if (encoded->video)
        video = encoded->video;
    else if (outbox.isWaiting())
        video.reset();  // what waits is replaced, and may be of a stream
    last = {encoded->width, encoded->height,
            encoded->video                         ? SentAs::H264
            : encoded->fineness == Fineness::Exact ? SentAs::Png
                                                   : SentAs::Jpeg};
    EncodedFrame frame;
    frame.frameNumber = ++lastFrameNumber_;
    frame.picture = std::move(encoded);
    frame.output = as.output;
    frame.swap = swap;
    frame.liftedCamera = picture.liftedCamera;
    frame.lift = picture.lift;
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
