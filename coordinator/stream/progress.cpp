// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/progress.h"

#include <algorithm>
#include <utility>

namespace eyrie::stream {
namespace {

/// Coarser or smaller than what was asked for, to keep a frame time or for the link's sake.
bool isBelowAsked(const Picture& picture) {
    const fabric::FrameStatistics& statistics = picture.frame->statistics;
    const fabric::PixelViewport& area = picture.frame->image.area;
    return (statistics.budget && statistics.budget->tauPixels > statistics.tauAskedPixels) ||
           area.width != picture.view.frame.width || area.height != picture.view.frame.height;
}

bool isSame(const ViewRequest& a, const ViewRequest& b) {
    return a.frame == b.frame && a.isUnderground == b.isUnderground;
}

}  // namespace

bool Progress::want(const ViewRequest& view, Clock::time_point now) {
    const bool isOther = !wanted_.has_value() || !isSame(*wanted_, view);
    wanted_ = view;
    if (!isOther)
        return false;
    isRenderNeeded_ = true;
    wantedSince_ = now;
    retryAt_.reset();
    redrawAt_.reset();
    isLoading_ = false;
    return true;
}

void Progress::sourceChanged() {
    if (!wanted_.has_value())
        return;
    isRenderNeeded_ = true;
    retryAt_.reset();
}

bool Progress::hasRested(Clock::time_point now) const {
    return now >= wantedSince_ + options_.restDelay;
}

bool Progress::isWaitingToRetry(Clock::time_point now) const {
    return retryAt_.has_value() && now < *retryAt_;
}

bool Progress::mayRender(Clock::time_point now) const {
    const bool isRedrawDue = redrawAt_.has_value() && now >= *redrawAt_;
    return (isRenderNeeded_ || isRedrawDue || (needsFull() && hasRested(now))) &&
           wanted_.has_value() && !rendered_.has_value() && !isWaitingToRetry(now);
}

/// The last picture shows the view that is wanted.
bool Progress::isShown() const {
    return last_.has_value() && !isRenderNeeded_ && !isLoading_ && rendering_ == 0 &&
           !rendered_.has_value() && isSame(last_->view, *wanted_);
}

/// It was drawn within a limit: at rest the view is drawn once more, without.
bool Progress::needsFull() const { return isShown() && isBelowAsked(*last_); }

bool Progress::needsFiner() const {
    return isShown() && lastFineness_ != Fineness::Exact && !isBelowAsked(*last_);
}

std::optional<Clock::time_point> Progress::nextRender(Clock::time_point now) const {
    if (isWaitingToRetry(now))
        return retryAt_;
    if (needsFull() && !hasRested(now))
        return wantedSince_ + options_.restDelay;
    return redrawAt_.has_value() && now >= *redrawAt_ ? std::nullopt : redrawAt_;
}

void Progress::renderStarted() {
    isRenderNeeded_ = false;
    redrawAt_.reset();
    ++rendering_;
}

void Progress::rendered(Picture picture, Clock::time_point now) {
    --rendering_;
    retryAt_.reset();
    if (picture.started < std::exchange(newest_, std::max(newest_, picture.started)))
        return;
    const fabric::FrameStatistics& statistics = picture.frame->statistics;
    if (isSame(picture.view, *wanted_)) {
        isLoading_ = !statistics.complete && (statistics.pagesMissing == 0 ||
                                              statistics.pagesFailed < statistics.pagesMissing);
        if (!statistics.complete)
            redrawAt_ = now + (isLoading_ ? options_.loadingDelay : options_.missingDelay);
    }
    rendered_ = std::move(picture);
}

void Progress::renderFailed(Clock::time_point now) {
    --rendering_;
    // A newer view is drawn at once; the same one, after a while.
    if (!isRenderNeeded_)
        retryAt_ = now + options_.retryDelay;
    isRenderNeeded_ = true;
}

std::optional<Picture> Progress::takePicture(bool hasRoom, Clock::time_point now) {
    std::optional<Picture> picture;
    if (rendered_.has_value()) {
        picture = std::exchange(rendered_, std::nullopt);
    } else if (needsFiner() && hasRested(now) && hasRoom) {
        picture = last_;
        picture->started = now;
    } else {
        return std::nullopt;
    }
    isEncoding_ = true;
    // The same view may have come again meanwhile: this is the answer to that, too.
    if (isSame(picture->view, *wanted_))
        picture->view.sequence = wanted_->sequence;
    return picture;
}

std::optional<Clock::time_point> Progress::nextFiner(Clock::time_point now) const {
    if (!needsFiner() || hasRested(now))
        return std::nullopt;
    return wantedSince_ + options_.restDelay;
}

Fineness Progress::fineness(const Picture& picture, Clock::time_point now) const {
    if (!hasRested(now) || !isSame(picture.view, *wanted_) || isRenderNeeded_ || isLoading_ ||
        isBelowAsked(picture))
        return Fineness::Moving;
    const bool isOfLast = last_.has_value() && last_->frame == picture.frame;
    return isOfLast && lastFineness_ == Fineness::Fine ? Fineness::Exact : Fineness::Fine;
}

void Progress::encoded(Picture picture, Fineness fineness, bool isLost) {
    isEncoding_ = false;
    lastFineness_ = isLost ? Fineness::Exact : fineness;
    last_ = std::move(picture);
}

int Progress::underWay() const {
    return rendering_ + (rendered_.has_value() ? 1 : 0) + (isEncoding_ ? 1 : 0);
}

}  // namespace eyrie::stream
