// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/progress.h"

#include <utility>

namespace eyrie::stream {
namespace {

/// Coarser or smaller than what was asked for, or encoded before it came here.
bool isBelowAsked(const Picture& picture) {
    const fabric::FrameStatistics& statistics = picture.frame->statistics;
    return (statistics.budget && statistics.budget->tauPixels > statistics.tauAskedPixels) ||
           !picture.frame->tiles.empty() || picture.isReduced;
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

void Progress::seenOtherwise(Clock::time_point now) {
    sourceChanged();
    wantedSince_ = now;
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
           wanted_.has_value() && !isWaitingToRetry(now);
}

/// The newest picture shows the view that is wanted.
bool Progress::isShown() const {
    return newest_ != nullptr && !isRenderNeeded_ && !isLoading_ && rendering_ == 0 &&
           isSame(newest_->view, *wanted_);
}

/// It was drawn within a limit: at rest the view is drawn once more, without.
bool Progress::needsFull() const { return isShown() && isBelowAsked(*newest_); }

bool Progress::isBest() const { return isShown() && !isBelowAsked(*newest_); }

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
    if (newest_ != nullptr && picture.started < newest_->started)
        return;
    const fabric::FrameStatistics& statistics = picture.frame->statistics;
    if (isSame(picture.view, *wanted_)) {
        isLoading_ = !statistics.complete && (statistics.pagesMissing == 0 ||
                                              statistics.pagesFailed < statistics.pagesMissing);
        if (!statistics.complete)
            redrawAt_ = now + (isLoading_ ? options_.loadingDelay : options_.missingDelay);
    }
    picture.number = ++lastNumber_;
    newest_ = std::make_shared<const Picture>(std::move(picture));
}

void Progress::renderFailed(Clock::time_point now) {
    --rendering_;
    // A newer view is drawn at once; the same one, after a while.
    if (!isRenderNeeded_)
        retryAt_ = now + options_.retryDelay;
    isRenderNeeded_ = true;
}

std::optional<Fineness> Progress::next(const Delivered& delivered, Clock::time_point now) const {
    if (newest_ == nullptr)
        return std::nullopt;
    const bool mayBeStill = isBest() && hasRested(now);
    if (delivered.picture != newest_->number)
        return mayBeStill ? Fineness::Fine : Fineness::Moving;
    if (!mayBeStill || delivered.fineness == Fineness::Exact)
        return std::nullopt;
    return delivered.fineness == Fineness::Fine ? Fineness::Exact : Fineness::Fine;
}

std::optional<Clock::time_point> Progress::nextFiner(Clock::time_point now) const {
    if (!isBest() || hasRested(now))
        return std::nullopt;
    return wantedSince_ + options_.restDelay;
}

const ViewRequest& Progress::answered(const Picture& picture) const {
    return isSame(picture.view, *wanted_) ? *wanted_ : picture.view;
}

}  // namespace eyrie::stream
