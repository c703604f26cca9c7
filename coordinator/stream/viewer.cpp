// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/viewer.h"

#include <condition_variable>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "coordinator/stream/pacer.h"
#include "coordinator/stream/pick_desk.h"
#include "coordinator/stream/viewer_messages.h"
#include "wire/jpeg.h"

namespace eyrie::stream {
namespace {

std::string_view text(const absl::Status& status) {
    return {status.message().data(), status.message().size()};
}

/// A picture as it came from the frame source, for one view.
struct Picture {
    ViewRequest view;
    std::shared_ptr<const coordinator::RenderedFrame> frame;
    Clock::time_point started;
    std::optional<fabric::Camera> liftedCamera;  ///< shown where the view's would be under ground
};

/// Coarser or smaller than what was asked for, to keep a frame time.
bool isBelowAsked(const Picture& picture) {
    const fabric::FrameStatistics& statistics = picture.frame->statistics;
    const fabric::PixelViewport& area = picture.frame->image.area;
    return statistics.budget &&
           (statistics.budget->tauPixels > statistics.tauAskedPixels ||
            area.width != picture.view.frame.width || area.height != picture.view.frame.height);
}

bool isSame(const ViewRequest& a, const ViewRequest& b) {
    return a.frame == b.frame && a.isUnderground == b.isUnderground;
}

/// One frame in so many has its stages measured, which costs its vertices once more: the fourth
/// first, since shaders are compiled in the ones before.
constexpr std::uint64_t kFramesToAMeasurement = 32;

/// What must be equal for a picture to be still right.
struct PictureSource {
    fabric::Scene scene;
    fabric::SceneInfo sceneInfo;
    std::vector<std::string> renderers;

    bool operator==(const PictureSource&) const = default;
};

PictureSource pictureSource(const coordinator::Status& status) {
    PictureSource source{status.scene, status.sceneInfo, {}};
    for (const coordinator::RendererStatus& renderer : status.renderers)
        if (renderer.alive)
            source.renderers.push_back(renderer.id);
    return source;
}

}  // namespace

class Viewer::Impl {
public:
    Impl(coordinator::FrameSource& frames, std::function<void()> messageReady,
         const ViewerOptions& options)
        : frames_(frames),
          messageReady_(std::move(messageReady)),
          options_(options),
          pacer_(options.framesInFlight),
          picks_(frames_, [this] { messageReady_(); }) {
        subscription_ = frames_.subscribe([this] { statusChanged(); });
        encoder_ = std::thread([this] { encodeLoop(); });
        renderer_ = std::thread([this] { renderLoop(); });
    }

    ~Impl() {
        stop();
        frames_.unsubscribe(subscription_);
        renderer_.join();
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
        std::unique_lock lock(mutex_);
        if (!request.ok())
            setProblem(requestProblem_, sanitised(text(request.status())));
        else if (const auto* view = std::get_if<ViewRequest>(&*request))
            want(*view);
        else
            pacer_.acknowledged(std::get<FrameAck>(*request).frameNumber, Clock::now());
        const bool hasMessage = mayTakeFrame();
        lock.unlock();
        changed_.notify_all();
        if (hasMessage)
            messageReady_();
        return absl::OkStatus();
    }

    std::optional<std::string> takeMessage() {
        const std::lock_guard lock(mutex_);
        if (waitingState_.has_value())
            return std::exchange(waitingState_, std::nullopt);
        if (std::optional<std::string> answer = picks_.takeAnswer())
            return answer;
        if (!mayTakeFrame())
            return std::nullopt;
        WaitingFrame frame = *std::exchange(waitingFrame_, std::nullopt);
        pacer_.sent(frame.frameNumber, frame.started, !frame.isStill);
        return std::move(frame.message);
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
    struct WaitingFrame {
        std::uint64_t frameNumber = 0;
        bool isStill = false;
        Clock::time_point started;
        std::string message;
    };

    // ---- With mutex_ held.

    void want(const ViewRequest& view) {
        const bool isOther = !wanted_.has_value() || !isSame(*wanted_, view);
        wanted_ = view;
        setProblem(requestProblem_, "");
        if (!isOther)
            return;
        isRenderNeeded_ = true;
        wantedSince_ = Clock::now();
        retryAt_.reset();
        redrawAt_.reset();
        isLoading_ = false;
    }

    void setProblem(std::string& problem, std::string value) {
        if (problem == value)
            return;
        problem = std::move(value);
        isStateStale_ = true;
    }

    bool mayTakeFrame() const {
        return waitingFrame_.has_value() && pacer_.unacknowledged() < pacer_.window();
    }

    /// Room for one more frame between the start of its rendering and its acknowledgement.
    bool hasRoom() const {
        const int underWay = (isRendering_ ? 1 : 0) + (rendered_.has_value() ? 1 : 0) +
                             (isEncoding_ ? 1 : 0) + (waitingFrame_.has_value() ? 1 : 0);
        return pacer_.unacknowledged() + underWay < pacer_.window();
    }

    bool isWaitingToRetry() const { return retryAt_.has_value() && Clock::now() < *retryAt_; }

    bool isRedrawDue() const { return redrawAt_.has_value() && Clock::now() >= *redrawAt_; }

    bool mayRender() const {
        return (isRenderNeeded_ || isRedrawDue() || (needsFull() && hasRested())) &&
               wanted_.has_value() && !rendered_.has_value() && hasRoom() && !isWaitingToRetry();
    }

    bool hasRested() const { return Clock::now() >= wantedSince_ + options_.restDelay; }

    /// The last picture shows the view that is wanted.
    bool isShown() const {
        return last_.has_value() && !isRenderNeeded_ && !isLoading_ && !isRendering_ &&
               !rendered_.has_value() && isSame(last_->view, *wanted_);
    }

    /// It was drawn in a limited time: at rest the view is drawn once more, without limit.
    bool needsFull() const { return isShown() && isBelowAsked(*last_); }

    /// It was sent as a moving one.
    bool needsStill() const { return isShown() && !isLastStill_ && !isBelowAsked(*last_); }

    /// Waits for a change, or until `deadline` if there is one.
    void waitForChange(std::unique_lock<std::mutex>& lock,
                       std::optional<Clock::time_point> deadline) {
        if (deadline.has_value())
            changed_.wait_until(lock, *deadline);
        else
            changed_.wait(lock);
    }

    // ---- The render thread.

    void renderLoop() {
        std::unique_lock lock(mutex_);
        while (!isStopping_) {
            if (mayRender())
                renderOne(lock);
            else
                waitForChange(lock, nextAttempt());
        }
    }

    /// When a frame is next to be drawn although nothing changes.
    std::optional<Clock::time_point> nextAttempt() const {
        if (isWaitingToRetry())
            return retryAt_;
        if (needsFull() && !hasRested())
            return wantedSince_ + options_.restDelay;
        return isRedrawDue() ? std::nullopt : redrawAt_;
    }

    void renderOne(std::unique_lock<std::mutex>& lock) {
        const ViewRequest view = *wanted_;
        coordinator::FrameRequest request = requestFor(view);
        if (hasRested())
            request.budgetMilliseconds.reset();
        // Measuring has no place in a limited time.
        request.measuresStages =
            !request.budgetMilliseconds && ++requested_ % kFramesToAMeasurement == 4;
        const Clock::time_point started = Clock::now();
        isRenderNeeded_ = false;
        redrawAt_.reset();
        isRendering_ = true;
        lock.unlock();
        absl::StatusOr<coordinator::RenderedFrame> frame = frames_.renderFrame(request);
        lock.lock();
        isRendering_ = false;
        if (frame.ok()) {
            pacer_.rendered(Clock::now() - started);
            setProblem(renderProblem_, "");
            retryAt_.reset();
            if (isSame(view, *wanted_))
                redrawUnlessComplete(frame->statistics);
            rendered_ =
                Picture{view, std::make_shared<const coordinator::RenderedFrame>(*std::move(frame)),
                        started, std::nullopt};
            if (!(request.camera == view.frame.camera))
                rendered_->liftedCamera = request.camera;
        } else {
            renderFailed(frame.status());
        }
        changed_.notify_all();
    }

    /// The view with its eye lifted out of the ground, unless it may be there.
    coordinator::FrameRequest requestFor(const ViewRequest& view) const {
        coordinator::FrameRequest request = view.frame;
        if (source_.has_value() && source_->sceneInfo.ground && !view.isUnderground)
            request.camera = fabric::aboveGround(request.camera, *source_->sceneInfo.ground,
                                                 request.look.exaggeration);
        return request;
    }

    void redrawUnlessComplete(const fabric::FrameStatistics& statistics) {
        isLoading_ = !statistics.complete && (statistics.pagesMissing == 0 ||
                                              statistics.pagesFailed < statistics.pagesMissing);
        if (!statistics.complete)
            redrawAt_ = Clock::now() + (isLoading_ ? options_.loadingDelay : options_.missingDelay);
    }

    void renderFailed(const absl::Status& status) {
        setProblem(renderProblem_, sanitised(text(status)));
        // A newer view is drawn at once; the same one, after a while.
        if (!isRenderNeeded_)
            retryAt_ = Clock::now() + options_.retryDelay;
        isRenderNeeded_ = true;
    }

    // ---- The encoder thread.

    void encodeLoop() {
        std::unique_lock lock(mutex_);
        while (!isStopping_) {
            if (isStateStale_)
                composeState(lock);
            else if (rendered_.has_value())
                encode(lock, *std::exchange(rendered_, std::nullopt));
            else if (needsStill() && hasRested() && hasRoom())
                encode(lock, Picture{last_->view, last_->frame, Clock::now(), last_->liftedCamera});
            else
                waitForChange(lock, needsStill() && hasRoom()
                                        ? std::optional(wantedSince_ + options_.restDelay)
                                        : std::nullopt);
        }
    }

    void encode(std::unique_lock<std::mutex>& lock, Picture picture) {
        const bool isStill = hasRested() && isSame(picture.view, *wanted_) && !isRenderNeeded_ &&
                             !isLoading_ && !isBelowAsked(picture);
        // The same view may have come again meanwhile: this is the answer to that, too.
        if (isSame(picture.view, *wanted_))
            picture.view.sequence = wanted_->sequence;
        const std::uint64_t frameNumber = ++lastFrameNumber_;
        isEncoding_ = true;
        lock.unlock();
        const absl::StatusOr<std::vector<std::byte>> jpeg = wire::encodeJpeg(
            picture.frame->image, isStill ? options_.stillQuality : options_.movingQuality,
            isStill ? wire::ChromaSubsampling::None : wire::ChromaSubsampling::Half);
        std::string message;
        if (jpeg.ok())
            message = frameMessage(
                {frameNumber, picture.view.sequence, isStill, *jpeg, picture.liftedCamera},
                *picture.frame);
        lock.lock();
        isEncoding_ = false;
        isLastStill_ = isStill || !jpeg.ok();
        if (jpeg.ok())
            waitingFrame_ = WaitingFrame{frameNumber, isStill, picture.started, std::move(message)};
        else
            setProblem(renderProblem_, sanitised(text(jpeg.status())));
        last_ = std::move(picture);
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
        if (isOther && wanted_.has_value()) {
            isRenderNeeded_ = true;
            retryAt_.reset();
        }
        source_ = std::move(source);
        if (message != lastState_) {
            lastState_ = message;
            waitingState_ = std::move(message);
        }
        announce(lock);
    }

    void announce(std::unique_lock<std::mutex>& lock) {
        const bool hasMessage = !isStopping_ && (waitingState_.has_value() || mayTakeFrame());
        lock.unlock();
        changed_.notify_all();
        if (hasMessage)
            messageReady_();
        lock.lock();
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
    const ViewerOptions options_;

    std::uint64_t requested_ = 0;  // of the render thread
    std::mutex mutex_;             // guards everything below, up to the threads
    std::condition_variable changed_;
    bool isStopping_ = false;
    Pacer pacer_;

    std::optional<ViewRequest> wanted_;
    Clock::time_point wantedSince_;  // when the view, not just its number, became another
    bool isRenderNeeded_ = false;
    std::optional<Clock::time_point> retryAt_;   // set after a failure
    std::optional<Clock::time_point> redrawAt_;  // set after an incomplete frame of this view
    bool isLoading_ = false;                     // that frame lacked data that are on their way
    std::optional<PictureSource> source_;

    bool isRendering_ = false;
    std::optional<Picture> rendered_;  // for the encoder to take
    bool isEncoding_ = false;
    std::optional<Picture> last_;
    bool isLastStill_ = false;
    std::uint64_t lastFrameNumber_ = 0;
    std::optional<WaitingFrame> waitingFrame_;

    bool isStateStale_ = true;
    std::string requestProblem_;
    std::string renderProblem_;
    std::string lastState_;
    std::optional<std::string> waitingState_;

    PickDesk picks_;
    int subscription_ = 0;
    std::thread encoder_;
    std::thread renderer_;
};

Viewer::Viewer(coordinator::FrameSource& frames, std::function<void()> messageReady,
               const ViewerOptions& options)
    : impl_(std::make_unique<Impl>(frames, std::move(messageReady), options)) {}

Viewer::~Viewer() = default;

absl::Status Viewer::receive(std::span<const std::byte> message) { return impl_->receive(message); }

std::optional<std::string> Viewer::takeMessage() { return impl_->takeMessage(); }

void Viewer::stop() { impl_->stop(); }

}  // namespace eyrie::stream
