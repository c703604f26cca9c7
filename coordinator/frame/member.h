// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "coordinator/farm/channel_renderer.h"
#include "coordinator/frame/patience.h"
#include "fabric/statistics.h"

namespace eyrie::coordinator {

/// A living renderer at work, and the thread that talks to it: one job after the other.
/// All functions may be called from any thread; `done` functions run on the member's own.
class Member {
public:
    using Clock = ChannelRenderer::Clock;
    using OpenDone = std::function<void(absl::StatusOr<fabric::SceneInfo>)>;
    /// `taken` from the renderer being asked to the picture being here.
    using DrawDone =
        std::function<void(absl::StatusOr<fabric::ChannelResult>, Clock::duration taken)>;

    Member(std::string id, fabric::DeviceInfo device, std::shared_ptr<ChannelRenderer> renderer,
           const PatienceOptions& patience = {});

    /// Cancels what is in progress and waits for the thread.
    ~Member();
    Member(const Member&) = delete;
    Member& operator=(const Member&) = delete;

    const std::string& id() const { return id_; }
    const fabric::DeviceInfo& device() const { return device_; }

    /// Nothing to do: a job given now starts now. True already when `done` is called, but for a
    /// failure.
    bool isIdle() const { return pending_ == 0; }

    /// How long it may take for a channel of a frame of `kind`: Patience::limit, by those it has
    /// drawn.
    std::optional<std::chrono::milliseconds> patience(std::uint64_t kind) const;

    /// Whether it has a channel in hand that another was asked for as well, until it has done with
    /// it. Setting it tells what it was before.
    bool isLate() const { return late_; }
    bool setLate(bool late) { return late_.exchange(late); }

    /// Opens a scene, known from then on by `revision`.
    void open(std::shared_ptr<const fabric::Scene> scene, std::uint64_t revision,
              std::chrono::milliseconds timeout, OpenDone done);

    /// What to draw, and how.
    struct Draw {
        const fabric::FrameData& frameData;
        const fabric::ChannelTask& task;
        std::uint64_t revision = 0;  ///< of the scene; Aborted when another one is open by then
        std::uint64_t kind = 0;      ///< of the frame, for patience()
        std::chrono::milliseconds patience{};  ///< how long it is given before it is late
        std::chrono::milliseconds timeout{};
    };
    /// Sends the frame data first where the renderer does not have that version. Copies `what`.
    void draw(const Draw& what, DrawDone done);

    /// Sends the frame data where the renderer does not have that version, after the jobs before.
    std::future<absl::Status> prepare(const fabric::FrameData& frameData, std::uint64_t revision,
                                      std::chrono::milliseconds timeout);

    /// ChannelRenderer::runProgram, beside the jobs and on the caller's thread; Aborted when
    /// another scene is open.
    absl::StatusOr<fabric::ProgramResult> runProgram(const fabric::ChannelProgram& program,
                                                     std::uint64_t revision,
                                                     std::chrono::milliseconds timeout,
                                                     const std::stop_token& stop);

    /// What a place of a picture of the scene known by `revision` shows; Aborted when another one
    /// is open. Beside the jobs, on the caller's thread.
    absl::StatusOr<fabric::Picked> pick(const fabric::PickRequest& request, std::uint64_t revision,
                                        std::chrono::milliseconds timeout);

    /// Calls `left` when the jobs given before are done.
    void leave(std::function<void()> left);

    /// Ends: jobs in progress and in the queue fail soon. Does not wait.
    void retire();
    bool hasEnded() const { return ended_; }

private:
    void post(std::function<void()> job);
    void work();
    absl::Status sendFrameData(const fabric::FrameData& frameData, std::uint64_t revision,
                               Clock::time_point deadline);
    absl::StatusOr<fabric::ChannelResult> drawNow(const fabric::FrameData& frameData,
                                                  const fabric::ChannelTask& task,
                                                  std::uint64_t revision,
                                                  std::chrono::milliseconds timeout);

    const std::string id_;
    const fabric::DeviceInfo device_;
    const std::shared_ptr<ChannelRenderer> renderer_;
    std::uint64_t sentVersion_ = 0;               ///< of the frame data; the thread's own
    std::atomic<std::uint64_t> openRevision_{0};  ///< of the scene it has open; 0: none
    std::atomic<int> pending_{0};
    std::atomic<bool> late_{false};
    std::atomic<bool> ended_{false};
    mutable std::mutex mutex_;  ///< guards patience_, jobs_ and retired_
    Patience patience_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> jobs_;
    bool retired_ = false;
    std::thread thread_;
};

}  // namespace eyrie::coordinator
