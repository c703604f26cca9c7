// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "coordinator/frame/budget_keeper.h"
#include "coordinator/frame/configuration_keeper.h"
#include "coordinator/frame/frame_kinds.h"
#include "coordinator/frame/picture_revision.h"
#include "coordinator/frame/planned_frame.h"

namespace eyrie::coordinator {

/// What frames have in common: the configuration they are made by, the versions of their data, and
/// what is learned from one for the next. All functions may be called from any thread.
class FramePlanner {
public:
    using Clock = std::chrono::steady_clock;

    /// As for ConfigurationKeeper, but `changed` is called without locks held: whoever hears of a
    /// change may ask for canvases() and displayRevision().
    FramePlanner(std::optional<config::Configuration> given, std::string layout,
                 std::function<void()> changed, ConfigurationKeeping keeping);

    /// The next frame, by the renderers that are `ready`. Errors: Unavailable (there is none);
    /// those of ActiveConfiguration::plan.
    absl::StatusOr<PlannedFrame> plan(const FrameRequest& asked, const Crew::State& scene,
                                      std::vector<std::shared_ptr<Member>> ready);

    /// What its draws took, for the configuration's equalizers. Frames come in their order. One
    /// that waited for data, or that is a part of a picture, tells nothing of how to share out the
    /// next.
    void record(const PlannedFrame& frame, const fabric::FrameStatistics& statistics,
                std::span<const ActiveConfiguration::Taken> taken);

    /// The frame that was `asked` for at `begun` is there, for the budget it had: what counts is
    /// the time since then or since the frame before it was there, as for who sees them. Frames
    /// come in their order. One that was planned at another size than the next will be teaches
    /// nothing.
    void finished(const FrameRequest& asked, const PlannedFrame& frame,
                  const fabric::FrameStatistics& statistics, Clock::time_point begun);

    /// From the next frame on; `scene` and `ready` as for plan(), here and below. Errors: those of
    /// ConfigurationKeeper::configure.
    absl::Status configure(const SwitchLayout& change, const Crew::State& scene,
                           const std::vector<std::shared_ptr<Member>>& ready);
    /// As ConfigurationAccess::withConfiguration.
    absl::Status withConfiguration(const std::function<absl::Status(ActiveConfiguration&)>& use,
                                   const Crew::State& scene,
                                   const std::vector<std::shared_ptr<Member>>& ready);
    /// As the next frame would find them.
    std::vector<CanvasStatus> canvases(const Crew::State& scene,
                                       const std::vector<std::shared_ptr<Member>>& ready);
    std::uint64_t displayRevision() const;
    std::size_t renderersWanted() const;

    /// As the configuration has it: config::framesUnderWay.
    int framesUnderWay() const;
    /// Ids of those that the last frame's configuration has something to do for.
    std::set<std::string> renderersUsed() const;

private:
    class Turn;

    void meet(const Crew::State& scene, const std::vector<std::shared_ptr<Member>>& ready);
    const fabric::FrameData& frameDataFor(const FrameRequest& request,
                                          const std::optional<fabric::FrameBudget>& budget);

    const std::function<void()> changed_;
    mutable std::mutex mutex_;  ///< guards what follows
    bool isToTell_ = false;     ///< of a change
    std::uint64_t frameNumber_ = 0;
    fabric::FrameData frameData_;
    BudgetKeepers keepers_;
    FrameKinds kinds_;
    PictureRevision revision_;
    ConfigurationKeeper configuration_;
    std::shared_ptr<ActiveConfiguration> active_;  ///< of the last frame
    std::uint64_t lastRevision_ = 0;               ///< of the scene
    Clock::time_point lastFinished_{};
};

}  // namespace eyrie::coordinator
