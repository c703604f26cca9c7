// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "coordinator/compound/equalizer/equalizers.h"
#include "coordinator/compound/plan.h"
#include "coordinator/config/configuration.h"
#include "coordinator/config/on_display.h"
#include "coordinator/config/resolved.h"
#include "coordinator/config/state.h"
#include "coordinator/frame/frame_source.h"
#include "coordinator/frame/pipe_renderers.h"
#include "coordinator/frame/takers.h"

namespace eyrie::coordinator {

/// A configuration at work: what it shows at the moment, and how it shares the work out from frame
/// to frame. Callers take turns.
class ActiveConfiguration {
public:
    explicit ActiveConfiguration(config::Configuration written);
    ActiveConfiguration(const ActiveConfiguration&) = delete;
    ActiveConfiguration& operator=(const ActiveConfiguration&) = delete;

    const config::Configuration& written() const { return written_; }
    const config::ConfigurationState& state() const { return state_; }
    const config::OnDisplay& onDisplay() const { return onDisplay_; }
    /// As they are for the session that was planned for last.
    std::vector<equalizer::EqualizerState> equalizers() const {
        return balances_.front().equalizers.states();
    }

    /// Puts `state` in the place of state(), of which layouts may have been chosen. Errors:
    /// InvalidArgument where it cannot be shown, as with an eye behind its wall; then nothing has
    /// changed.
    absl::Status become(config::ConfigurationState state, bool choosesLayouts = false);
    /// How often layouts have been chosen, those that were on show already as well.
    std::uint64_t layoutChoices() const { return layoutChoices_; }

    /// As the functions of config::ConfigurationState and Equalizers::tune, and become.
    absl::Status switchLayout(std::string_view canvas, std::string_view layout);
    absl::Status setHead(std::string_view observer, const fabric::Mat4& roomFromHead);
    absl::Status setView(std::string_view layout, std::string_view view,
                         const config::ViewState& settings);
    absl::Status setObserver(std::string_view observer, const config::ObserverState& settings);
    absl::Status tune(std::string_view equalizer, const equalizer::Tuning& tuning);

    /// In place of the nodes it was written with, from which they differ in names only.
    void renameNodes(std::vector<config::Node> nodes);

    /// Pipes that draw something of what is shown: each wants a renderer of its own. In the order
    /// of the configuration.
    using Pipe = coordinator::Pipe;
    const std::vector<Pipe>& pipes() const { return pipes_; }

    /// Who does what from the next frame on, for all pipes().
    void setRenderers(RendererOfPipe renderers) { renderers_ = std::move(renderers); }
    const RendererOfPipe& renderers() const { return renderers_; }

    /// The next frame, shared out by what the last ones of its session took. Of renderers that are
    /// `away`, by their ids, pipes get no share where an equalizer decides, unless all are. Errors:
    /// NotFound, naming what there is; those of makePlan.
    absl::StatusOr<compound::Plan> plan(const FrameRequest& request, std::uint64_t frameNumber,
                                        const std::vector<std::string>& away);

    /// By which sights the first picture of the request would be seen. Errors: as of plan().
    absl::StatusOr<fabric::SeenAreas> seen(const FrameRequest& request) const;

    /// How long after the last one planned has begun the next frame is to begin; 0: at any time.
    double intervalMilliseconds() const {
        return balances_.front().equalizers.intervalMilliseconds();
    }

    /// Which renderer is to do each of the plan's draws.
    Takers takersOf(const compound::Plan& plan) const;

    /// Which is to do what this channel of pipes() does.
    const std::string& rendererFor(const config::ChannelIndex& channel) const {
        return renderers_.at({channel.node, channel.pipe});
    }

    /// What a draw of the plan took.
    struct Taken {
        fabric::PixelViewport covered;  ///< of the task's pixel viewport
        fabric::StageMilliseconds stages;
        double milliseconds = 0;  ///< until the picture was here
    };
    /// Of a frame of the session. What is forgotten of it by then learns nothing.
    void record(std::uint64_t session, const compound::Plan& plan, std::uint64_t frameNumber,
                std::span<const Taken> taken);

private:
    /// Of more sessions than this those planned for longest ago are forgotten.
    static constexpr std::size_t kMostBalances = 8;

    /// How the work of a session's frames is shared out.
    struct Balance {
        std::uint64_t session;
        config::Configuration live;  ///< as shown, and as the equalizers have it
        equalizer::Equalizers equalizers;
    };

    /// What is shown, in the sizes of a request.
    struct Sized {
        config::Display display;
        config::ResolvedConfiguration resolved;
    };

    Balance& balanceOf(std::uint64_t session);
    void showIn(config::Configuration& live) const;
    absl::StatusOr<compound::PlanRequest> planRequestOf(const FrameRequest& request) const;
    absl::StatusOr<compound::Output> outputOf(const Shown& shown,
                                              const FrameRequest& request) const;
    std::vector<config::ChannelIndex> gone(const std::vector<std::string>& away) const;
    const config::ResolvedConfiguration& drawnAs(const compound::PlanRequest& asked);
    absl::Status show(config::ConfigurationState state);

    config::Configuration written_;
    config::ConfigurationState state_;
    config::Configuration shown_;             ///< written_, with what state_ changes of it
    config::Display display_;                 ///< of state_
    config::ResolvedConfiguration resolved_;  ///< of shown_, as displayed
    config::OnDisplay onDisplay_;             ///< the same
    std::optional<Sized> drawn_;              ///< for the last frame planned
    std::vector<Pipe> pipes_;
    RendererOfPipe renderers_;
    std::uint64_t layoutChoices_ = 0;
    std::list<Balance> balances_;  ///< never empty; that planned for last comes first
};

}  // namespace eyrie::coordinator
