// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <vector>

#include "coordinator/frame/crew.h"
#include "coordinator/frame/patience.h"
#include "coordinator/frame/takers.h"
#include "coordinator/observe/telemetry.h"
#include "fabric/channel_task.h"
#include "fabric/frame_data.h"

namespace eyrie::coordinator {

/// The drawing of one frame by the crew, from its tasks to their results.
///
/// Each task goes to a renderer, which may have those of earlier frames to draw before. Where that
/// fails, or takes longer than that renderer's patience (Patience, by what it drew lately; while
/// nothing is known of it, by the slowest other) from when it began, or has not begun because it is
/// late with another frame, and another renderer idles, the task goes to the other as well, to each
/// renderer once at most; the first result counts. What has not begun when it is no longer needed
/// is not drawn, and answers that come after the dispatch has ended are dropped.
class Dispatch : public std::enable_shared_from_this<Dispatch> {
public:
    struct Drawn {
        fabric::ChannelResult result;
        fabric::DeviceInfo device;                    ///< of the renderer that drew it
        std::chrono::steady_clock::duration taken{};  ///< by it, transmission included
        std::string renderer = {};                    ///< its id
    };

    struct Plan {
        fabric::FrameData frameData;
        std::vector<fabric::ChannelTask> tasks;
        std::uint64_t sceneRevision = 0;
        /// Of frames that take about as long (FrameKinds): what was learned from them holds.
        std::uint64_t kind = 0;
        std::chrono::milliseconds firstPatience{};  ///< while nothing is known of any renderer
        std::chrono::milliseconds callTimeout{};    ///< then the renderer is given up
        /// Several tasks of one renderer are drawn one after the other. It is not waited for while
        /// it is late. What is in a queue waits for a taker that has nothing to do.
        Takers takers = {};
        /// Called, with locks held, when each task has been given to a renderer or waits for one.
        std::function<void()> handedOut = [] {};
        /// Called, from any thread and even when the dispatch has ended, whenever a renderer may
        /// have its next task.
        std::function<void()> freed = [] {};
        observe::SharedTelemetry telemetry = nullptr;  ///< is told of tasks given to another
        std::stop_token stop = {};                     ///< ends it, and what renderers do for it
    };

    explicit Dispatch(Plan plan);

    /// One result per task, in their order. `crew` outlives the calls to its renderers that the
    /// dispatch may leave behind. Errors: what the last renderer said about a task, or Unavailable
    /// when none is ready; Cancelled.
    absl::StatusOr<std::vector<Drawn>> run(Crew& crew);

private:
    using Clock = ChannelRenderer::Clock;

    struct Part {
        bool done = false;
        Drawn drawn;
        std::vector<std::string> asked;   ///< ids of renderers, in turn
        std::vector<std::string> atWork;  ///< those of them that have it, drawn or to be drawn
        std::vector<std::string> slow;    ///< those at work that are late with it
        bool hasBegun = false;            ///< the one that was asked last, with it
        Clock::time_point late;           ///< when to ask another one as well, if it has begun
        absl::Status error = absl::UnavailableError("no renderer is ready");
    };
    using Members = std::vector<std::shared_ptr<Member>>;

    bool isDone() const;
    Clock::time_point nextLook() const;
    absl::Status assignUnlessStopped(Crew& crew);
    absl::Status assign(Crew& crew);
    /// OK, too, when the part has to wait for a renderer; the part's error when none is left.
    absl::Status assign(std::size_t index, const Members& members, Crew& crew);
    bool isOverdue(const Part& part, const Members& members) const;
    bool wasAsked(const Part& part, const Member& member) const;
    static bool isLastAtWork(const Part& part);
    Member* preferredOf(std::size_t index, const Members& members) const;
    const std::vector<std::string>* queueOf(std::size_t index) const;
    Member* takerOf(std::size_t index, const std::vector<std::string>& takers,
                    const Members& members) const;
    Member* idleOf(const Part& part, const Members& members) const;
    std::ptrdiff_t timesAsked(const Member& member) const;
    std::chrono::milliseconds patienceWith(const Member& member, const Members& members) const;
    void noteReissue(std::size_t index, const Member& chosen, const Members& members);
    void noteLate(Part& part, const Members& members);
    void giveUp(const Members& members);
    void start(std::size_t index, Member& member, const Members& members, Crew& crew);
    bool begin(std::size_t index, const Member& member, std::chrono::milliseconds patience);
    bool finish(std::size_t index, Member& member, absl::StatusOr<fabric::ChannelResult> result,
                Clock::duration taken);

    const Plan plan_;
    std::mutex mutex_;  ///< guards what follows
    std::condition_variable changed_;
    std::vector<Part> parts_;
    bool someAreLate_ = false;  ///< since the crew was told
    bool hasEnded_ = false;
};

}  // namespace eyrie::coordinator
