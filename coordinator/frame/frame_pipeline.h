// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "coordinator/compound/exchange.h"
#include "coordinator/config/configuration.h"
#include "coordinator/farm/listeners.h"
#include "coordinator/farm/registry.h"
#include "coordinator/frame/budget_keeper.h"
#include "coordinator/frame/configuration_keeper.h"
#include "coordinator/frame/crew.h"
#include "coordinator/frame/dispatch.h"
#include "coordinator/frame/frame_kinds.h"
#include "coordinator/frame/frame_source.h"
#include "coordinator/frame/patience.h"
#include "coordinator/frame/turn.h"

namespace eyrie::coordinator {

struct FramePipelineOptions {
    /// Nothing: one is made of the renderers there are, whose `layout` is shown at first; see
    /// config::defaultConfiguration.
    std::optional<config::Configuration> configuration;
    std::string layout;
    /// The command that starts a renderer for this coordinator, for people to read.
    std::string howToJoin = "eyrie renderer --coordinator HOST:PORT";
    PatienceOptions patience;
    std::chrono::milliseconds callTimeout{30'000};  ///< a channel that takes longer is given up
    std::chrono::milliseconds pickTimeout{5'000};   ///< a pick that takes longer goes elsewhere
};

/// Makes frames: by a configuration, each is cut into draws for the renderers that are ready, these
/// are done at the same time, and put together.
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
    absl::Status configure(const SwitchLayout& change) override;
    Status status() const override;
    int subscribe(std::function<void()> listener) override;
    void unsubscribe(int handle) override;

private:
    absl::StatusOr<RenderedFrame> renderOfScene(const FrameRequest& asked,
                                                const Crew::State& state);
    const fabric::FrameData& frameDataFor(const FrameRequest& request);
    using Members = std::vector<std::shared_ptr<Member>>;
    absl::StatusOr<RenderedFrame> drawCentrally(const FrameRequest& request,
                                                ActiveConfiguration& active,
                                                const compound::Plan& plan, const Members& members,
                                                const Crew::State& state);
    absl::StatusOr<RenderedFrame> drawByPrograms(const FrameRequest& request,
                                                 ActiveConfiguration& active,
                                                 const compound::Plan& plan,
                                                 const compound::Exchange& exchange,
                                                 const Members& members, const Crew::State& state);
    bool mayExchange(const ActiveConfiguration& active, const compound::Exchange& exchange,
                     std::size_t renderers) const;
    absl::StatusOr<std::vector<Dispatch::Drawn>> draw(const FrameRequest& request,
                                                      const compound::Plan& plan, Takers takers,
                                                      std::uint64_t revision);
    std::string problem(const Crew::State& state) const;

    const FramePipelineOptions options_;
    Listeners listeners_;

    Turn turn_;  ///< guards what follows: one frame at a time
    std::uint64_t frameNumber_ = 0;
    fabric::FrameData frameData_;
    std::optional<fabric::FrameBudget> budget_;  ///< of the frame that is being drawn
    BudgetKeepers keepers_;
    FrameKinds kinds_;
    ConfigurationKeeper configuration_;
    std::uint64_t lastRevision_ = 0;  ///< of the scene
    std::uint64_t session_ = 0;       ///< of that, for programs
    Patience programPatience_;
    Registry::Clock::time_point programsRestUntil_{};  ///< since one failed

    Crew crew_;  ///< last: its threads end before the rest goes
};

}  // namespace eyrie::coordinator
