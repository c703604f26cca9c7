// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <tuple>

#include "coordinator/observe/stage_timer.h"
#include "coordinator/stream/session_impl.h"
#include "fabric/log.h"
#include "fabric/status.h"

namespace eyrie::stream {
namespace {

/// After so many others a viewer's picture is made before those of better links.
constexpr int kMostPassedOver = 2;

}  // namespace

void Session::Impl::encodeLoop() {
    std::unique_lock lock(mutex_);
    while (!isStopping_) {
        const Clock::time_point now = Clock::now();
        arrangeGroups();
        if (endLateSwaps(lock))
            continue;
        if (isStateStale_)
            composeStates(lock);
        else if (const std::shared_ptr<Swap> swap = nextSwap(now))
            serveTogether(lock, *swap);
        else if (const std::optional<QualityClass> next = nextClass(now))
            serve(lock, *next);
        else
            waitForChange(
                lock, sooner(isDraining_ ? std::nullopt : progress_.nextFiner(now), deadline()));
    }
}

/// At the end nothing is sent finer than it was asked for.
std::optional<QualityClass> Session::Impl::dueNow(const Seat& seat, Clock::time_point now) const {
    if ((isDraining_ && hasNewest(seat)) || awaitsSwap(seat))
        return std::nullopt;
    const auto due = seat.due(progress_, now);
    const bool isLost = due && due->codec == Codec::H264 &&
                        !videos_.mayFollow(due->level, seat.video, progress_.newest()->number, now);
    if (!isLost)
        return due;
    return QualityClass{due->fineness,
                        std::max(seat.quality.jpegIndex(), progress_.newest()->level), Codec::Jpeg,
                        due->output};
}

/// Who waits for long first, then moving pictures before still ones, and better links, which
/// are quicker served, before worse.
std::optional<QualityClass> Session::Impl::nextClass(Clock::time_point now) const {
    std::optional<std::tuple<bool, QualityClass>> best;
    for (const auto& seat : seats_)
        if (const auto due = dueNow(*seat, now)) {
            const std::tuple key(seat->timesPassedOver < kMostPassedOver, *due);
            if (!best || key < *best)
                best = key;
        }
    return best ? std::optional(std::get<QualityClass>(*best)) : std::nullopt;
}

/// Those who are to get a picture of that class now; it is theirs from now on.
Seats Session::Impl::takeDue(const QualityClass& as, Clock::time_point now) {
    Seats served;
    for (const auto& seat : seats_) {
        const auto due = dueNow(*seat, now);
        if (due == as) {
            seat->delivered = {progress_.newest()->number, as.fineness};
            seat->isServed = true;
            seat->timesPassedOver = 0;
            served.push_back(seat);
        } else if (due) {
            ++seat->timesPassedOver;
        }
    }
    return served;
}

void Session::Impl::serve(std::unique_lock<std::mutex>& lock, const QualityClass& as) {
    const std::shared_ptr<const Picture> picture = progress_.newest();
    Seats behind;  // for whom it is new: they are to say when it is there
    for (const auto& seat : seats_)
        if (groupOf(*seat) != nullptr && seat->delivered.picture != picture->number)
            behind.push_back(seat);
    const Seats served = takeDue(as, Clock::now());
    const absl::StatusOr<std::shared_ptr<const EncodedPicture>> encoded =
        encodingOf(lock, picture, as, served);
    for (const auto& seat : served) seat->isServed = false;
    if (!encoded.ok()) {
        setProblem(renderProblem_, problemOf(encoded.status()));
        for (const auto& seat : served) seat->delivered.fineness = Fineness::Exact;  // given up
    } else if (as.fineness == Fineness::Moving || isStillBest(*picture)) {
        // A still picture that is no longer wanted would only stand in the way of the next.
        for (const auto& seat : served) {
            const auto group = groups_.find(seat->barrier);
            const bool waits = std::ranges::find(behind, seat) != behind.end() &&
                               group != groups_.end() && !group->second.isInStep(seat->id);
            give(*seat, *encoded, as, *picture, waits ? picture->number : 0);
            if (waits)
                group->second.given(seat->id, picture->number, Clock::now());
        }
        replaceWaiting(*encoded, as, *picture);
    }
    tell(lock);
}

bool Session::Impl::isStillBest(const Picture& picture) const {
    return progress_.isBest() && progress_.newest()->number == picture.number &&
           progress_.hasRested(Clock::now());
}

void Session::Impl::give(Seat& seat, const std::shared_ptr<const EncodedPicture>& encoded,
                         const QualityClass& as, const Picture& picture, std::uint64_t swap) {
    ++counts_.given;
    seat.give(encoded, as, picture, progress_, Clock::now(), swap);
}

/// A picture that has not gone out yet is older than this one, which is there already.
void Session::Impl::replaceWaiting(const std::shared_ptr<const EncodedPicture>& encoded,
                                   const QualityClass& as, const Picture& picture) {
    if (as.fineness != Fineness::Moving || as.codec != Codec::Jpeg)
        return;
    for (const auto& seat : seats_) {
        if (seat->getsVideo())
            continue;
        const bool isOfClass = seat->movingClass(picture) == as;
        if (seat->isServed || groupOf(*seat) != nullptr || isInSwap(*seat) ||
            !seat->outbox.isWaiting() || !isOfClass || seat->delivered.picture >= picture.number)
            continue;
        seat->delivered = {picture.number, as.fineness};
        give(*seat, encoded, as, picture);
    }
}

/// Made now, or before for others.
absl::StatusOr<std::shared_ptr<const EncodedPicture>> Session::Impl::encodingOf(
    std::unique_lock<std::mutex>& lock, const std::shared_ptr<const Picture>& picture,
    const QualityClass& as, const Seats& served) {
    if (const auto known = encodings_.find(as); known != encodings_.end())
        return known->second;
    const bool needsKey = std::ranges::any_of(served, [&](const std::shared_ptr<Seat>& seat) {
        return videos_.needsKey(as.level, seat->video);
    });
    const int jpegLevel = worstJpegLevel(served, *picture);
    lock.unlock();
    observe::StageTimer timer(telemetry_.get(), observe::Stage::Encode, encoding_);
    const Clock::time_point now = Clock::now();
    absl::StatusOr<EncodedPicture> encoded =
        as.codec == Codec::H264 ? encodeVideo(*picture, as, needsKey, jpegLevel, now)
                                : encodePicture(*picture, as);
    timer.stop();
    lock.lock();
    if (encoded.ok() && encoded->video)
        videos_.coded(as.level, *encoded->video, picture->number, now);
    if (!encoded.ok())
        return encoded.status();
    ++counts_.encoded;
    auto shared = std::make_shared<const EncodedPicture>(*std::move(encoded));
    if (progress_.newest() == picture)
        encodings_[as] = shared;
    return shared;
}

/// A JPEG in place of a stream's picture is one that all of them have room for.
int Session::Impl::worstJpegLevel(const Seats& served, const Picture& picture) {
    int level = picture.level;
    for (const auto& seat : served) level = std::max(level, seat->quality.jpegIndex());
    return level;
}

/// Without the lock. A JPEG of `jpegLevel` where the stream cannot go on yet, or not at all.
absl::StatusOr<EncodedPicture> Session::Impl::encodeVideo(const Picture& picture,
                                                          const QualityClass& as, bool asKey,
                                                          int jpegLevel, Clock::time_point now) {
    ASSIGN_OR_RETURN(const std::shared_ptr<const fabric::Image> pixels, pixelsFor(picture, as));
    const fabric::Image& image = *pixels;
    absl::StatusOr<std::optional<VideoStreams::Coded>> coded =
        videos_.encode(as.level, image, QualityControl::level(as.level).rateFactor, asKey, now);
    if (!coded.ok()) {
        spdlog::warn("moving pictures go as JPEG from now on: {}", problemOf(coded.status()));
        const std::lock_guard lock(mutex_);
        videos_.giveUp();
    }
    if (!coded.ok() || !*coded)
        return encodePicture(picture, {as.fineness, jpegLevel, Codec::Jpeg, as.output});
    EncodedPicture encoded;
    encoded.width = image.area.width;
    encoded.height = image.area.height;
    encoded.bytes = std::move((*coded)->picture.bytes);
    encoded.video = (*coded)->place;
    return encoded;
}

}  // namespace eyrie::stream
