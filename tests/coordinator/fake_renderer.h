// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "coordinator/farm/channel_renderer.h"
#include "layered_scene.h"
#include "wire/jpeg.h"

namespace eyrie::coordinator {

/// A renderer in this process that draws a LayeredScene, and fails or hangs when told to.
class FakeRenderer final : public ChannelRenderer {
public:
    explicit FakeRenderer(std::shared_ptr<const LayeredScene> scene) : scene_(std::move(scene)) {}

    absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene& scene,
                                                Clock::time_point) override {
        std::unique_lock lock(mutex_);
        ++asked;
        changed_.wait(lock, [this] { return !holdsOpening_ || cancelled_; });
        if (!openStatus_.ok())
            return openStatus_;
        opened.push_back(scene.objects.at(0).name);
        return fabric::SceneInfo{{{0, 0, 0}, {1, 1, 1}}, 30, 100, {}, files};
    }

    absl::Status setFrameData(const fabric::FrameData& frameData, Clock::time_point) override {
        const std::lock_guard lock(mutex_);
        versions.push_back(frameData.version);
        budget_ = frameData.budget;
        return absl::OkStatus();
    }

    absl::StatusOr<fabric::ChannelResult> render(const fabric::ChannelTask& task,
                                                 Clock::time_point deadline,
                                                 const ChannelNews& news = {},
                                                 const fabric::FrameData* frameData = nullptr,
                                                 const std::stop_token& stop = {}) override {
        if (frameData != nullptr)
            static_cast<void>(setFrameData(*frameData, deadline));
        ++begun;
        std::unique_lock lock(mutex_);
        most = std::max(most.load(), ++drawing_);
        frames.push_back(task.frameNumber);
        tasks[task.frameNumber] = task.frameDataVersion;
        absl::StatusOr<fabric::ChannelResult> result = draw(task, deadline, stop, lock);
        --drawing_;
        if (result.ok()) {
            lock.unlock();
            if (news.waited)
                news.waited(saysItWaited.load());
            if (news.drawn)
                news.drawn();
            lock.lock();
        }
        changed_.wait_until(lock, stop, deadline, [this] { return !holdsPictures_ || cancelled_; });
        if (cancelled_ || stop.stop_requested())
            return absl::CancelledError("cancelled");
        return result;
    }

    absl::StatusOr<fabric::Picked> pick(const fabric::PickRequest& request,
                                        Clock::time_point) override {
        ++picks;
        const std::lock_guard lock(mutex_);
        if (!pickStatus_.ok())
            return pickStatus_;
        fabric::PickedPoint point;
        point.object = pickedObject;
        point.worldMetres = {request.place, 0};
        return fabric::Picked(point);
    }

    void cancel() override { set(cancelled_, true); }

    void hang(bool hangs) { set(hangs_, hangs); }
    /// What it draws meanwhile does not arrive before the end of that.
    void holdPictures(bool holds) { set(holdsPictures_, holds); }
    void holdOpening(bool holds) { set(holdsOpening_, holds); }
    void failToOpen(const absl::Status& status) { set(openStatus_, status); }
    void failToRender(const absl::Status& status) { set(renderStatus_, status); }
    void failToPick(const absl::Status& status) { set(pickStatus_, status); }

    std::vector<fabric::DataFile> files;             ///< that it finds
    std::atomic<std::chrono::milliseconds> takes{};  ///< really, for a channel
    std::atomic<std::chrono::nanoseconds> saysItWaited{};
    std::atomic<int> asked{0};                     ///< to open a scene
    std::vector<std::string> opened;               ///< names of the scenes' first objects
    std::vector<std::uint64_t> versions;           ///< of the frame data received
    std::vector<std::uint64_t> frames;             ///< numbers of those it began to draw
    std::map<std::uint64_t, std::uint64_t> tasks;  ///< versions of the frame data, by frames
    std::atomic<int> most{0};                      ///< channels that it was drawing at once
    std::atomic<int> begun{0};
    std::atomic<int> drawn{0};
    std::atomic<double> share{0};  ///< of the frame, that the last channel was
    /// Said to be taken for the whole of it: so long that what the machine does besides is nothing.
    std::atomic<double> millisecondsAFrame{1000};
    std::atomic<std::uint64_t> pagesLoaded{0};  ///< said to have been, for a channel
    std::atomic<int> picks{0};
    std::atomic<int> pickedObject{0};

private:
    absl::StatusOr<fabric::ChannelResult> draw(const fabric::ChannelTask& task,
                                               Clock::time_point deadline,
                                               const std::stop_token& stop,
                                               std::unique_lock<std::mutex>& lock) {
        if (std::ranges::find(versions, task.frameDataVersion) == versions.end())
            return absl::FailedPreconditionError("the fake has no such frame data");
        if (takes.load().count() > 0)
            changed_.wait_for(lock, stop, takes.load(), [this] { return cancelled_; });
        changed_.wait_until(lock, stop, deadline, [this] { return !hangs_ || cancelled_; });
        if (cancelled_ || stop.stop_requested())
            return absl::CancelledError("cancelled");
        if (hangs_)
            return absl::DeadlineExceededError("the fake hung");
        if (!renderStatus_.ok())
            return renderStatus_;
        ++drawn;
        share = (task.range.end - task.range.begin) *
                static_cast<double>(task.pixelViewport.area()) /
                (static_cast<double>(task.viewWidth) * task.viewHeight);
        fabric::ChannelResult result = scene_->draw(task);
        if (task.jpegQuality > 0)
            encode(task, result);
        result.statistics.milliseconds.total = share * millisecondsAFrame;
        result.statistics.pagesLoaded = pagesLoaded;
        // It takes longer than any tau could help.
        if (budget_) {
            result.statistics.budget = fabric::tauForBudget(
                1, *budget_, 1, [](double) { return std::uint64_t{1'000'000}; });
            std::this_thread::sleep_for(std::chrono::milliseconds(3));
        }
        return result;
    }

    static void encode(const fabric::ChannelTask& task, fabric::ChannelResult& result) {
        fabric::Image whole =
            fabric::makeImage(task.pixelViewport, LayeredScene::kBackground, false);
        fabric::paste(result.image, whole);
        result.jpeg =
            wire::encodeJpeg(whole, task.jpegQuality, wire::ChromaSubsampling::Half).value();
        result.image.colour.clear();
    }

    template <typename T>
    void set(T& variable, const T& value) {
        {
            const std::lock_guard lock(mutex_);
            variable = value;
        }
        changed_.notify_all();
    }

    const std::shared_ptr<const LayeredScene> scene_;
    std::mutex mutex_;
    std::condition_variable_any changed_;
    int drawing_ = 0;
    bool hangs_ = false;
    bool holdsOpening_ = false;
    bool holdsPictures_ = false;
    bool cancelled_ = false;
    std::optional<fabric::FrameBudget> budget_;
    absl::Status openStatus_;
    absl::Status renderStatus_;
    absl::Status pickStatus_;
};

}  // namespace eyrie::coordinator
