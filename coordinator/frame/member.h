// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "coordinator/farm/channel_renderer.h"
#include "fabric/statistics.h"

namespace eyrie::coordinator {

/// A living renderer at work, and the thread that talks to it: one job after the other.
/// All functions may be called from any thread; `done` functions run on the member's own.
class Member {
public:
    using Clock = ChannelRenderer::Clock;
    using OpenDone = std::function<void(absl::StatusOr<fabric::SceneInfo>)>;
    using DrawDone = std::function<void(absl::StatusOr<fabric::ChannelResult>)>;

    Member(std::string id, fabric::DeviceInfo device, std::shared_ptr<ChannelRenderer> renderer);

    /// Cancels what is in progress and waits for the thread.
    ~Member();
    Member(const Member&) = delete;
    Member& operator=(const Member&) = delete;

    const std::string& id() const { return id_; }
    const fabric::DeviceInfo& device() const { return device_; }

    /// Nothing to do: a job given now starts now. True already when `done` is called, but for a
    /// failure.
    bool isIdle() const { return pending_ == 0; }

    /// Of the scene it has open; 0: none.
    std::uint64_t openRevision() const { return openRevision_; }

    /// Opens a scene, known from then on by `revision`.
    void open(std::shared_ptr<const fabric::Scene> scene, std::uint64_t revision,
              std::chrono::milliseconds timeout, OpenDone done);

    /// Draws a channel of the scene known by `revision`; Aborted when another one is open by then.
    /// Sends the frame data first where the renderer does not have that version.
    void draw(const fabric::FrameData& frameData, const fabric::ChannelTask& task,
              std::uint64_t revision, std::chrono::milliseconds timeout, DrawDone done);

    /// What a place of a picture of the scene known by `revision` shows; Aborted when another one
    /// is open. Beside the jobs, on the caller's thread.
    absl::StatusOr<fabric::Picked> pick(const fabric::PickRequest& request, std::uint64_t revision,
                                        std::chrono::milliseconds timeout);

    /// Ends: jobs in progress and in the queue fail soon. Does not wait.
    void retire();
    bool hasEnded() const { return ended_; }

private:
    void post(std::function<void()> job);
    void work();
    absl::StatusOr<fabric::ChannelResult> drawNow(const fabric::FrameData& frameData,
                                                  const fabric::ChannelTask& task,
                                                  std::uint64_t revision,
                                                  std::chrono::milliseconds timeout);

    const std::string id_;
    const fabric::DeviceInfo device_;
    const std::shared_ptr<ChannelRenderer> renderer_;
    std::uint64_t sentVersion_ = 0;  ///< of the frame data; the thread's own
    std::atomic<std::uint64_t> openRevision_{0};
    std::atomic<int> pending_{0};
    std::atomic<bool> ended_{false};
    std::mutex mutex_;  ///< guards jobs_ and retired_
    std::condition_variable changed_;
    std::deque<std::function<void()>> jobs_;
    bool retired_ = false;
    std::thread thread_;
};

}  // namespace eyrie::coordinator
