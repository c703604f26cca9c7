// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "coordinator/stream/session_impl.h"

namespace eyrie::stream {
namespace {

/// One frame in so many has its stages measured, which costs its vertices once more: the fourth
/// first, since shaders are compiled in the ones before.
constexpr std::uint64_t kFramesToAMeasurement = 32;

double pixelsOf(const ViewRequest& view) {
    return static_cast<double>(view.frame.width) * view.frame.height;
}

}  // namespace

bool Session::Impl::mayRender() const {
    const Clock::time_point now = Clock::now();
    return !isStarting_ && progress_.mayRender(now) &&
           (!isDraining_ || progress_.owesPicture(now)) &&
           std::ranges::any_of(seats_, [this](const std::shared_ptr<Seat>& seat) {
               return seat->isReadyForMore(progress_);
           });
}

void Session::Impl::renderLoop() {
    std::unique_lock lock(mutex_);
    while (!isStopping_) {
        if (switch_ && !isAsking_)
            switchLayout(lock);
        else if (const std::shared_ptr<Seat> unchecked = isAsking_ ? nullptr : uncheckedScreen())
            checkScreen(lock, unchecked);
        else if (mayRender())
            renderOne(lock);
        else
            waitForChange(lock, isDraining_ || isStarting_ ? std::nullopt
                                                           : progress_.nextRender(Clock::now()));
    }
}

/// Waits for frames of others, so it is done here and not where messages arrive. The last that is
/// asked for decides what is shown, and why it failed is what is told.
void Session::Impl::switchLayout(std::unique_lock<std::mutex>& lock) {
    const coordinator::SwitchLayout change = *std::exchange(switch_, std::nullopt);
    isAsking_ = true;
    lock.unlock();
    const absl::Status status = frames_.configure(change);
    lock.lock();
    isAsking_ = false;
    if (leader_ != nullptr)
        setProblem(leader_->refusal, status.ok() ? "" : problemOf(status));
    changed_.notify_all();
}

/// Once more, where the newest picture was drawn without somebody's screen.
void Session::Impl::drawForAll() {
    const std::shared_ptr<const Picture>& newest = progress_.newest();
    if (newest == nullptr)
        return;
    for (const auto& seat : seats_)
        if (const auto shown = seat->shown(newest->view.frame.shown.front());
            shown && std::ranges::find(newest->shown, *shown) == newest->shown.end())
            return progress_.sourceChanged();
}

std::shared_ptr<Seat> Session::Impl::uncheckedScreen() const {
    const auto found = std::ranges::find_if(seats_, [](const std::shared_ptr<Seat>& seat) {
        return seat->screen && seat->screen->isToBeChecked;
    });
    return found == seats_.end() ? nullptr : *found;
}

/// Whether there is such a screen: one that there is not would leave all without a picture. Those
/// in which nobody can pick are there. Waits for frames that are being planned.
void Session::Impl::checkScreen(std::unique_lock<std::mutex>& lock,
                                const std::shared_ptr<Seat>& seat) {
    seat->screen->isToBeChecked = false;
    const coordinator::Shown shown = seat->screen->shown;
    coordinator::FrameRequest request;
    if (progress_.wanted())
        request = progress_.wanted()->frame;
    request.shown = {shown};
    isAsking_ = true;
    lock.unlock();
    absl::Status status = frames_.seen(request).status();
    if (absl::IsUnimplemented(status))
        status = absl::OkStatus();
    lock.lock();
    isAsking_ = false;
    changed_.notify_all();
    if (!seat->screen || seat->screen->shown != shown)
        return;  // it is another by now
    if (seat->screen->problem.empty() != status.ok())
        seat->delivered = {};  // it shows another from now on
    seat->screen->isChecked = true;
    seat->screen->problem = status.ok() ? "" : problemOf(status);
    drawForAll();
    isStateStale_ = true;
}

/// The pictures that are seen, each once.
std::vector<coordinator::Shown> Session::Impl::screens(const coordinator::Shown& asked) const {
    std::vector<coordinator::Shown> screens;
    for (const auto& seat : seats_)
        if (const auto shown = seat->shown(asked);
            shown && std::ranges::find(screens, *shown) == screens.end())
            screens.push_back(*shown);
    return screens.empty() ? std::vector{asked} : screens;
}

/// The best level that a link of the viewers takes: a picture for it serves the others, too.
int Session::Impl::chooseLevel(const ViewRequest& view, Clock::time_point now) {
    int best = QualityControl::levelCount() - 1;
    for (const auto& seat : seats_) {
        seat->isAwaiting = seat->isReadyForMore(progress_);
        const bool mayBeVideo =
            seat->mayGetVideo() && videos_.canCode(view.frame.width, view.frame.height);
        seat->quality.adapt(seat->outbox.link().bytesPerSecond(now), pixelsOf(view), now,
                            mayBeVideo);
        best = std::min(best, seat->quality.index());
    }
    return best;
}

/// All viewers get JPEGs of that level, and one that renderers have encoded is for each of them.
bool Session::Impl::mayComeEncoded(int level) const {
    return !seats_.empty() && std::ranges::all_of(seats_, [&](const std::shared_ptr<Seat>& seat) {
        return seat->showsTiles && !seat->getsVideo() && seat->quality.index() == level;
    });
}

/// The newest view, when its frame's turn has come. With mutex_ held.
Session::Impl::Begun Session::Impl::begin() {
    Begun begun{*progress_.wanted(), {}, Clock::now()};
    const bool isAtRest = progress_.hasRested(begun.at);
    begun.level = chooseLevel(begun.view, begun.at);
    const PictureSource* source = source_ ? &*source_ : nullptr;
    const double scale = isAtRest ? 1
                                  : std::min(QualityControl::level(begun.level).scale,
                                             movingScale(begun.view, source));
    begun.request = drawingOf(begun.view, source != nullptr ? &source->sceneInfo : nullptr, scale);
    begun.lift = liftOf(begun.view, source != nullptr ? &source->sceneInfo : nullptr);
    // A frozen cut is not to follow the time that frames take.
    if (isAtRest || begun.request.look.cutCamera)
        begun.request.budgetMilliseconds.reset();
    begun.request.session = number_;
    begun.request.stop = over_.get_token();
    begun.request.shown = screens(begun.view.frame.shown.front());
    if (!isAtRest && begun.request.shown.size() == 1 && mayComeEncoded(begun.level))
        begun.request.jpegQuality = QualityControl::level(begun.level).quality;
    // Measuring has no place in a limited time.
    begun.request.measuresStages =
        !begun.request.budgetMilliseconds && ++requested_ % kFramesToAMeasurement == 4;
    isStarting_ = false;
    progress_.renderStarted();
    return begun;
}

void Session::Impl::renderOne(std::unique_lock<std::mutex>& lock) {
    isStarting_ = true;
    std::optional<Begun> begun;
    lock.unlock();
    absl::StatusOr<coordinator::RenderedFrame> frame = frames_.renderLatest(
        [&]() -> std::optional<coordinator::FrameRequest> {
            const std::lock_guard choosing(mutex_);
            if (isStopping_)
                return std::nullopt;
            begun = begin();
            changed_.notify_all();  // another may get in line
            return begun->request;
        },
        over_.get_token());
    lock.lock();
    if (!begun)
        begun = begin();
    rendered(*begun, std::move(frame));
    changed_.notify_all();
}

/// With mutex_ held.
void Session::Impl::rendered(const Begun& begun, absl::StatusOr<coordinator::RenderedFrame> frame) {
    const Clock::time_point now = Clock::now();
    if (frame.ok()) {
        ++counts_.drawn;
        // Of frames at the same time each takes what it adds.
        const Clock::time_point from = std::max(begun.at, std::exchange(lastRendered_, now));
        for (const auto& seat : seats_) seat->outbox.rendered(now - from);
        setProblem(renderProblem_, coordinator::whyEmpty(*frame));
        setProblem(renderNote_, coordinator::whyPartlyEmpty(*frame));
        const fabric::PictureSides drawn = drawnSides(begun.request, frame->image.area);
        tellAtFullSize(frame->statistics, begun.view, drawn);
        if (statistics_ != nullptr)
            statistics_->drawn(id_, *frame, number_);
        Picture picture{begun.view,
                        std::make_shared<const coordinator::RenderedFrame>(*std::move(frame)),
                        begun.at};
        picture.level = begun.level;
        picture.isReduced = stretchOf(begun.view, drawn) > 1;
        picture.shown = begun.request.shown;
        if (!(begun.request.camera == begun.view.frame.camera))
            picture.liftedCamera = begun.request.camera;
        picture.lift = begun.lift;
        progress_.rendered(std::move(picture), now);
        drawForAll();
        encodings_.clear();
    } else {
        setProblem(renderProblem_, problemOf(frame.status()));
        progress_.renderFailed(now);
    }
}

}  // namespace eyrie::stream
