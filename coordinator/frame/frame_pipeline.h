// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "coordinator/config/configuration.h"
#include "coordinator/farm/listeners.h"
#include "coordinator/farm/registry.h"
#include "coordinator/frame/call_timeouts.h"
#include "coordinator/frame/composed_frame.h"
#include "coordinator/frame/configuration_access.h"
#include "coordinator/frame/crew.h"
#include "coordinator/frame/frame_gate.h"
#include "coordinator/frame/frame_planner.h"
#include "coordinator/frame/frame_source.h"
#include "coordinator/frame/kept_configuration.h"
#include "coordinator/frame/patience.h"
#include "coordinator/frame/program_drawing.h"
#include "coordinator/observe/stage_timer.h"

namespace eyrie::coordinator {

struct FramePipelineOptions {
    /// Nothing: one is made of the renderers there are, whose `layout` is shown at first; see
    /// config::defaultConfiguration.
    std::optional<config::Configuration> configuration;
    std::string layout;
    ConfigurationKeeping keeping = {};  ///< of what is set of it
    /// The command that starts a renderer for this coordinator, for people to read.
    std::string howToJoin = "eyrie renderer --coordinator HOST:PORT";
    PatienceOptions patience;
    CallTimeouts callTimeouts;
    std::chrono::milliseconds pickTimeout{5'000};  ///< a pick that takes longer goes elsewhere
    observe::SharedTelemetry telemetry = nullptr;  ///< is told of every frame
};

/// Makes frames: by a configuration, each is cut into draws for the renderers that are ready, these
/// are done at the same time, and put together. As many frames may be under way as the
/// configuration's latency, and one: while the pictures of one are on their way, or some renderers
/// draw it, those that have nothing to do begin with the next. None begins sooner than that, since
/// its camera would only be older.
class FramePipeline final : public FrameSource, public ConfigurationAccess {
public:
    /// Draws with the renderers in `registry`, which outlives the pipeline.
    FramePipeline(Registry& registry, FramePipelineOptions options);
    ~FramePipeline() override = default;
    FramePipeline(const FramePipeline&) = delete;
    FramePipeline& operator=(const FramePipeline&) = delete;

    /// Has the renderers open `scene` in place of the one before.
    void setScene(fabric::Scene scene) { crew_.setScene(std::move(scene)); }

    /// Crew::openAgain.
    void openAgain(Registry::Clock::time_point now) { crew_.openAgain(now); }

    absl::StatusOr<RenderedFrame> renderFrame(const FrameRequest& request) override;
    absl::StatusOr<RenderedFrame> renderLatest(const ChooseFrame& choose,
                                               const std::stop_token& stop = {}) override;
    int framesAtOnce() const override { return planner_.framesUnderWay(); }
    absl::StatusOr<fabric::SeenAreas> seen(const FrameRequest& request) override;
    absl::StatusOr<fabric::Picked> pick(const fabric::PickRequest& request) override;
    absl::Status configure(const SwitchLayout& change) override;
    absl::Status withConfiguration(
        const std::function<absl::Status(ActiveConfiguration&)>& use) override;
    Status status() const override;
    int subscribe(std::function<void()> listener) override;
    void unsubscribe(int handle) override;

private:
    absl::StatusOr<RenderedFrame> render(const FrameRequest& asked, FrameGate::Pass& pass);
    absl::StatusOr<RenderedFrame> renderInTurn(const FrameRequest& asked, FrameGate::Pass& pass,
                                               const std::string& line, observe::StageTimer& total);
    observe::Telemetry* telemetry() const { return options_.telemetry.get(); }
    /// `handedOut` is called when every renderer has been given its part.
    absl::StatusOr<DrawnFrame> draw(const PlannedFrame& frame,
                                    const std::function<void()>& handedOut);
    absl::StatusOr<DrawnFrame> drawCentrally(const PlannedFrame& frame,
                                             const std::function<void()>& handedOut);
    bool hasIdleRenderer() const;
    std::string problem(const Crew::State& state) const;

    const FramePipelineOptions options_;
    Listeners listeners_;
    mutable FramePlanner planner_;  ///< status() has it meet the renderers there are
    FrameGate gate_{[this] { return hasIdleRenderer(); }};
    ProgramDrawing programs_;
    Crew crew_;  ///< last: its threads end before the rest goes
};

}  // namespace eyrie::coordinator
