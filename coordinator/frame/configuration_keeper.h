// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/config/default_config.h"
#include "coordinator/config/on_display.h"
#include "coordinator/frame/active_configuration.h"
#include "coordinator/frame/kept_configuration.h"
#include "coordinator/frame/pipe_renderers.h"

namespace eyrie::coordinator {

/// The configuration that frames are made by: the one that was given or, without, one made of the
/// renderers there are, another whenever their number changes. What was set, and which renderer
/// does what, outlives that; one that takes another's place takes over all of it, with what was
/// learned from frames. Callers take turns.
class ConfigurationKeeper {
public:
    /// `layout` is shown at first on the first canvas of a made configuration, where it has it.
    /// `changed` is called after each change of canvases() or displayRevision(), by whoever made
    /// it. What was kept before is set again where it can be; the log says what cannot.
    ConfigurationKeeper(std::optional<config::Configuration> given, std::string layout,
                        std::function<void()> changed, ConfigurationKeeping keeping = {});

    /// At work with `renderers`, of which there is at least one. Frames keep the one that they were
    /// made by.
    std::shared_ptr<ActiveConfiguration> with(const std::vector<config::RendererFacts>& renderers);

    /// The same for who makes no frame: a given one has its pipes placed by frames only.
    void meet(const std::vector<config::RendererFacts>& renderers);

    /// How many it was at work with last.
    std::size_t renderers() const { return renderers_.size(); }

    /// NotFound, naming what there is; FailedPrecondition before there was a renderer.
    absl::Status configure(const SwitchLayout& change);

    /// That it has or, of the renderers to come, will have.
    std::int64_t latency() const;

    /// As ConfigurationAccess::withConfiguration.
    absl::Status change(const std::function<absl::Status(ActiveConfiguration&)>& use);

    const std::vector<CanvasStatus>& canvases() const { return canvases_; }

    /// Counts up when what is on display is another, as heads, observers and views make it.
    std::uint64_t displayRevision() const { return displayRevision_; }

    /// How many renderers what is shown of a given configuration has pipes for; 0 of a made one,
    /// which has what there are.
    std::size_t renderersWanted() const { return wanted_; }

private:
    void make(const std::vector<config::RendererFacts>& renderers);
    void takeUp(const KeptConfiguration& before);
    absl::Status takeUp(const std::string& canvas, const KeptLayout& kept);
    void noteChoice();
    void keep() const;
    std::map<std::string, KeptLayout> switchedLayouts() const;
    void tell();
    void noteMissing(std::size_t ready);

    const std::optional<config::Configuration> given_;
    const std::string firstLayout_;  ///< of a made configuration
    std::string layout_;             ///< that it shows where it has it
    const std::function<void()> changed_;
    const std::function<void(const KeptConfiguration&)> keep_;
    std::vector<config::RendererFacts> renderers_;
    std::string note_;  ///< that was logged last
    PipeRenderers pipeRenderers_;
    KeptSettings settings_;
    std::shared_ptr<ActiveConfiguration> active_;
    std::shared_ptr<ActiveConfiguration> before_;  ///< the made one before; it may come back
    std::vector<CanvasStatus> canvases_;
    config::OnDisplay onDisplay_;  ///< that displayRevision_ is of
    std::uint64_t displayRevision_ = 0;
    std::size_t wanted_ = 0;
};

}  // namespace eyrie::coordinator
