// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <stop_token>

#include <absl/status/statusor.h>

#include "fabric/channel_program.h"
#include "fabric/channel_task.h"
#include "fabric/frame_data.h"
#include "fabric/pick.h"
#include "fabric/scene.h"

namespace eyrie::coordinator {

/// Whom to tell of a channel before its picture is here: on the thread that asked, each once at
/// most.
struct ChannelNews {
    /// The renderer can take the next task, for it has drawn or does the last of it.
    std::function<void()> drawn = {};
    /// So long the task waited at the renderer, behind what that had to do before.
    std::function<void(std::chrono::nanoseconds)> waited = {};
};

/// A renderer as the coordinator sees it: one behind gRPC, or one in this process.
///
/// openScene, setFrameData and render are called by one thread at a time and block, but for a
/// render that has told of `drawn`: the others may be called beside that. runProgram and pick
/// block, too, but may be called beside them from any thread, as may cancel. Of errors, Unavailable
/// and DeadlineExceeded say that the renderer is gone.
class ChannelRenderer {
public:
    using Clock = std::chrono::steady_clock;

    virtual ~ChannelRenderer() = default;

    /// Aborted: its data cannot be had just now, and it may be asked again.
    virtual absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene& scene,
                                                        Clock::time_point deadline) = 0;
    virtual absl::Status setFrameData(const fabric::FrameData& frameData,
                                      Clock::time_point deadline) = 0;
    /// `frameData` is what the task names, where setFrameData has not sent it: one call less.
    ///
    /// The image lies inside the task's pixel viewport, fills its area, and has depth if the task
    /// wants it (and is not empty). `stop` ends this call, in the renderer too, with Cancelled.
    virtual absl::StatusOr<fabric::ChannelResult> render(
        const fabric::ChannelTask& task, Clock::time_point deadline, const ChannelNews& news = {},
        const fabric::FrameData* frameData = nullptr, const std::stop_token& stop = {}) = 0;

    /// Carries out a channel program: draws and exchanges pictures with the renderers that it
    /// names, which run the programs on the other side. Pictures as the program's outputs say. The
    /// frame data of its draws have been sent before. Unlike render it may be called beside itself
    /// and the others, since programs wait for each other; `stop` ends this call alone, with
    /// Cancelled. Whatever it fails with, the frame can be drawn without it. Unimplemented where
    /// pictures cannot be exchanged.
    virtual absl::StatusOr<fabric::ProgramResult> runProgram(const fabric::ChannelProgram& program,
                                                             Clock::time_point deadline,
                                                             const std::stop_token& stop = {}) {
        static_cast<void>(program);
        static_cast<void>(deadline);
        static_cast<void>(stop);
        return absl::UnimplementedError("this renderer exchanges no pictures with others");
    }

    /// What a place of a picture of the open scene shows.
    virtual absl::StatusOr<fabric::Picked> pick(const fabric::PickRequest& request,
                                                Clock::time_point deadline) = 0;

    /// Whether a connection to it that there was has ended, as it does at once when the process
    /// dies. From any thread; does not wait.
    virtual bool hasLostConnection() { return false; }

    /// Ends the calls in progress, and every later one, soon, with Cancelled.
    virtual void cancel() = 0;
};

}  // namespace eyrie::coordinator
