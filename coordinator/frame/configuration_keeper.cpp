// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/configuration_keeper.h"

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "coordinator/config/named.h"
#include "coordinator/frame/problem.h"
#include "fabric/log.h"
#include "fabric/status.h"

namespace eyrie::coordinator {
namespace {

constexpr std::string_view kNoLayout = "OFF";

std::string layoutName(const config::Configuration& configuration,
                       const std::optional<std::size_t>& layout) {
    return layout ? config::called(configuration.layouts, *layout) : std::string(kNoLayout);
}

std::vector<CanvasStatus> canvasesOf(const ActiveConfiguration& active) {
    const config::Configuration& configuration = active.written();
    const std::vector<std::string> names = config::allCalled(configuration.canvases);
    const std::vector<std::string> layouts = config::allCalled(configuration.layouts);
    const auto nameOf = [&layouts](const std::optional<std::size_t>& layout) {
        return layout ? layouts[*layout] : std::string(kNoLayout);
    };
    std::vector<CanvasStatus> canvases;
    for (std::size_t i = 0; i < configuration.canvases.size(); ++i) {
        const config::Canvas& canvas = configuration.canvases[i];
        CanvasStatus& status = canvases.emplace_back();
        status.name = names[i];
        status.segments = config::allCalled(canvas.segments);
        for (const auto& layout : canvas.layouts) status.layouts.push_back(nameOf(layout));
        status.layout = nameOf(active.state().layouts[i]);
        status.barriers = config::swapBarriers(configuration, i, active.state().layouts[i]);
    }
    return canvases;
}

void noteLeftOut(const absl::Status& status) {
    if (!status.ok())
        spdlog::warn("something that was set before is left out: {}",
                     std::string_view(status.message().data(), status.message().size()));
}

/// A node for each, of one pipe, as a made configuration has them.
std::vector<Pipe> pipesOf(std::size_t nodes) {
    std::vector<Pipe> pipes;
    for (std::size_t i = 0; i < nodes; ++i) pipes.push_back({i, 0});
    return pipes;
}

bool areAlikeButForNodes(const config::Configuration& a, config::Configuration b) {
    if (a.nodes.size() != b.nodes.size())
        return false;
    b.nodes = a.nodes;
    return a == b;
}

}  // namespace

ConfigurationKeeper::ConfigurationKeeper(std::optional<config::Configuration> given,
                                         std::string layout, std::function<void()> changed,
                                         ConfigurationKeeping keeping)
    : given_(std::move(given)),
      firstLayout_(std::move(layout)),
      layout_(firstLayout_),
      changed_(std::move(changed)),
      keep_(std::move(keeping.keep)) {
    if (given_)
        active_ = std::make_shared<ActiveConfiguration>(*given_);
    takeUp(keeping.before);
    if (given_)
        tell();
}

/// Of a configuration that is made later, then.
void ConfigurationKeeper::takeUp(const KeptConfiguration& before) {
    for (const auto& [canvas, kept] : before.layouts) noteLeftOut(takeUp(canvas, kept));
    if (!given_) {
        settings_ = before.settings;
        return;
    }
    for (const absl::Status& failure : before.settings.restore(*active_)) noteLeftOut(failure);
}

absl::Status ConfigurationKeeper::takeUp(const std::string& canvas, const KeptLayout& kept) {
    std::string first = firstLayout_;
    if (given_) {
        ASSIGN_OR_RETURN(const std::size_t found,
                         config::findNamed(given_->canvases, "canvas", canvas));
        first = layoutName(*given_, active_->state().layouts[found]);
    }
    if (kept.first != first)
        return absl::FailedPreconditionError(fmt::format(
            "canvas \"{}\" was switched to \"{}\" from \"{}\", and begins with \"{}\" now", canvas,
            kept.layout, kept.first, first));
    if (given_)
        return active_->switchLayout(canvas, kept.layout);
    layout_ = kept.layout;
    return absl::OkStatus();
}

std::shared_ptr<ActiveConfiguration> ConfigurationKeeper::with(
    const std::vector<config::RendererFacts>& renderers) {
    if (!given_ && renderers != renderers_)
        make(renderers);
    renderers_ = renderers;
    noteMissing(renderers.size());
    // Nodes of a made one are called by the renderers that are there already.
    std::span<const config::Node> nodes;
    if (given_)
        nodes = active_->written().nodes;
    active_->setRenderers(pipeRenderers_.place(active_->pipes(), renderers, nodes));
    return active_;
}

void ConfigurationKeeper::meet(const std::vector<config::RendererFacts>& renderers) {
    if (!given_)
        with(renderers);
}

/// Nodes are those of the renderers that do their pipes.
void ConfigurationKeeper::make(const std::vector<config::RendererFacts>& renderers) {
    std::vector<config::RendererFacts> inOrder;
    for (const auto& [pipe, id] : pipeRenderers_.place(pipesOf(renderers.size()), renderers, {}))
        inOrder.push_back(*std::ranges::find(renderers, id, &config::RendererFacts::id));
    config::Configuration made = config::defaultConfiguration(inOrder);
    if (active_ && areAlikeButForNodes(active_->written(), made))
        return active_->renameNodes(std::move(made.nodes));
    if (active_)
        settings_.keep(*active_);
    before_.swap(active_);
    if (active_ && areAlikeButForNodes(active_->written(), made))
        active_->renameNodes(std::move(made.nodes));
    else
        active_ = std::make_shared<ActiveConfiguration>(std::move(made));
    for (const absl::Status& failure : settings_.restore(*active_))
        if (!absl::IsNotFound(failure))  // of more renderers there may be such
            noteLeftOut(failure);
    // Of one renderer there may be no such layout; the choice stands until there are more.
    if (!layout_.empty())
        (void)active_->switchLayout("0", layout_);
    tell();
}

/// Once for each number of them.
void ConfigurationKeeper::noteMissing(std::size_t ready) {
    std::string note = noteOf(ready, renderersWanted());
    if (note == note_)
        return;
    if (note.empty())
        spdlog::info("all renderers that the configuration wants are ready");
    else
        spdlog::warn("{}", note);
    note_ = std::move(note);
}

void ConfigurationKeeper::tell() {
    wanted_ = given_ ? active_->pipes().size() : 0;
    std::vector<CanvasStatus> canvases = canvasesOf(*active_);
    const bool isOther = active_->onDisplay() != onDisplay_;
    if (canvases == canvases_ && !isOther)
        return;
    canvases_ = std::move(canvases);
    if (isOther) {
        onDisplay_ = active_->onDisplay();
        ++displayRevision_;
    }
    changed_();
}

absl::Status ConfigurationKeeper::configure(const SwitchLayout& change) {
    if (!active_)
        return absl::FailedPreconditionError(
            "no renderer is ready yet, and so there is no configuration that could be switched; "
            "start one, or wait until it has opened the scene");
    RETURN_IF_ERROR(active_->switchLayout(change.canvas, change.layout));
    noteChoice();
    keep();
    tell();
    return absl::OkStatus();
}

absl::Status ConfigurationKeeper::change(
    const std::function<absl::Status(ActiveConfiguration&)>& use) {
    if (!active_)
        return absl::FailedPreconditionError(
            "no renderer is ready yet, and so there is no configuration; start one, or wait until "
            "it has opened the scene");
    const config::ConfigurationState before = active_->state();
    const std::uint64_t choices = active_->layoutChoices();
    RETURN_IF_ERROR(use(*active_));
    const bool isChosen = active_->layoutChoices() != choices;
    if (isChosen)
        noteChoice();
    if (isChosen || active_->state() != before)
        keep();
    tell();
    return absl::OkStatus();
}

/// By name: others may have its position among those of another number of renderers.
void ConfigurationKeeper::noteChoice() {
    if (!given_)
        layout_ = layoutName(active_->written(), active_->state().layouts.front());
}

void ConfigurationKeeper::keep() const {
    KeptConfiguration kept{settings_, switchedLayouts()};
    kept.settings.keep(*active_);
    keep_(kept);
}

std::map<std::string, KeptLayout> ConfigurationKeeper::switchedLayouts() const {
    std::map<std::string, KeptLayout> switched;
    if (!given_) {
        if (layout_ != firstLayout_)
            switched["0"] = {firstLayout_, layout_};
        return switched;
    }
    const std::vector<std::optional<std::size_t>> first = config::initialState(*given_).layouts;
    for (std::size_t i = 0; i < first.size(); ++i)
        if (const auto& shown = active_->state().layouts[i]; shown != first[i])
            switched[config::called(given_->canvases, i)] = {layoutName(*given_, first[i]),
                                                             layoutName(*given_, shown)};
    return switched;
}

std::int64_t ConfigurationKeeper::latency() const {
    return active_ ? active_->written().latency : config::Configuration{}.latency;
}

}  // namespace eyrie::coordinator
