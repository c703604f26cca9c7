// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/viewer.h"

#include <algorithm>
#include <array>
#include <condition_variable>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>
#include <variant>

#include "coordinator/stream/drawing.h"
#include "coordinator/stream/outbox.h"
#include "coordinator/stream/pick_desk.h"
#include "coordinator/stream/picture_encoder.h"
#include "coordinator/stream/progress.h"
#include "coordinator/stream/quality.h"
#include "coordinator/stream/viewer_messages.h"

namespace eyrie::stream {
namespace {

std::string_view text(const absl::Status& status) {
    return {status.message().data(), status.message().size()};
}

/// One frame in so many has its stages measured, which costs its vertices once more: the fourth
/// first, since shaders are compiled in the ones before.
constexpr std::uint64_t kFramesToAMeasurement = 32;

/// Frames that are drawn for one browser at once, at most: renderers decide whether more than one
/// is, and the browser whether there is room.
constexpr std::size_t kRenderThreads = 3;

double pixelsOf(const ViewRequest& view) {
    return static_cast<double>(view.frame.width) * view.frame.height;
}

}  // namespace

class Viewer::Impl {
public:
    Impl(coordinator::FrameSource& frames, std::function<void()> messageReady,
         const ViewerOptions& options)
        : frames_(frames),
          messageReady_(std::move(messageReady)),
          progress_(
              {options.restDelay, options.retryDelay, options.loadingDelay, options.missingDelay}),
          outbox_(options.framesInFlight),
          picks_(frames_, [this] { messageReady_(); }) {
        subscription_ = frames_.subscribe([this] { statusChanged(); });
        encoder_ = std::thread([this] { encodeLoop(); });
        for (std::thread& thread : renderers_) thread = std::thread([this] { renderLoop(); });
    }

    ~Impl() {
        stop();
        frames_.unsubscribe(subscription_);
        for (std::thread& thread : renderers_) thread.join();
        encoder_.join();
    }

    absl::Status receive(std::span<const std::byte> message) {
        auto request = parseRequest(message);
        if (absl::IsDataLoss(request.status()))
            return request.status();
        if (request.ok() && std::holds_alternative<ViewerPick>(*request)) {
            picks_.ask(std::get<ViewerPick>(*std::move(request)));
            return absl::OkStatus();
        }
        if (request.ok() && std::holds_alternative<ViewerProfile>(*request)) {
            picks_.ask(std::get<ViewerProfile>(*std::move(request)));
            return absl::OkStatus();
        }
        std::unique_lock lock(mutex_);
        if (!request.ok())
            setProblem(requestProblem_, sanitised(text(request.status())));
        else if (const auto* view = std::get_if<ViewRequest>(&*request))
            want(*view);
        else if (auto* change = std::get_if<coordinator::SwitchLayout>(&*request))
            switch_ = std::move(*change);
        else
            outbox_.acknowledged(std::get<FrameAck>(*request), Clock::now());
        announce(lock);
        return absl::OkStatus();
    }

    std::optional<std::string> takeMessage() {
        const std::lock_guard lock(mutex_);
        // Answers to picks, like states, are small and never wait for pictures.
        if (std::optional<std::string> answer = picks_.takeAnswer())
            return answer;
        std::optional<std::string> message = outbox_.take(Clock::now());
        if (message.has_value())
            changed_.notify_all();  // there may be room for the next frame
        return message;
    }

    void roundTrip(Clock::duration time) {
        const std::lock_guard lock(mutex_);
        outbox_.roundTrip(time, Clock::now());
    }

    std::optional<Clock::duration> unacknowledgedFor() {
        const std::lock_guard lock(mutex_);
        const std::optional<Clock::time_point> since = outbox_.link().waitingSince();
        return since.has_value() ? std::optional(Clock::now() - *since) : std::nullopt;
    }

    void stop() {
        {
            const std::lock_guard lock(mutex_);
            isStopping_ = true;
        }
        changed_.notify_all();
        picks_.stop();
    }

private:
    // ---- With mutex_ held.

    void want(const ViewRequest& view) {
        setProblem(requestProblem_, "");
        if (progress_.want(view, Clock::now()))
            outbox_.dropStill();
    }

    void setProblem(std::string& problem, std::string value) {
        if (problem == value)
            return;
        problem = std::move(value);
        isStateStale_ = true;
    }

    bool hasRoom() const { return outbox_.hasRoom(progress_.underWay()); }

    /// Waits for a change, or until `deadline` if there is one.
    void waitForChange(std::unique_lock<std::mutex>& lock,
                       std::optional<Clock::time_point> deadline) {
        if (deadline.has_value())
            changed_.wait_until(lock, *deadline);
        else
            changed_.wait(lock);
    }

    void announce(std::unique_lock<std::mutex>& lock) {
        const bool hasMessage = !isStopping_ && outbox_.hasMessage(Clock::now());
        lock.unlock();
        changed_.notify_all();
        if (hasMessage)
            messageReady_();
        lock.lock();
    }

    // ---- The render threads.

    void renderLoop() {
        std::unique_lock lock(mutex_);
        while (!isStopping_) {
            if (switch_)
                switchLayout(lock);
            else if (!isStarting_ && progress_.mayRender(Clock::now()) && hasRoom())
                renderOne(lock);
            else
                waitForChange(lock, progress_.nextRender(Clock::now()));
        }
    }

    /// Waits for frames of others, so it is done here and not where messages arrive.
    void switchLayout(std::unique_lock<std::mutex>& lock) {
        const coordinator::SwitchLayout change = *std::exchange(switch_, std::nullopt);
        lock.unlock();
        const absl::Status status = frames_.configure(change);
        lock.lock();
        setProblem(requestProblem_, status.ok() ? "" : sanitised(text(status)));
        changed_.notify_all();
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
        quality_.adapt(outbox_.link().bytesPerSecond(begun.at), pixelsOf(begun.view), begun.at);
        begun.level = quality_.index();
        begun.request = drawingOf(begun.view, source_.has_value() ? &source_->sceneInfo : nullptr,
                                  isAtRest ? 1 : QualityControl::level(begun.level).scale);
        if (isAtRest)
            begun.request.budgetMilliseconds.reset();
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
            // Of frames at the same time each takes what it adds.
            outbox_.rendered(now - std::max(begun.at, std::exchange(lastRendered_, now)));
            setProblem(renderProblem_, "");
            tellAtFullSize(frame->statistics, begun.view, begun.request);
            Picture picture{begun.view,
                            std::make_shared<const coordinator::RenderedFrame>(*std::move(frame)),
                            begun.at};
            picture.level = begun.level;
            if (!(begun.request.camera == begun.view.frame.camera))
                picture.liftedCamera = begun.request.camera;
            progress_.rendered(std::move(picture), now);
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
            if (isStateStale_)
                composeState(lock);
            else if (std::optional<Picture> picture =
                         progress_.takePicture(hasRoom() && !outbox_.isWaiting(), now))
                encode(lock, *std::move(picture));
            else
                waitForChange(lock, progress_.nextFiner(now));
        }
    }

    void encode(std::unique_lock<std::mutex>& lock, Picture picture) {
        const Fineness fineness = progress_.fineness(picture, Clock::now());
        const std::uint64_t frameNumber = ++lastFrameNumber_;
        lock.unlock();
        absl::StatusOr<EncodedFrame> encoded = encodePicture(picture, fineness, frameNumber);
        lock.lock();
        const bool isMoving = fineness == Fineness::Moving;
        // A still picture that is no longer wanted would only stand in the way of the next.
        const bool isStale = !isMoving && progress_.fineness(picture, Clock::now()) != fineness;
        if (!encoded.ok()) {
            setProblem(renderProblem_, sanitised(text(encoded.status())));
        } else if (!isStale) {
            if (isMoving)
                quality_.encoded(picture.level, encoded->picture.size(), pixelsOf(picture.view));
            outbox_.putFrame({*std::move(encoded), picture.frame, picture.started});
        }
        progress_.encoded(std::move(picture), fineness, !encoded.ok());
        announce(lock);
    }

    /// status() may wait for whoever holds the frame source, so it is called here and not where
    /// messages arrive.
    void composeState(std::unique_lock<std::mutex>& lock) {
        isStateStale_ = false;
        const std::string ownProblem = requestProblem_;
        const std::string frameProblem = renderProblem_;
        lock.unlock();
        const coordinator::Status status = frames_.status();
        const bool isExplained = ownProblem.empty() && !status.problem.empty();
        std::string message = stateMessage(status, isExplained          ? status.problem
                                                   : ownProblem.empty() ? frameProblem
                                                                        : ownProblem);
        PictureSource source = pictureSource(status);
        lock.lock();
        // A view that came before the first state was drawn without knowing the ground.
        const bool isOther =
            source_.has_value() ? !(*source_ == source) : source.sceneInfo.ground != nullptr;
        if (isOther)
            progress_.sourceChanged();
        source_ = std::move(source);
        if (message != lastState_) {
            lastState_ = message;
            outbox_.putState(std::move(message));
        }
        announce(lock);
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
    const std::function<void()> messageReady_;

    std::mutex mutex_;  // guards everything below, up to the desk
    std::condition_variable changed_;
    bool isStopping_ = false;
    bool isStarting_ = false;  ///< a render thread waits for its frame's turn
    Clock::time_point lastRendered_{};
    Progress progress_;
    QualityControl quality_;
    Outbox outbox_;
    std::optional<PictureSource> source_;
    std::optional<coordinator::SwitchLayout> switch_;  ///< asked for and not done yet
    std::uint64_t requested_ = 0;
    std::uint64_t lastFrameNumber_ = 0;
    bool isStateStale_ = true;
    std::string requestProblem_;
    std::string renderProblem_;
    std::string lastState_;

    PickDesk picks_;
    int subscription_ = 0;
    std::thread encoder_;
    std::array<std::thread, kRenderThreads> renderers_;
};

Viewer::Viewer(coordinator::FrameSource& frames, std::function<void()> messageReady,
               const ViewerOptions& options)
    : impl_(std::make_unique<Impl>(frames, std::move(messageReady), options)) {}

Viewer::~Viewer() = default;

absl::Status Viewer::receive(std::span<const std::byte> message) { return impl_->receive(message); }

std::optional<std::string> Viewer::takeMessage() { return impl_->takeMessage(); }

void Viewer::roundTrip(std::chrono::steady_clock::duration time) { impl_->roundTrip(time); }

std::optional<std::chrono::steady_clock::duration> Viewer::unacknowledgedFor() const {
    return impl_->unacknowledgedFor();
}

void Viewer::stop() { impl_->stop(); }

}  // namespace eyrie::stream
