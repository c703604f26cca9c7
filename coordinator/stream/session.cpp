// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/session.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <string_view>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coordinator/observe/stage_timer.h"
#include "coordinator/stream/drawing.h"
#include "coordinator/stream/statistics_feed.h"
#include "coordinator/stream/swap_barrier.h"
#include "coordinator/stream/swap_group.h"
#include "coordinator/stream/video_streams.h"
#include "coordinator/stream/viewer_messages.h"
#include "fabric/log.h"

namespace eyrie::stream {
namespace {

std::string_view text(const absl::Status& status) {
    return {status.message().data(), status.message().size()};
}

/// One frame in so many has its stages measured, which costs its vertices once more: the fourth
/// first, since shaders are compiled in the ones before.
constexpr std::uint64_t kFramesToAMeasurement = 32;

/// Frames that are drawn for a session at once, at most: renderers decide whether more than one is,
/// and the browsers whether there is room.
constexpr std::size_t kRenderThreads = 3;

/// Tells sessions apart in traces.
std::atomic<int> sessionsSoFar{0};

/// After so many others a viewer's picture is made before those of better links.
constexpr int kMostPassedOver = 2;

double pixelsOf(const ViewRequest& view) {
    return static_cast<double>(view.frame.width) * view.frame.height;
}

using Seats = std::vector<std::shared_ptr<Seat>>;

/// The sooner, of what there is.
std::optional<Clock::time_point> sooner(const std::optional<Clock::time_point>& a,
                                        const std::optional<Clock::time_point>& b) {
    return a && b ? std::min(a, b) : a ? a : b;
}

}  // namespace

class Session::Impl {
public:
    Impl(coordinator::FrameSource& frames, std::string name, const SessionOptions& options,
         std::string id)
        : frames_(frames),
          name_(std::move(name)),
          id_(std::move(id)),
          statistics_(options.statistics),
          framesInFlight_(options.framesInFlight),
          swapPatience_(options.swapPatience),
          telemetry_(options.telemetry),
          videos_(options.video),
          progress_(
              {options.restDelay, options.retryDelay, options.loadingDelay, options.missingDelay}) {
        subscription_ = frames_.subscribe([this] { statusChanged(); });
        encoder_ = std::thread([this] { encodeLoop(); });
        for (std::thread& thread : renderers_) thread = std::thread([this] { renderLoop(); });
    }

    ~Impl() {
        {
            const std::lock_guard lock(mutex_);
            isStopping_ = true;
        }
        changed_.notify_all();
        frames_.unsubscribe(subscription_);
        for (std::thread& thread : renderers_) thread.join();
        encoder_.join();
    }

    std::shared_ptr<Seat> join(Role role, bool mayControl, std::function<void()> messageReady) {
        const std::lock_guard lock(mutex_);
        if (isStopping_)
            return nullptr;
        seats_.push_back(std::make_shared<Seat>(++lastSeat_, role, mayControl, framesInFlight_,
                                                std::move(messageReady)));
        if (leader_ == nullptr && role == Role::Lead)
            leader_ = seats_.back().get();
        isStateStale_ = true;
        changed_.notify_all();
        return seats_.back();
    }

    bool leave(const std::shared_ptr<Seat>& seat) {
        const std::lock_guard lock(mutex_);
        if (std::erase(seats_, seat) == 0)
            return false;
        if (leader_ == seat.get()) {
            const auto heir = std::ranges::find(seats_, Role::Lead, &Seat::role);
            leader_ = heir == seats_.end() ? nullptr : heir->get();
        }
        leaveGroup(*seat);
        isStateStale_ = true;
        isStopping_ = seats_.empty();
        changed_.notify_all();
        return isStopping_;
    }

    void want(Seat& seat, ViewRequest view) {
        const std::lock_guard lock(mutex_);
        if (leader_ != &seat || isDraining_)
            return;
        setProblem(seat.problem, "");
        view.viewer = seat.id;
        wantNow(view);
    }

    absl::Status change(const ViewChange& change) {
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

    void close() {
        Seats all;
        {
            const std::lock_guard lock(mutex_);
            isClosed_ = true;
            all = seats_;
        }
        for (const auto& seat : all) seat->tell();
    }

    bool isClosed() const {
        const std::lock_guard lock(mutex_);
        return isClosed_;
    }

    bool hasViewers() const {
        const std::lock_guard lock(mutex_);
        return !isClosed_ && !seats_.empty();
    }

    SessionFacts facts() const {
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

    void takeLead(Seat& seat) {
        const std::lock_guard lock(mutex_);
        const bool isHere = std::ranges::any_of(
            seats_, [&](const std::shared_ptr<Seat>& each) { return each.get() == &seat; });
        if (!isHere)
            return;
        if (seat.mayControl) {
            leader_ = &seat;
            seat.problem.clear();
            isStateStale_ = true;
        } else {
            setProblem(seat.problem, "This viewer may not take the lead.");
        }
        changed_.notify_all();
    }

    void show(Seat& seat, OwnScreen screen) {
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

    void ready(Seat& seat, std::uint64_t swap) {
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

    void switchLayout(Seat& seat, coordinator::SwitchLayout change) {
        const std::lock_guard lock(mutex_);
        if (isDraining_)
            return;
        if (leader_ == &seat && seat.mayControl)
            switch_ = std::move(change);
        else if (!seat.mayControl)
            setProblem(seat.problem, "This viewer may not switch layouts.");
        else
            setProblem(seat.problem, "Only who leads the session may switch layouts.");
        changed_.notify_all();
    }

    void acknowledged(Seat& seat, const FrameAck& ack) {
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

    void able(Seat& seat, const Abilities& abilities) {
        const std::lock_guard lock(mutex_);
        seat.showsVideo = abilities.h264;
        seat.video.reset();
    }

    void refuse(Seat& seat, const absl::Status& why) {
        const std::lock_guard lock(mutex_);
        setProblem(seat.problem, sanitised(text(why)));
        changed_.notify_all();
    }

    void roundTrip(Seat& seat, Clock::duration time) {
        const std::lock_guard lock(mutex_);
        seat.outbox.roundTrip(time, Clock::now());
    }

    std::optional<std::string> take(Seat& seat) {
        const std::lock_guard lock(mutex_);
        std::optional<std::string> message = seat.outbox.take(Clock::now());
        if (message.has_value())
            changed_.notify_all();  // there may be room for the next frame
        return message;
    }

    std::optional<Clock::duration> unacknowledgedFor(Seat& seat) {
        const std::lock_guard lock(mutex_);
        const std::optional<Clock::time_point> since = seat.outbox.link().waitingSince();
        return since.has_value() ? std::optional(Clock::now() - *since) : std::nullopt;
    }

    void drain() {
        const std::lock_guard lock(mutex_);
        isDraining_ = true;
        changed_.notify_all();
    }

    bool hasDrained(Seat& seat) {
        const std::lock_guard lock(mutex_);
        const Clock::time_point now = Clock::now();
        return !progress_.owesPicture(now) && progress_.rendering() == 0 && !seat.isServed &&
               !dueNow(seat, now) && !awaitsSwap(seat) && !seat.outbox.hasUnsent();
    }

    SessionCounts counts() const {
        const std::lock_guard lock(mutex_);
        return counts_;
    }

    const std::string& name() const { return name_; }
    const std::string& id() const { return id_; }

private:
    // ---- With mutex_ held.

    void wantNow(const ViewRequest& view) {
        // Who leads shows what is asked for: the next picture has it.
        if (leader_ != nullptr && leader_->screen &&
            leader_->screen->shown != view.frame.shown.front()) {
            leader_->screen->shown = view.frame.shown.front();
            leader_->screen->isToBeChecked = true;
        }
        if (progress_.want(view, Clock::now()))
            for (const auto& each : seats_) each->outbox.dropStill();
        changed_.notify_all();
    }

    void setProblem(std::string& problem, std::string value) {
        if (problem == value)
            return;
        problem = std::move(value);
        isStateStale_ = true;
    }

    /// Waits for a change, or until `deadline` if there is one.
    void waitForChange(std::unique_lock<std::mutex>& lock,
                       std::optional<Clock::time_point> deadline) {
        if (deadline.has_value())
            changed_.wait_until(lock, *deadline);
        else
            changed_.wait(lock);
    }

    /// Wakes whoever has something to do now.
    void tell(std::unique_lock<std::mutex>& lock) {
        Seats ready;
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

    // ---- The render threads.

    bool mayRender() const {
        const Clock::time_point now = Clock::now();
        return !isStarting_ && progress_.mayRender(now) &&
               (!isDraining_ || progress_.owesPicture(now)) &&
               std::ranges::any_of(seats_, [this](const std::shared_ptr<Seat>& seat) {
                   return seat->isReadyForMore(progress_);
               });
    }

    void renderLoop() {
        std::unique_lock lock(mutex_);
        while (!isStopping_) {
            if (switch_)
                switchLayout(lock);
            else if (const std::shared_ptr<Seat> unchecked = uncheckedScreen())
                checkScreen(lock, unchecked);
            else if (mayRender())
                renderOne(lock);
            else
                waitForChange(lock, isDraining_ || isStarting_
                                        ? std::nullopt
                                        : progress_.nextRender(Clock::now()));
        }
    }

    /// Waits for frames of others, so it is done here and not where messages arrive.
    void switchLayout(std::unique_lock<std::mutex>& lock) {
        const coordinator::SwitchLayout change = *std::exchange(switch_, std::nullopt);
        lock.unlock();
        const absl::Status status = frames_.configure(change);
        lock.lock();
        if (leader_ != nullptr)
            setProblem(leader_->problem, status.ok() ? "" : sanitised(text(status)));
        changed_.notify_all();
    }

    /// Once more, where the newest picture was drawn without somebody's screen.
    void drawForAll() {
        const std::shared_ptr<const Picture>& newest = progress_.newest();
        if (newest == nullptr)
            return;
        for (const auto& seat : seats_)
            if (const auto shown = seat->shown(newest->view.frame.shown.front());
                shown && std::ranges::find(newest->shown, *shown) == newest->shown.end())
                return progress_.sourceChanged();
    }

    std::shared_ptr<Seat> uncheckedScreen() const {
        const auto found = std::ranges::find_if(seats_, [](const std::shared_ptr<Seat>& seat) {
            return seat->screen && seat->screen->isToBeChecked;
        });
        return found == seats_.end() ? nullptr : *found;
    }

    /// Whether there is such a screen: one that there is not would leave all without a picture.
    /// Waits for frames that are being planned.
    void checkScreen(std::unique_lock<std::mutex>& lock, const std::shared_ptr<Seat>& seat) {
        seat->screen->isToBeChecked = false;
        const coordinator::Shown shown = seat->screen->shown;
        coordinator::FrameRequest request;
        if (progress_.wanted())
            request = progress_.wanted()->frame;
        request.shown = {shown};
        lock.unlock();
        const absl::Status status = frames_.seen(request).status();
        lock.lock();
        if (!seat->screen || seat->screen->shown != shown)
            return;  // it is another by now
        if (seat->screen->problem.empty() != status.ok())
            seat->delivered = {};  // it shows another from now on
        seat->screen->isChecked = true;
        seat->screen->problem = status.ok() ? "" : sanitised(text(status));
        drawForAll();
        isStateStale_ = true;
        changed_.notify_all();
    }

    /// The pictures that are seen, each once.
    std::vector<coordinator::Shown> screens(const coordinator::Shown& asked) const {
        std::vector<coordinator::Shown> screens;
        for (const auto& seat : seats_)
            if (const auto shown = seat->shown(asked);
                shown && std::ranges::find(screens, *shown) == screens.end())
                screens.push_back(*shown);
        return screens.empty() ? std::vector{asked} : screens;
    }

    /// The best level that a link of the viewers takes: a picture for it serves the others, too.
    int chooseLevel(const ViewRequest& view, Clock::time_point now) {
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

    /// A frame that has begun.
    struct Begun {
        ViewRequest view;
        coordinator::FrameRequest request;
        Clock::time_point at;
        int level = 0;
    };

    /// The newest view, when its frame's turn has come. With mutex_ held.
    Begun begin() {
        Begun begun{*progress_.wanted(), {}, Clock::now()};
        const bool isAtRest = progress_.hasRested(begun.at);
        begun.level = chooseLevel(begun.view, begun.at);
        begun.request = drawingOf(begun.view, source_.has_value() ? &source_->sceneInfo : nullptr,
                                  isAtRest ? 1 : QualityControl::level(begun.level).scale);
        if (isAtRest)
            begun.request.budgetMilliseconds.reset();
        begun.request.shown = screens(begun.view.frame.shown.front());
        // Measuring has no place in a limited time.
        begun.request.measuresStages =
            !begun.request.budgetMilliseconds && ++requested_ % kFramesToAMeasurement == 4;
        isStarting_ = false;
        progress_.renderStarted();
        return begun;
    }

    void renderOne(std::unique_lock<std::mutex>& lock) {
        isStarting_ = true;
        std::optional<Begun> begun;
        lock.unlock();
        absl::StatusOr<coordinator::RenderedFrame> frame =
            frames_.renderLatest([&]() -> std::optional<coordinator::FrameRequest> {
                const std::lock_guard choosing(mutex_);
                if (isStopping_)
                    return std::nullopt;
                begun = begin();
                changed_.notify_all();  // another may get in line
                return begun->request;
            });
        lock.lock();
        if (!begun)
            begun = begin();
        rendered(*begun, std::move(frame));
        changed_.notify_all();
    }

    /// With mutex_ held.
    void rendered(const Begun& begun, absl::StatusOr<coordinator::RenderedFrame> frame) {
        const Clock::time_point now = Clock::now();
        if (frame.ok()) {
            ++counts_.drawn;
            // Of frames at the same time each takes what it adds.
            const Clock::time_point from = std::max(begun.at, std::exchange(lastRendered_, now));
            for (const auto& seat : seats_) seat->outbox.rendered(now - from);
            setProblem(renderProblem_, std::string(coordinator::whyEmpty(*frame)));
            tellAtFullSize(frame->statistics, begun.view, begun.request);
            if (statistics_ != nullptr)
                statistics_->drawn(id_, *frame);
            Picture picture{begun.view,
                            std::make_shared<const coordinator::RenderedFrame>(*std::move(frame)),
                            begun.at};
            picture.level = begun.level;
            picture.shown = begun.request.shown;
            if (!(begun.request.camera == begun.view.frame.camera))
                picture.liftedCamera = begun.request.camera;
            progress_.rendered(std::move(picture), now);
            drawForAll();
            encodings_.clear();
        } else {
            setProblem(renderProblem_, sanitised(text(frame.status())));
            progress_.renderFailed(now);
        }
    }

    // ---- The encoder thread.

    void encodeLoop() {
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
                waitForChange(lock, sooner(isDraining_ ? std::nullopt : progress_.nextFiner(now),
                                           deadline()));
        }
    }

    // ---- Swap barriers.

    /// Of those whose screens share a barrier; null where it is shown behind none, or alone.
    const SwapGroup* groupOf(const Seat& seat) const {
        const auto group = groups_.find(seat.barrier);
        return group == groups_.end() || group->second.size() < 2 ? nullptr : &group->second;
    }

    bool isInSwap(const Seat& seat) const {
        const auto group = groups_.find(seat.barrier);
        return group != groups_.end() && group->second.isSwapping() &&
               group->second.isInStep(seat.id);
    }

    /// There is something that it gets together with others.
    bool awaitsSwap(const Seat& seat) const {
        const SwapGroup* const group = groupOf(seat);
        return isInSwap(seat) || (group != nullptr && group->isInStep(seat.id) && !hasNewest(seat));
    }

    bool hasNewest(const Seat& seat) const {
        return progress_.newest() != nullptr &&
               seat.delivered.picture == progress_.newest()->number;
    }

    /// What it keeps for a word that will not come is shown now.
    void leaveGroup(Seat& seat) {
        const auto group = groups_.find(std::exchange(seat.barrier, ""));
        if (group == groups_.end())
            return;
        group->second.leave(seat.id);
        seat.outbox.putWord(swapMessage(seat.delivered.picture));
        if (group->second.size() == 0)
            groups_.erase(group);
    }

    /// Each seat joins those behind its barrier.
    void arrangeGroups() {
        if (!source_ || !progress_.wanted())
            return;
        for (const auto& seat : seats_) {
            const auto shown = seat->shown(progress_.wanted()->frame.shown.front());
            const std::string barrier = shown ? swapBarrierOf(source_->canvases, *shown) : "";
            if (barrier == seat->barrier)
                continue;
            leaveGroup(*seat);
            seat->barrier = barrier;
            if (!barrier.empty())
                groups_.try_emplace(barrier, swapPatience_).first->second.join(seat->id);
            isStateStale_ = true;
        }
    }

    /// Puts out the words that a group has to say now; returns who is to be told.
    Seats sayWords(SwapGroup& group) {
        Seats told;
        for (const SwapGroup::Word& word : group.takeWords(Clock::now()))
            for (const auto& seat : seats_)
                if (seat->id == word.member) {
                    seat->outbox.putWord(swapMessage(word.swap));
                    told.push_back(seat);
                }
        const SwapGroup::Ended ended = group.takeEnded();
        if (telemetry_ != nullptr)
            telemetry_->metrics.swapped(ended.together, ended.cutShort);
        return told;
    }

    /// True where somebody was told, and the lock given up for it.
    bool endLateSwaps(std::unique_lock<std::mutex>& lock) {
        bool isAny = false;
        for (auto& [name, group] : groups_) {
            const int behind = group.behind();
            isAny = !sayWords(group).empty() || isAny;
            isStateStale_ = isStateStale_ || behind != group.behind();
        }
        if (isAny)
            tell(lock);
        return isAny;
    }

    std::optional<Clock::time_point> deadline() const {
        std::optional<Clock::time_point> first;
        for (const auto& [name, group] : groups_) first = sooner(first, group.deadline());
        return first;
    }

    /// A swap that is to begin: to whom each is given what.
    struct Swap {
        std::shared_ptr<const Picture> picture;
        std::string barrier;
        std::vector<std::pair<std::shared_ptr<Seat>, QualityClass>> seats;
    };

    std::shared_ptr<Swap> nextSwap(Clock::time_point now) {
        for (auto& [barrier, group] : groups_)
            if (group.size() >= 2 && !group.isSwapping())
                if (auto swap = swapOf(barrier, group, now))
                    return swap;
        return nullptr;
    }

    /// Of the newest picture, with all in step that lack it; null while it is not of all screens.
    std::shared_ptr<Swap> swapOf(const std::string& barrier, SwapGroup& group,
                                 Clock::time_point now) {
        const std::shared_ptr<const Picture> picture = progress_.newest();
        if (picture == nullptr)
            return nullptr;
        std::vector<SwapGroup::Candidate> candidates;
        auto swap = std::make_shared<Swap>(Swap{picture, barrier, {}});
        for (const auto& seat : seats_) {
            if (seat->barrier != barrier || !group.isInStep(seat->id) ||
                seat->delivered.picture == picture->number)
                continue;
            const auto as = seat->movingClass(*picture);
            if (!as) {
                group.gather({}, now);
                return nullptr;
            }
            seat->outbox.dropStill();  // what is left of it is of the picture before
            candidates.push_back({seat->id, seat->outbox.hasRoom(0)});
            swap->seats.emplace_back(seat, *as);
        }
        const int behind = group.behind();
        const std::vector<SwapGroup::Member> members = group.gather(candidates, now);
        isStateStale_ = isStateStale_ || behind != group.behind();
        if (members.empty())
            return nullptr;
        std::erase_if(swap->seats, [&](const auto& each) {
            return std::ranges::find(members, each.first->id) == members.end();
        });
        group.begin(picture->number, members);
        return swap;
    }

    /// Encodes its picture for each class, and hands it to all of them.
    void serveTogether(std::unique_lock<std::mutex>& lock, const Swap& swap) {
        std::map<QualityClass, Seats> classes;
        for (const auto& [seat, as] : swap.seats) {
            seat->delivered = {swap.picture->number, as.fineness};
            seat->isServed = true;
            seat->timesPassedOver = 0;
            classes[as].push_back(seat);
        }
        for (const auto& [as, seats] : classes) {
            const auto encoded = encodingOf(lock, swap.picture, as, seats);
            if (!encoded.ok())
                setProblem(renderProblem_, sanitised(text(encoded.status())));
            for (const auto& seat : seats) {
                seat->isServed = false;
                const auto group = groups_.find(swap.barrier);
                if (group == groups_.end() || seat->barrier != swap.barrier)
                    continue;  // it has left meanwhile
                if (encoded.ok()) {
                    give(*seat, *encoded, as, *swap.picture, swap.picture->number);
                    group->second.given(seat->id, swap.picture->number, Clock::now());
                } else {
                    group->second.withheld(seat->id);
                }
            }
            tell(lock);
        }
    }

    /// At the end nothing is sent finer than it was asked for.
    std::optional<QualityClass> dueNow(const Seat& seat, Clock::time_point now) const {
        if ((isDraining_ && hasNewest(seat)) || awaitsSwap(seat))
            return std::nullopt;
        const auto due = seat.due(progress_, now);
        const bool isLost =
            due && due->codec == Codec::H264 &&
            !videos_.mayFollow(due->level, seat.video, progress_.newest()->number, now);
        if (!isLost)
            return due;
        return QualityClass{due->fineness,
                            std::max(seat.quality.jpegIndex(), progress_.newest()->level),
                            Codec::Jpeg, due->output};
    }

    /// Who waits for long first, then moving pictures before still ones, and better links, which
    /// are quicker served, before worse.
    std::optional<QualityClass> nextClass(Clock::time_point now) const {
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
    Seats takeDue(const QualityClass& as, Clock::time_point now) {
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

    void serve(std::unique_lock<std::mutex>& lock, const QualityClass& as) {
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
            setProblem(renderProblem_, sanitised(text(encoded.status())));
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

    bool isStillBest(const Picture& picture) const {
        return progress_.isBest() && progress_.newest()->number == picture.number &&
               progress_.hasRested(Clock::now());
    }

    void give(Seat& seat, const std::shared_ptr<const EncodedPicture>& encoded,
              const QualityClass& as, const Picture& picture, std::uint64_t swap = 0) {
        ++counts_.given;
        seat.give(encoded, as, picture, progress_, Clock::now(), swap);
    }

    /// A picture that has not gone out yet is older than this one, which is there already.
    void replaceWaiting(const std::shared_ptr<const EncodedPicture>& encoded,
                        const QualityClass& as, const Picture& picture) {
        if (as.fineness != Fineness::Moving || as.codec != Codec::Jpeg)
            return;
        for (const auto& seat : seats_) {
            if (seat->getsVideo())
                continue;
            const bool isOfClass = seat->movingClass(picture) == as;
            if (seat->isServed || groupOf(*seat) != nullptr || isInSwap(*seat) ||
                !seat->outbox.isWaiting() || !isOfClass ||
                seat->delivered.picture >= picture.number)
                continue;
            seat->delivered = {picture.number, as.fineness};
            give(*seat, encoded, as, picture);
        }
    }

    /// Made now, or before for others.
    absl::StatusOr<std::shared_ptr<const EncodedPicture>> encodingOf(
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
    static int worstJpegLevel(const Seats& served, const Picture& picture) {
        int level = picture.level;
        for (const auto& seat : served) level = std::max(level, seat->quality.jpegIndex());
        return level;
    }

    /// Without the lock. A JPEG of `jpegLevel` where the stream cannot go on yet, or not at all.
    absl::StatusOr<EncodedPicture> encodeVideo(const Picture& picture, const QualityClass& as,
                                               bool asKey, int jpegLevel, Clock::time_point now) {
        const std::optional<fabric::Image> smaller = shrunkFor(picture, as);
        const fabric::Image& image = smaller ? *smaller : imageOf(picture, as);
        absl::StatusOr<std::optional<VideoStreams::Coded>> coded =
            videos_.encode(as.level, image, QualityControl::level(as.level).rateFactor, asKey, now);
        if (!coded.ok()) {
            spdlog::warn("moving pictures go as JPEG from now on: {}", text(coded.status()));
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

    /// status() may wait for whoever holds the frame source, so it is called here and not where
    /// messages arrive.
    void composeStates(std::unique_lock<std::mutex>& lock) {
        isStateStale_ = false;
        lock.unlock();
        const coordinator::Status status = frames_.status();
        PictureSource source = pictureSource(status);
        lock.lock();
        // A view that came before the first state was drawn without knowing the ground.
        const bool isOther =
            source_.has_value() ? !(*source_ == source) : source.sceneInfo.ground != nullptr;
        if (isOther) {
            progress_.sourceChanged();
            for (const auto& seat : seats_)
                if (seat->screen)
                    seat->screen->isToBeChecked = true;
        }
        source_ = std::move(source);
        for (const auto& seat : seats_) putState(*seat, status);
        tell(lock);
    }

    void putState(Seat& seat, const coordinator::Status& status) {
        const bool isExplained = seat.problem.empty() && !status.problem.empty();
        const std::string& problem = isExplained            ? status.problem
                                     : seat.problem.empty() ? ownProblem(seat)
                                                            : seat.problem;
        Place place{name_, static_cast<int>(seats_.size()), leader_ == &seat, leader_ != nullptr};
        if (const SwapGroup* const group = groupOf(seat)) {
            place.barrier = seat.barrier;
            place.together = group->size();
            place.behind = group->behind();
        }
        std::string message = stateMessage(status, problem, place);
        if (message == seat.lastState)
            return;
        seat.lastState = message;
        seat.outbox.putState(std::move(message));
    }

    const std::string& ownProblem(const Seat& seat) const {
        return renderProblem_.empty() && seat.screen ? seat.screen->problem : renderProblem_;
    }

    // ---- Threads of the frame source.

    void statusChanged() {
        {
            const std::lock_guard lock(mutex_);
            isStateStale_ = true;
        }
        changed_.notify_all();
    }

    coordinator::FrameSource& frames_;
    const std::string name_;
    const std::string id_;
    const std::chrono::system_clock::time_point created_ = std::chrono::system_clock::now();
    StatisticsFeed* const statistics_;
    const std::optional<int> framesInFlight_;
    const std::chrono::milliseconds swapPatience_;
    const observe::SharedTelemetry telemetry_;
    const std::string encoding_ = fmt::format("encodes for session {}", ++sessionsSoFar);

    mutable std::mutex mutex_;  // guards everything below, up to the threads, and the seats
    std::condition_variable changed_;
    bool isStopping_ = false;
    bool isDraining_ = false;
    bool isClosed_ = false;
    bool isStarting_ = false;  ///< a render thread waits for its frame's turn
    Clock::time_point lastRendered_{};
    Seats seats_;                              ///< in the order in which they came
    Seat* leader_ = nullptr;                   ///< one of them
    std::map<std::string, SwapGroup> groups_;  ///< of the seats' barriers
    std::uint64_t lastSeat_ = 0;
    VideoStreams videos_;
    Progress progress_;
    std::map<QualityClass, std::shared_ptr<const EncodedPicture>> encodings_;  ///< of the newest
    std::optional<PictureSource> source_;
    std::optional<coordinator::SwitchLayout> switch_;  ///< asked for and not done yet
    std::uint64_t requested_ = 0;
    SessionCounts counts_;
    bool isStateStale_ = true;
    std::string renderProblem_;

    int subscription_ = 0;
    std::thread encoder_;
    std::array<std::thread, kRenderThreads> renderers_;
};

Session::Session(coordinator::FrameSource& frames, std::string name, const SessionOptions& options,
                 std::string id)
    : impl_(std::make_unique<Impl>(frames, std::move(name), options, std::move(id))) {}
Session::~Session() = default;

std::shared_ptr<Seat> Session::join(Role role, bool mayControl,
                                    std::function<void()> messageReady) {
    return impl_->join(role, mayControl, std::move(messageReady));
}
void Session::show(Seat& seat, OwnScreen screen) { impl_->show(seat, std::move(screen)); }
void Session::ready(Seat& seat, std::uint64_t swap) { impl_->ready(seat, swap); }
bool Session::leave(const std::shared_ptr<Seat>& seat) { return impl_->leave(seat); }
void Session::want(Seat& seat, const ViewRequest& view) { impl_->want(seat, view); }
void Session::takeLead(Seat& seat) { impl_->takeLead(seat); }
void Session::switchLayout(Seat& seat, coordinator::SwitchLayout change) {
    impl_->switchLayout(seat, std::move(change));
}
void Session::acknowledged(Seat& seat, const FrameAck& ack) { impl_->acknowledged(seat, ack); }
void Session::able(Seat& seat, const Abilities& abilities) { impl_->able(seat, abilities); }
void Session::refuse(Seat& seat, const absl::Status& why) { impl_->refuse(seat, why); }
void Session::roundTrip(Seat& seat, Clock::duration time) { impl_->roundTrip(seat, time); }
std::optional<std::string> Session::take(Seat& seat) { return impl_->take(seat); }
std::optional<Clock::duration> Session::unacknowledgedFor(Seat& seat) {
    return impl_->unacknowledgedFor(seat);
}
void Session::drain() { impl_->drain(); }
bool Session::hasDrained(Seat& seat) { return impl_->hasDrained(seat); }
SessionCounts Session::counts() const { return impl_->counts(); }
const std::string& Session::name() const { return impl_->name(); }
const std::string& Session::id() const { return impl_->id(); }
SessionFacts Session::facts() const { return impl_->facts(); }
absl::Status Session::change(const ViewChange& change) { return impl_->change(change); }
void Session::close() { impl_->close(); }
bool Session::isClosed() const { return impl_->isClosed(); }
bool Session::hasViewers() const { return impl_->hasViewers(); }

}  // namespace eyrie::stream
