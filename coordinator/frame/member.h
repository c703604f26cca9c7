// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "coordinator/farm/channel_renderer.h"
#include "coordinator/frame/patience.h"
#include "fabric/statistics.h"

namespace eyrie::coordinator {

/// A living renderer at work, and the threads that talk to it: one job after the other, but that
/// the picture of a draw may still be on its way while the next job runs.
/// All functions may be called from any thread; functions given to it run on the member's own.
class Member {
public:
    using Clock = ChannelRenderer::Clock;
    using OpenDone = std::function<void(absl::StatusOr<fabric::SceneInfo>)>;
    /// `taken` from the renderer being asked to the picture being here, but for what it drew before
    /// meanwhile.
    using DrawDone =
        std::function<void(absl::StatusOr<fabric::ChannelResult>, Clock::duration taken)>;

    Member(std::string id, fabric::DeviceInfo device, std::shared_ptr<ChannelRenderer> renderer,
           const PatienceOptions& patience = {}, std::string node = {});

    /// Cancels what is in progress and waits for the threads.
    ~Member();
    Member(const Member&) = delete;
    Member& operator=(const Member&) = delete;

    const std::string& id() const { return id_; }
    const fabric::DeviceInfo& device() const { return device_; }
    /// Of a configuration, that it is to be, by name or host; empty: any.
    const std::string& node() const { return node_; }

    /// Nothing, or but the last of something, to draw or to open: a job given now starts now. True
    /// already when Draw::drawn, or `done` where there was none, is called, but for a failure.
    bool isIdle() const;

    /// How long it may take for a channel of a frame of `kind`: Patience::limit, by those it has
    /// drawn.
    std::optional<std::chrono::milliseconds> patience(std::uint64_t kind) const;

    /// Whether it has a channel in hand that another was asked for as well, until it has done with
    /// all such. Both return whether that has changed.
    bool isLate() const { return late_ > 0; }
    bool addLate() { return late_++ == 0; }
    bool removeLate() { return --late_ == 0; }

    /// Opens a scene, known from then on by `revision`. `done` is called with Cancelled where
    /// another one is to be opened by the time it has its turn.
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
        /// Asked when its turn has come: false, and it is not drawn but done with, as Cancelled.
        std::function<bool()> begins = {};
        /// Called once the renderer may have its next job, if that is before `done`.
        std::function<void()> drawn = {};
        std::stop_token stop = {};  ///< ends it, as Cancelled
    };
    /// Sends the frame data first where the renderer does not have that version. Copies `what`.
    /// False after retire(): `done` is not called then.
    bool draw(const Draw& what, DrawDone done);

    /// Sends the frame data where the renderer does not have that version, after the jobs before.
    std::future<absl::Status> prepare(const fabric::FrameData& frameData, std::uint64_t revision,
                                      std::chrono::milliseconds timeout);

    /// It is not idle, and does not leave, until what is returned is gone, which this outlives.
    std::shared_ptr<void> occupy();

    /// ChannelRenderer::runProgram, beside the jobs and on the caller's thread; Aborted when
    /// another scene is open, or is opened meanwhile.
    absl::StatusOr<fabric::ProgramResult> runProgram(const fabric::ChannelProgram& program,
                                                     std::uint64_t revision,
                                                     std::chrono::milliseconds timeout,
                                                     const std::stop_token& stop);

    /// What a place of a picture of the scene known by `revision` shows; Aborted when another one
    /// is open. Beside the jobs, on the caller's thread.
    absl::StatusOr<fabric::Picked> pick(const fabric::PickRequest& request, std::uint64_t revision,
                                        std::chrono::milliseconds timeout);

    /// Calls `left` when all that it was given is done, and nobody occupies it.
    void leave(std::function<void()> left);

    /// Ends: jobs in progress and in the queue fail soon, and no others are taken. Does not wait.
    void retire();
    bool hasEnded() const { return ended_ == kThreads; }

private:
    /// One draws while another takes in the picture before.
    static constexpr int kThreads = 2;

    /// The renderer, while a job has it to itself, which may end before the job does.
    class Hold {
    public:
        explicit Hold(Member& member) : member_(member) {}
        ~Hold() { end(); }
        Hold(const Hold&) = delete;
        Hold& operator=(const Hold&) = delete;
        void release();  ///< the next job may begin
        void end();      ///< and this one is done

    private:
        Member& member_;
        bool isHeld_ = true;
        bool hasEnded_ = false;
    };
    using Job = std::function<void(Hold&)>;

    /// False after retire(): there may be nobody left who would do it.
    bool post(Job job);
    void work();
    void drawNow(const Draw& what, Hold& hold, const DrawDone& done);
    absl::Status checkRevision(std::uint64_t revision) const;
    absl::Status sendFrameData(const fabric::FrameData& frameData, std::uint64_t revision,
                               Clock::time_point deadline);
    absl::StatusOr<fabric::ChannelResult> render(const Draw& what, Hold& hold,
                                                 Clock::duration& waited);

    const std::string id_;
    const fabric::DeviceInfo device_;
    const std::string node_;
    const std::shared_ptr<ChannelRenderer> renderer_;
    std::uint64_t sentVersion_ = 0;                 ///< of the frame data; the holder's own
    std::atomic<std::uint64_t> openRevision_{0};    ///< of the scene it has open; 0: none
    std::atomic<std::uint64_t> wantedRevision_{0};  ///< of that which it was last told to open
    std::atomic<int> late_{0};
    std::atomic<int> ended_{0};
    mutable std::mutex mutex_;  ///< guards what follows
    Patience patience_;
    std::condition_variable changed_;
    std::deque<Job> jobs_;
    bool isHeld_ = false;  ///< by a job
    int working_ = 0;      ///< threads that do a job
    int occupants_ = 0;
    bool retired_ = false;
    std::array<std::thread, kThreads> threads_;
};

}  // namespace eyrie::coordinator
