// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "coordinator/frame/crew.h"
#include "coordinator/frame/patience.h"
#include "fabric/channel_task.h"
#include "fabric/frame_data.h"

namespace eyrie::coordinator {

/// The drawing of one frame by the crew, from its tasks to their results.
///
/// Each task goes to a renderer. Where that fails, or takes too long while another one idles, the
/// task goes to the other as well, to each renderer once at most; the first result counts. Answers
/// that come after the dispatch has ended are dropped.
class Dispatch : public std::enable_shared_from_this<Dispatch> {
public:
    struct Drawn {
        fabric::ChannelResult result;
        fabric::DeviceInfo device;          ///< of the renderer that drew it
        std::chrono::milliseconds taken{};  ///< by that renderer
    };

    struct Plan {
        fabric::FrameData frameData;
        std::vector<fabric::ChannelTask> tasks;
        std::uint64_t sceneRevision = 0;
        std::chrono::milliseconds lateAfter{};    ///< then another renderer is asked as well
        std::chrono::milliseconds callTimeout{};  ///< then the renderer is given up
    };

    explicit Dispatch(Plan plan);

    /// One result per task, in their order. `crew` outlives the calls to its renderers that the
    /// dispatch may leave behind. Errors: what the last renderer said about a task, or Unavailable
    /// when none is ready.
    absl::StatusOr<std::vector<Drawn>> run(Crew& crew);

private:
    using Clock = ChannelRenderer::Clock;

    struct Part {
        bool done = false;
        Drawn drawn;
        int running = 0;                 ///< renderers at work on it
        Clock::time_point late;          ///< when to ask another one as well
        std::vector<std::string> asked;  ///< ids of renderers
        absl::Status error = absl::UnavailableError("no renderer is ready");
    };
    bool isDone() const;
    absl::Status assign(Crew& crew);
    /// OK, too, when the part has to wait for a renderer; the part's error when none is left.
    absl::Status assign(std::size_t index, const std::vector<std::shared_ptr<Member>>& members,
                        Crew& crew);
    std::ptrdiff_t timesAsked(const Member& member) const;
    void start(std::size_t index, Member& member, Crew& crew);
    void finish(std::size_t index, const Member& member, Clock::time_point started,
                absl::StatusOr<fabric::ChannelResult> result);

    const Plan plan_;
    std::mutex mutex_;  ///< guards what follows
    std::condition_variable changed_;
    std::vector<Part> parts_;
};

}  // namespace eyrie::coordinator
