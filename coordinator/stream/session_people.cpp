// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "coordinator/stream/session_impl.h"

namespace eyrie::stream {
namespace {

std::atomic<std::uint64_t> sessionsSoFar{0};

/// For so long who led has the lead again when its connection comes back.
constexpr std::chrono::seconds kLeadersReturn{60};

}  // namespace

Session::Impl::Impl(coordinator::FrameSource& frames, std::string name,
                    const SessionOptions& options, std::string id)
    : frames_(frames),
      name_(std::move(name)),
      id_(std::move(id)),
      statistics_(options.statistics),
      framesInFlight_(options.framesInFlight),
      swapPatience_(options.swapPatience),
      telemetry_(options.telemetry),
      number_(++sessionsSoFar),
      encoding_(fmt::format("encodes for session {}", number_)),
      videos_(options.video),
      progress_(
          {options.restDelay, options.retryDelay, options.loadingDelay, options.missingDelay}) {
    subscription_ = frames_.subscribe([this] { statusChanged(); });
    encoder_ = std::thread([this] { encodeLoop(); });
    for (std::thread& thread : renderers_) thread = std::thread([this] { renderLoop(); });
}

Session::Impl::~Impl() {
    {
        const std::lock_guard lock(mutex_);
        isStopping_ = true;
    }
    over_.request_stop();
    changed_.notify_all();
    frames_.unsubscribe(subscription_);
    for (std::thread& thread : renderers_) thread.join();
    encoder_.join();
    if (statistics_ != nullptr)
        statistics_->ended(id_, number_);
}

std::shared_ptr<Seat> Session::Impl::join(Role role, bool mayControl, const std::string& viewer,
                                          std::function<void()> messageReady) {
    const std::lock_guard lock(mutex_);
    if (isStopping_)
        return nullptr;
    const auto seat = std::make_shared<Seat>(++lastSeat_, role, mayControl, viewer, framesInFlight_,
                                             std::move(messageReady));
    if (!replace(seat))
        seats_.push_back(seat);
    const bool isBack = isAwaited(*seat);
    if (isBack)
        awaitedLeader_.clear();
    if (isBack || (leader_ == nullptr && role == Role::Lead))
        leader_ = seat.get();
    isStateStale_ = true;
    changed_.notify_all();
    return seat;
}

/// Whether it led before its connection was lost, and nobody has taken the lead since.
bool Session::Impl::isAwaited(const Seat& seat) const {
    return !seat.viewer.empty() && seat.viewer == awaitedLeader_ && seat.mayControl &&
           Clock::now() - leaderLeft_ <= kLeadersReturn;
}

/// Gives it the place of who came before under the same name; false: nobody did.
bool Session::Impl::replace(const std::shared_ptr<Seat>& seat) {
    const auto found = std::ranges::find_if(seats_, [&seat](const std::shared_ptr<Seat>& each) {
        return !seat->viewer.empty() && each->viewer == seat->viewer &&
               each->mayControl == seat->mayControl;
    });
    if (found == seats_.end())
        return false;
    const std::shared_ptr<Seat> before = std::exchange(*found, seat);
    seat->role = before->role;
    if (leader_ == before.get())
        leader_ = seat.get();
    leaveGroup(*before);
    before->isReplaced = true;
    replaced_.push_back(before);
    return true;
}

bool Session::Impl::leave(const std::shared_ptr<Seat>& seat) {
    const bool isLast = [&] {
        const std::lock_guard lock(mutex_);
        return freePlace(seat);
    }();
    if (isLast)
        over_.request_stop();  // not with mutex_ held: whoever hears of it may want it
    return isLast;
}

/// Whether it was the last viewer's.
bool Session::Impl::freePlace(const std::shared_ptr<Seat>& seat) {
    if (std::erase(seats_, seat) == 0)
        return false;
    if (leader_ == seat.get()) {
        const auto heir = std::ranges::find(seats_, Role::Lead, &Seat::role);
        leader_ = heir == seats_.end() ? nullptr : heir->get();
        const Clock::time_point now = Clock::now();
        if (awaitedLeader_.empty() || now - leaderLeft_ > kLeadersReturn)
            awaitedLeader_ = seat->viewer, leaderLeft_ = now;
    }
    leaveGroup(*seat);
    isStateStale_ = true;
    isStopping_ = seats_.empty();
    changed_.notify_all();
    return isStopping_;
}

void Session::Impl::want(Seat& seat, ViewRequest view) {
    const std::lock_guard lock(mutex_);
    if (leader_ != &seat || isDraining_)
        return;
    setProblem(seat.problem, "");
    setProblem(seat.refusal, "");
    view.viewer = seat.id;
    // Nothing is drawn for the same view again, but it is to be answered.
    if (!wantNow(view))
        seat.delivered.fineness = Fineness::Moving;
}

absl::Status Session::Impl::change(const ViewChange& change) {
    const std::lock_guard lock(mutex_);
    if (isStopping_ || isClosed_)
        return absl::NotFoundError("the session has just ended");
    if (isDraining_)
        return absl::UnavailableError("the server is shutting down");
    if (!progress_.wanted() && !change.camera)
        return absl::FailedPreconditionError(
            "change.camera is absent, and nobody has asked for a view yet; give one");
    ViewRequest view = progress_.wanted().value_or(ViewRequest());
    if (!progress_.wanted())
        view.frame.completeness = fabric::Completeness::Interactive;
    view.viewer = 0;
    view.sequence = 0;
    if (change.camera)
        view.frame.camera = *change.camera;
    if (change.tauPixels)
        view.frame.tauPixels = *change.tauPixels;
    if (change.shading)
        view.frame.shading = *change.shading;
    if (change.look)
        view.frame.look = *change.look;
    if (change.isUnderground)
        view.isUnderground = *change.isUnderground;
    if (change.shown)
        view.frame.shown = {*change.shown};
    wantNow(view);
    return absl::OkStatus();
}

void Session::Impl::close() {
    Seats all;
    {
        const std::lock_guard lock(mutex_);
        isClosed_ = true;
        all = seats_;
    }
    for (const auto& seat : all) seat->tell();
}

bool Session::Impl::isClosed() const {
    const std::lock_guard lock(mutex_);
    return isClosed_;
}

bool Session::Impl::hasViewers() const {
    const std::lock_guard lock(mutex_);
    return !isClosed_ && !seats_.empty();
}

SessionFacts Session::Impl::facts() const {
    const std::lock_guard lock(mutex_);
    SessionFacts facts{created_, {}, progress_.wanted(), nullptr, counts_};
    if (progress_.newest() != nullptr)
        facts.frame = progress_.newest()->frame;
    const Clock::time_point now = Clock::now();
    for (const auto& seat : seats_)
        facts.viewers.push_back({seat->id, seat->joined, leader_ == seat.get(), seat->role,
                                 seat->mayControl, seat->last, seat->given(),
                                 seat->outbox.link().bytesPerSecond(now)});
    return facts;
}

void Session::Impl::takeLead(Seat& seat) {
    const std::lock_guard lock(mutex_);
    const bool isHere = std::ranges::any_of(
        seats_, [&](const std::shared_ptr<Seat>& each) { return each.get() == &seat; });
    if (!isHere)
        return;
    if (seat.mayControl) {
        leader_ = &seat;
        awaitedLeader_.clear();
        seat.problem.clear();
        seat.refusal.clear();
        isStateStale_ = true;
    } else {
        setProblem(seat.refusal, "This viewer may not take the lead.");
    }
    changed_.notify_all();
}

void Session::Impl::show(Seat& seat, OwnScreen screen) {
    const std::lock_guard lock(mutex_);
    if (isDraining_ ||
        (seat.screen ? std::optional(seat.screen->shown) : std::nullopt) == screen.shown)
        return;
    seat.screen.reset();
    if (screen.shown)
        seat.screen = Seat::Screen{.shown = *std::move(screen.shown)};
    seat.delivered = {};  // what it has is of another screen
    drawForAll();
    isStateStale_ = true;
    changed_.notify_all();
}

void Session::Impl::ready(Seat& seat, std::uint64_t swap) {
    Seats told;
    {
        const std::lock_guard lock(mutex_);
        const auto group = groups_.find(seat.barrier);
        if (group == groups_.end())
            return;
        const int behind = group->second.behind();
        group->second.ready(seat.id, swap, Clock::now());
        told = sayWords(group->second);
        isStateStale_ = isStateStale_ || behind != group->second.behind();
    }
    changed_.notify_all();
    for (const auto& each : told) each->tell();
}

void Session::Impl::switchLayout(Seat& seat, coordinator::SwitchLayout change) {
    const std::lock_guard lock(mutex_);
    if (isDraining_)
        return;
    if (leader_ == &seat && seat.mayControl)
        switch_ = std::move(change);
    else if (!seat.mayControl)
        setProblem(seat.refusal, "This viewer may not switch layouts.");
    else
        setProblem(seat.refusal, "Only who leads the session may switch layouts.");
    changed_.notify_all();
}

void Session::Impl::acknowledged(Seat& seat, const FrameAck& ack) {
    bool hasMessage = false;
    {
        const std::lock_guard lock(mutex_);
        seat.outbox.acknowledged(ack, Clock::now());
        hasMessage = !isStopping_ && seat.outbox.hasMessage(Clock::now());
    }
    changed_.notify_all();
    if (hasMessage)
        seat.tell();
}

void Session::Impl::able(Seat& seat, const Abilities& abilities) {
    const std::lock_guard lock(mutex_);
    seat.showsVideo = abilities.h264;
    seat.showsTiles = abilities.tiles;
    seat.video.reset();
}

void Session::Impl::refuse(Seat& seat, const absl::Status& why) {
    const std::lock_guard lock(mutex_);
    setProblem(seat.problem, problemOf(why));
    changed_.notify_all();
}

void Session::Impl::roundTrip(Seat& seat, Clock::duration time) {
    const std::lock_guard lock(mutex_);
    seat.outbox.roundTrip(time, Clock::now());
}

std::optional<std::string> Session::Impl::take(Seat& seat) {
    const std::lock_guard lock(mutex_);
    std::optional<std::string> message = seat.outbox.take(Clock::now());
    if (message.has_value())
        changed_.notify_all();  // there may be room for the next frame
    return message;
}

std::optional<Clock::duration> Session::Impl::unacknowledgedFor(Seat& seat) {
    const std::lock_guard lock(mutex_);
    const std::optional<Clock::time_point> since = seat.outbox.link().waitingSince();
    return since.has_value() ? std::optional(Clock::now() - *since) : std::nullopt;
}

void Session::Impl::drain() {
    const std::lock_guard lock(mutex_);
    isDraining_ = true;
    changed_.notify_all();
}

bool Session::Impl::hasDrained(Seat& seat) {
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    return !progress_.owesPicture(now) && progress_.rendering() == 0 && !seat.isServed &&
           !dueNow(seat, now) && !awaitsSwap(seat) && !seat.outbox.hasUnsent();
}

SessionCounts Session::Impl::counts() const {
    const std::lock_guard lock(mutex_);
    return counts_;
}

/// True where it is another view than before.
bool Session::Impl::wantNow(const ViewRequest& view) {
    // Who leads shows what is asked for: the next picture has it.
    if (leader_ != nullptr && leader_->screen &&
        leader_->screen->shown != view.frame.shown.front()) {
        leader_->screen->shown = view.frame.shown.front();
        leader_->screen->isToBeChecked = true;
    }
    const bool isOther = progress_.want(view, Clock::now());
    if (isOther)
        for (const auto& each : seats_) each->outbox.dropStill();
    changed_.notify_all();
    return isOther;
}

void Session::Impl::setProblem(std::string& problem, std::string value) {
    if (problem == value)
        return;
    problem = std::move(value);
    isStateStale_ = true;
}

/// Waits for a change, or until `deadline` if there is one.
void Session::Impl::waitForChange(std::unique_lock<std::mutex>& lock,
                                  std::optional<Clock::time_point> deadline) {
    if (deadline.has_value())
        changed_.wait_until(lock, *deadline);
    else
        changed_.wait(lock);
}

/// Wakes whoever has something to do now.
void Session::Impl::tell(std::unique_lock<std::mutex>& lock) {
    Seats ready = std::exchange(replaced_, {});
    if (!isStopping_)
        std::ranges::copy_if(seats_, std::back_inserter(ready), [](const auto& seat) {
            return seat->outbox.hasMessage(Clock::now());
        });
    lock.unlock();
    changed_.notify_all();
    for (const auto& seat : ready) seat->tell();
    ready.clear();
    lock.lock();
}

/// status() may wait for whoever holds the frame source, so it is called here and not where
/// messages arrive.
void Session::Impl::composeStates(std::unique_lock<std::mutex>& lock) {
    isStateStale_ = false;
    lock.unlock();
    const coordinator::Status status = frames_.status();
    PictureSource source = pictureSource(status);
    lock.lock();
    // A view that came before the first state was drawn without knowing the ground.
    const bool isOther =
        source_.has_value() ? !(*source_ == source) : source.sceneInfo.ground != nullptr;
    if (isOther) {
        if (source_ && source_->displayRevision != source.displayRevision)
            progress_.seenOtherwise(Clock::now());
        else
            progress_.sourceChanged();
        for (const auto& seat : seats_) seat->outbox.dropStill();
    }
    // So may a screen have been looked for before there was a first state to compare with.
    if (isOther || !source_)
        for (const auto& seat : seats_)
            if (seat->screen)
                seat->screen->isToBeChecked = true;
    source_ = std::move(source);
    for (const auto& seat : seats_) putState(*seat, status);
    tell(lock);
}

void Session::Impl::putState(Seat& seat, const coordinator::Status& status) {
    const bool isExplained = seat.problem.empty() && !status.problem.empty();
    const std::string& problem = isExplained            ? status.problem
                                 : seat.problem.empty() ? ownProblem(seat)
                                                        : seat.problem;
    Place place{name_, static_cast<int>(seats_.size()), leader_ == &seat, leader_ != nullptr,
                seat.mayControl};
    if (const SwapGroup* const group = groupOf(seat)) {
        place.barrier = seat.barrier;
        place.together = group->size();
        place.behind = group->behind();
    }
    std::string message = stateMessage(status, problem, seat.refusal, renderNote_, place);
    if (message == seat.lastState)
        return;
    seat.lastState = message;
    seat.outbox.putState(std::move(message));
}

const std::string& Session::Impl::ownProblem(const Seat& seat) const {
    return renderProblem_.empty() && seat.screen ? seat.screen->problem : renderProblem_;
}

void Session::Impl::statusChanged() {
    {
        const std::lock_guard lock(mutex_);
        isStateStale_ = true;
    }
    changed_.notify_all();
}

}  // namespace eyrie::stream
