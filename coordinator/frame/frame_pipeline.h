// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "coordinator/compound/decompose.h"
#include "coordinator/compound/load_balance.h"
#include "coordinator/farm/listeners.h"
#include "coordinator/farm/registry.h"
#include "coordinator/frame/budget_keeper.h"
#include "coordinator/frame/crew.h"
#include "coordinator/frame/dispatch.h"
#include "coordinator/frame/frame_source.h"
#include "coordinator/frame/patience.h"
#include "coordinator/frame/turn.h"

namespace eyrie::coordinator {

struct FramePipelineOptions {
    Decomposition decomposition = Decomposition::TwoD;
    /// The command that starts a renderer for this coordinator, for people to read.
    std::string howToJoin = "eyrie renderer --coordinator HOST:PORT";
    PatienceOptions patience;
    std::chrono::milliseconds callTimeout{30'000};   ///< a channel that takes longer is given up
    std::chrono::milliseconds pickTimeout{5'000};    ///< a pick that takes longer goes elsewhere
    std::chrono::milliseconds openTimeout{120'000};  ///< a scene that takes longer to open too
};

/// Makes frames: cuts each into channels for the renderers that are ready, has them drawn at the
/// same time, and puts the results together.
class FramePipeline final : public FrameSource {
public:
    /// Draws with the renderers in `registry`, which outlives the pipeline.
    FramePipeline(Registry& registry, FramePipelineOptions options);
    ~FramePipeline() override = default;
    FramePipeline(const FramePipeline&) = delete;
    FramePipeline& operator=(const FramePipeline&) = delete;

    /// Has the renderers open `scene` in place of the one before.
    void setScene(fabric::Scene scene) { crew_.setScene(std::move(scene)); }

    absl::StatusOr<RenderedFrame> renderFrame(const FrameRequest& request) override;
    absl::StatusOr<fabric::Picked> pick(const fabric::PickRequest& request) override;
    Status status() const override;
    int subscribe(std::function<void()> listener) override;
    void unsubscribe(int handle) override;

private:
    absl::StatusOr<RenderedFrame> renderOfScene(const FrameRequest& asked,
                                                const Crew::State& state);
    const fabric::FrameData& frameDataFor(const FrameRequest& request);
    void forgetOtherKinds(const FrameRequest& request, std::uint64_t revision);
    int freeRenderers(std::uint64_t revision) const;
    absl::StatusOr<std::vector<Dispatch::Drawn>> draw(const FrameRequest& request,
                                                      std::uint64_t revision);
    RenderedFrame compose(const FrameRequest& request, fabric::Rgba background,
                          std::vector<Dispatch::Drawn> drawn) const;
    std::string problem(const Crew::State& state) const;

    Registry& registry_;
    const FramePipelineOptions options_;
    Listeners listeners_;

    Turn turn_;  ///< guards what follows: one frame at a time
    std::uint64_t frameNumber_ = 0;
    fabric::FrameData frameData_;
    std::optional<fabric::FrameBudget> budget_;  ///< of the frame that is being drawn
    BudgetKeepers keepers_;
    Patience patience_;
    LoadBalance balance_;
    FrameRequest lastRequest_;
    std::uint64_t lastRevision_ = 0;

    Crew crew_;  ///< last: its threads end before the rest goes
};

}  // namespace eyrie::coordinator
