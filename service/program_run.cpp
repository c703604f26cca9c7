// SPDX-License-Identifier: Apache-2.0
#include "service/program_run.h"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "fabric/channel_buffer.h"
#include "fabric/status.h"
#include "service/drawn_channel.h"

namespace eyrie::service {
namespace {

using Clock = std::chrono::steady_clock;

/// What came of a draw, and what the drawer held after it.
struct Drawn {
    fabric::ChannelResult result;
    DrawerMemory memory;
};

absl::StatusOr<Drawn> drawWith(ChannelDrawer& drawer, const fabric::FrameData& frameData,
                               const fabric::ChannelTask& task, const std::stop_token& stop) {
    if (stop.stop_requested())
        return absl::CancelledError("nobody waits for this channel any more");
    ASSIGN_OR_RETURN(fabric::ChannelResult result,
                     drawnChannel(drawer, frameData, task, {.stop = stop}));
    return Drawn{std::move(result), drawer.memory()};
}

/// One draw on the GL thread, and who waits for it. Shared by both: the wait may end first.
class Draw {
public:
    void done(absl::StatusOr<Drawn> result) {
        {
            const std::lock_guard lock(mutex_);
            result_ = std::move(result);
        }
        changed_.notify_all();
    }

    absl::StatusOr<Drawn> await(Clock::time_point deadline, const std::stop_token& stop) {
        std::unique_lock lock(mutex_);
        const bool isDone =
            changed_.wait_until(lock, stop, deadline, [this] { return result_.has_value(); });
        if (isDone)
            return *std::move(result_);
        if (stop.stop_requested())
            return absl::CancelledError("nobody waits for this program's answer any more");
        return absl::DeadlineExceededError("the channel was not drawn in time");
    }

private:
    std::mutex mutex_;  ///< guards result_
    std::condition_variable_any changed_;
    std::optional<absl::StatusOr<Drawn>> result_;
};

class Run {
public:
    Run(const fabric::ChannelProgram& program, const ProgramTools& tools,
        Clock::time_point deadline, const std::stop_token& stop)
        : program_(program),
          tools_(tools),
          deadline_(deadline),
          stop_(stop),
          buffer_(program.area, program.background, program.hasDepth) {}

    absl::StatusOr<ProgramAnswer> all() {
        for (std::size_t i = 0; i < program_.stages.size(); ++i)
            RETURN_IF_ERROR(
                fabric::withContext(one(program_.stages[i]), fmt::format("stage {}", i)));
        return std::move(answer_);
    }

private:
    absl::Status one(const fabric::ProgramStage& stage) {
        if (stage.draw)
            RETURN_IF_ERROR(draw(*stage.draw));
        for (const fabric::ProgramInput& input : stage.inputs) {
            ASSIGN_OR_RETURN(fabric::Image image,
                             tools_.mailbox.await(key(input.frame), deadline_, stop_));
            buffer_.put(std::move(image), input.area, input.merge);
        }
        for (const fabric::ProgramOutput& output : stage.outputs) RETURN_IF_ERROR(send(output));
        return absl::OkStatus();
    }

    absl::Status draw(const fabric::ChannelTask& task) {
        ASSIGN_OR_RETURN(const fabric::FrameData frameData,
                         tools_.frameData.find(task.frameDataVersion));
        const auto draw = std::make_shared<Draw>();
        RETURN_IF_ERROR(
            tools_.thread.post([draw, frameData, task, stop = stop_](ChannelDrawer& drawer) {
                draw->done(drawWith(drawer, frameData, task, stop));
            }));
        ASSIGN_OR_RETURN(Drawn drawn, draw->await(deadline_, stop_));
        answer_.result.draws.push_back(drawn.result.statistics);
        answer_.memory = drawn.memory;
        buffer_.put(std::move(drawn.result.image), task.pixelViewport,
                    program_.hasDepth && task.wantsDepth ? fabric::Merge::DepthBehind
                                                         : fabric::Merge::Paste);
        return absl::OkStatus();
    }

    absl::Status send(const fabric::ProgramOutput& output) {
        fabric::Image image = buffer_.part(output.area, output.withDepth);
        if (!output.to.empty())
            return tools_.peers.send(output.to, key(output.frame), image, deadline_, stop_);
        answer_.result.pictures.push_back({output.frame, std::move(image)});
        return absl::OkStatus();
    }

    FrameKey key(std::uint32_t frame) const {
        return {program_.session, program_.frameNumber, frame};
    }

    const fabric::ChannelProgram& program_;
    const ProgramTools& tools_;
    const Clock::time_point deadline_;
    const std::stop_token stop_;
    fabric::ChannelBuffer buffer_;
    ProgramAnswer answer_;
};

}  // namespace

absl::StatusOr<ProgramAnswer> runProgram(const fabric::ChannelProgram& program,
                                         const ProgramTools& tools,
                                         std::chrono::steady_clock::time_point deadline,
                                         const std::stop_token& stop) {
    try {
        return Run(program, tools, deadline, stop).all();
    } catch (const std::bad_alloc&) {
        return absl::ResourceExhaustedError(
            "the renderer has no memory for this program's pictures; ask for fewer, or smaller "
            "ones");
    }
}

}  // namespace eyrie::service
