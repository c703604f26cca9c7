// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <stop_token>
#include <thread>

#include "service/channel_drawer.h"

namespace eyrie::service {

/// What a test sees of a FakeDrawer, and how it holds it up.
struct FakeDrawerControl {
    std::atomic<int> opened{0};  ///< scenes
    std::atomic<int> begun{0};
    std::atomic<int> drawn{0};
    std::atomic<int> givenUp{0};  ///< nobody wanted it any more
    std::atomic<bool> destroyed{false};
    std::atomic<bool> oneThread{true};

    /// The drawer waits in its next call until release, or until nobody wants that any more.
    void hold() {
        const std::lock_guard lock(mutex);
        held = true;
    }
    void release() {
        {
            const std::lock_guard lock(mutex);
            held = false;
        }
        changed.notify_all();
    }
    void waitWhileHeld(const std::stop_token& stop = {}) {
        std::unique_lock lock(mutex);
        changed.wait(lock, stop, [this] { return !held; });
    }

    std::atomic<bool> saysNearlyDrawn{false};  ///< before it waits
    std::atomic<bool> usesRoom{false};         ///< that it is given for its pixels
    std::atomic<bool> fails{false};
    std::atomic<bool> hasNoMemory{false};

    /// What is drawn in place of a gradient, once it is set; not while a call is under way.
    std::optional<fabric::Image> image;

    std::mutex mutex;
    std::condition_variable_any changed;
    bool held = false;
};

/// Draws a gradient of colour and depth, with tau in the statistics; opens every scene but
/// "absent", "silent" and "endless".
class FakeDrawer final : public ChannelDrawer {
public:
    explicit FakeDrawer(std::shared_ptr<FakeDrawerControl> control)
        : control_(std::move(control)) {}
    ~FakeDrawer() override {
        checkThread();
        control_->destroyed = true;
    }

    const fabric::DeviceInfo& device() const override { return device_; }

    absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene& scene) override {
        checkThread();
        if (!scene.objects.empty() && scene.objects[0].path == "absent")
            return absl::NotFoundError("absent: no such file");
        if (!scene.objects.empty() && scene.objects[0].path == "silent")
            return absl::UnavailableError("silent: no answer");
        if (!scene.objects.empty() && scene.objects[0].path == "endless")
            throw std::bad_alloc();
        ++control_->opened;
        return fabric::SceneInfo{{{0, 0, 0}, {1, 1, 1}}, 12, 34};
    }

    absl::StatusOr<fabric::ChannelResult> render(const fabric::FrameData& frameData,
                                                 const fabric::ChannelTask& task,
                                                 const fabric::Delivery& delivery) override {
        const std::stop_token& stop = delivery.stop;
        checkThread();
        ++control_->begun;
        if (control_->saysNearlyDrawn && delivery.nearlyDrawn)
            delivery.nearlyDrawn();
        control_->waitWhileHeld(stop);
        if (stop.stop_requested()) {
            ++control_->givenUp;
            return absl::CancelledError("stopped");
        }
        if (control_->fails)
            return absl::DataLossError("page 7 is damaged");
        if (control_->hasNoMemory)
            throw std::bad_alloc();
        ++control_->drawn;
        fabric::ChannelResult result = control_->image ? fabric::ChannelResult{*control_->image, {}}
                                                       : picture(frameData, task);
        if (control_->usesRoom && delivery.room)
            if (const auto room = delivery.room(result.image.area, task.wantsDepth)) {
                std::ranges::copy(result.image.colour, room->colour);
                std::ranges::copy(result.image.depth, room->depth);
                result.image = {result.image.area, {}, {}};
            }
        return result;
    }

    /// Picks what is at the place asked for, as far away as that is from the left.
    PickFunction pickFunction() const override {
        return [](const fabric::PickRequest& request,
                  std::chrono::steady_clock::time_point) -> absl::StatusOr<fabric::Picked> {
            if (request.place.x == 0)
                return fabric::Picked();
            if (request.place.y == 0)
                return absl::DataLossError("page 7 is damaged");
            fabric::PickedPoint point;
            point.worldMetres = {request.place, request.exaggeration};
            point.distanceMetres = request.place.x;
            point.nearestMetres = request.place.x - 0.25;
            point.farthestMetres = std::numeric_limits<double>::infinity();
            point.errorMetres = 0.125;
            point.elevationMetres = request.camera.eye.z;
            return fabric::Picked(point);
        };
    }

    DrawerMemory memory() const override { return {12, 34}; }

    static fabric::ChannelResult picture(const fabric::FrameData& frameData,
                                         const fabric::ChannelTask& task) {
        fabric::ChannelResult result;
        result.image = fabric::makeImage(task.pixelViewport, {}, task.wantsDepth);
        for (std::size_t i = 0; i < result.image.colour.size(); ++i) {
            result.image.colour[i].r = static_cast<std::uint8_t>(i);
            result.image.colour[i].g = static_cast<std::uint8_t>(i >> 8);
            if (task.wantsDepth)
                result.image.depth[i] = 1.0F / static_cast<float>(i + 1);
        }
        result.statistics.tauAskedPixels = frameData.tauPixels;
        return result;
    }

private:
    void checkThread() const {
        if (std::this_thread::get_id() != thread_)
            control_->oneThread = false;
    }

    const std::shared_ptr<FakeDrawerControl> control_;
    const std::thread::id thread_ = std::this_thread::get_id();
    const fabric::DeviceInfo device_{"Eyrie", "fake", "1.0", "none", true};
};

inline DrawerFactory fakeDrawers(std::shared_ptr<FakeDrawerControl> control) {
    return [control]() -> absl::StatusOr<std::unique_ptr<ChannelDrawer>> {
        return std::make_unique<FakeDrawer>(control);
    };
}

}  // namespace eyrie::service
