// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "coordinator/frame/frame_source.h"

namespace eyrie::coordinator {

/// Pictures of one colour, as large as asked for; of further ones, each has a little more red.
inline RenderedFrame plainFrame(const FrameRequest& request, fabric::Rgba colour) {
    RenderedFrame frame;
    frame.image = fabric::makeImage(request.drawnPart(), colour, false);
    frame.pictures.emplace_back();
    for (std::size_t i = 1; i < request.shown.size(); ++i) {
        colour.r = static_cast<std::uint8_t>(colour.r + 40);
        frame.further.push_back(fabric::makeImage(frame.image.area, colour, false));
        frame.pictures.push_back({.shown = i, .seen = {}});
    }
    frame.statistics.tauAskedPixels = request.tauPixels;
    frame.statistics.tauAchievedPixels = request.tauPixels;
    frame.statistics.triangles = 1000;
    frame.device.renderer = "fake";
    frame.device.software = true;
    return frame;
}

/// One renderer and a scene of a hundred metres.
inline Status readyStatus() {
    Status status;
    RendererStatus renderer;
    renderer.id = "renderer-1";
    renderer.device.renderer = "fake";
    renderer.device.software = true;
    status.renderers.push_back(renderer);
    fabric::SceneObject object;
    object.name = "hill";
    object.path = "hill.eyt";
    status.scene.objects.push_back(object);
    status.sceneInfo.bounds = {{0, 0, 0}, {100, 100, 10}};
    status.sceneInfo.triangles = 1'000'000;
    status.sceneInfo.objects = {{status.sceneInfo.bounds, status.sceneInfo.triangles}};
    return status;
}

/// Frames drawn by a function. Records what was asked of it; can be held back.
class FakeFrameSource : public FrameSource {
public:
    using Draw = std::function<absl::StatusOr<RenderedFrame>(const FrameRequest&)>;
    using Seen = std::function<absl::StatusOr<fabric::SeenAreas>(const FrameRequest&)>;
    using Pick = std::function<absl::StatusOr<fabric::Picked>(const fabric::PickRequest&)>;

    FakeFrameSource() : status_(readyStatus()) {
        draw_ = [](const FrameRequest& request) { return plainFrame(request, {90, 120, 60, 255}); };
    }

    absl::StatusOr<RenderedFrame> renderFrame(const FrameRequest& request) override {
        std::unique_lock lock(mutex_);
        requests_.push_back(request);
        changed_.notify_all();
        if (!changed_.wait(lock, request.stop, [this] { return !isHeld_; }))
            return absl::CancelledError("nobody wants it any more");
        const Draw draw = draw_;
        lock.unlock();
        return draw(request);
    }

    absl::StatusOr<fabric::SeenAreas> seen(const FrameRequest& request) override {
        const Seen seen = [this] {
            const std::lock_guard lock(mutex_);
            return seen_;
        }();
        return seen(request);
    }

    absl::StatusOr<fabric::Picked> pick(const fabric::PickRequest& request) override {
        std::unique_lock lock(mutex_);
        picks_.push_back(request);
        changed_.notify_all();
        changed_.wait(lock, [this] { return !arePicksHeld_; });
        const Pick pick = pick_;
        lock.unlock();
        return pick(request);
    }

    absl::Status configure(const SwitchLayout& change) override {
        Status status = this->status();
        for (CanvasStatus& canvas : status.canvases) {
            const auto known = std::ranges::find(canvas.layouts, change.layout);
            if (known == canvas.layouts.end())
                return absl::NotFoundError("there is no layout " + change.layout);
            canvas.layout = change.layout;
        }
        setStatus(status);
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return !areSwitchesHeld_; });
        return absl::OkStatus();
    }

    Status status() const override {
        const std::lock_guard lock(mutex_);
        return status_;
    }

    int subscribe(std::function<void()> listener) override {
        const std::lock_guard lock(listenersMutex_);
        listeners_[++lastHandle_] = std::move(listener);
        return lastHandle_;
    }

    void unsubscribe(int handle) override {
        const std::lock_guard lock(listenersMutex_);
        listeners_.erase(handle);
    }

    void setDraw(Draw draw) {
        const std::lock_guard lock(mutex_);
        draw_ = std::move(draw);
    }

    void setStatus(Status status) {
        {
            const std::lock_guard lock(mutex_);
            status_ = std::move(status);
        }
        const std::lock_guard lock(listenersMutex_);
        for (const auto& [handle, listener] : listeners_) listener();
    }

    /// While held, renderFrame waits, or until its request is stopped.
    void hold(bool isHeld) {
        {
            const std::lock_guard lock(mutex_);
            isHeld_ = isHeld;
        }
        changed_.notify_all();
    }

    void setPick(Pick pick) {
        const std::lock_guard lock(mutex_);
        pick_ = std::move(pick);
    }

    void setSeen(Seen seen) {
        const std::lock_guard lock(mutex_);
        seen_ = std::move(seen);
    }

    /// While held, pick waits.
    void holdPicks(bool isHeld) {
        {
            const std::lock_guard lock(mutex_);
            arePicksHeld_ = isHeld;
        }
        changed_.notify_all();
    }

    /// While held, configure does not return, though the layout is shown.
    void holdSwitches(bool isHeld) {
        {
            const std::lock_guard lock(mutex_);
            areSwitchesHeld_ = isHeld;
        }
        changed_.notify_all();
    }

    std::vector<fabric::PickRequest> picks() const {
        const std::lock_guard lock(mutex_);
        return picks_;
    }

    std::vector<FrameRequest> requests() const {
        const std::lock_guard lock(mutex_);
        return requests_;
    }

    /// Waits until renderFrame has been called `count` times; false after ten seconds.
    bool waitForRequests(std::size_t count) const {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, std::chrono::seconds(10),
                                 [&] { return requests_.size() >= count; });
    }

    /// The same for pick.
    bool waitForPicks(std::size_t count) const {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, std::chrono::seconds(10),
                                 [&] { return picks_.size() >= count; });
    }

    std::size_t listenerCount() const {
        const std::lock_guard lock(listenersMutex_);
        return listeners_.size();
    }

private:
    mutable std::mutex mutex_;
    mutable std::condition_variable_any changed_;
    Status status_;
    Draw draw_;
    bool isHeld_ = false;
    std::vector<FrameRequest> requests_;
    bool arePicksHeld_ = false;
    bool areSwitchesHeld_ = false;
    Pick pick_ = [](const fabric::PickRequest&) { return fabric::Picked(); };
    std::vector<fabric::PickRequest> picks_;
    Seen seen_ = [](const FrameRequest&) { return fabric::SeenAreas(); };

    mutable std::mutex listenersMutex_;  // held while listeners run, so that unsubscribe waits
    std::map<int, std::function<void()>> listeners_;
    int lastHandle_ = 0;
};

}  // namespace eyrie::coordinator
