// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/active_configuration.h"

#include <algorithm>
#include <set>
#include <utility>

#include "coordinator/compound/pictures.h"
#include "coordinator/compound/plan_check.h"
#include "coordinator/config/findings.h"
#include "coordinator/config/named.h"
#include "coordinator/config/one_channel.h"
#include "fabric/status.h"

namespace eyrie::coordinator {
namespace {

/// Layouts by their positions in the canvas's list.
config::Display displayOf(const config::Configuration& configuration,
                          const config::ConfigurationState& state) {
    config::Display display;
    for (std::size_t i = 0; i < configuration.canvases.size(); ++i) {
        const auto& layouts = configuration.canvases[i].layouts;
        const auto shown = std::ranges::find(layouts, state.layouts[i]);
        config::ShownCanvas& canvas = display.canvases.emplace_back();
        canvas.layout.reset();
        if (shown != layouts.end() && state.layouts[i])
            canvas.layout = static_cast<std::size_t>(shown - layouts.begin());
    }
    display.heads = state.heads;
    for (const auto& views : state.views) {
        std::vector<double>& units = display.modelUnits.emplace_back();
        for (const config::ViewState& view : views) units.push_back(view.modelUnit);
    }
    return display;
}

bool isOnDisplay(const config::ResolvedConfiguration& resolved,
                 const config::ResolvedCompound& compound) {
    return compound.destination && resolved.destinations[*compound.destination].isShown;
}

std::vector<ActiveConfiguration::Pipe> pipesOf(const config::Configuration& configuration,
                                               const config::ResolvedConfiguration& resolved) {
    std::vector<ActiveConfiguration::Pipe> pipes;
    for (std::size_t node = 0; node < configuration.nodes.size(); ++node)
        for (std::size_t pipe = 0; pipe < configuration.nodes[node].pipes.size(); ++pipe)
            if (std::ranges::any_of(resolved.compounds, [&](const auto& compound) {
                    return compound.channel && compound.channel->node == node &&
                           compound.channel->pipe == pipe && isOnDisplay(resolved, compound);
                }))
                pipes.push_back({node, pipe});
    return pipes;
}

/// Unimplemented where the first picture, or a part of it, is put together of other destinations'
/// frames alone: by which sights these are seen is not looked for.
absl::Status checkDrawn(const config::Configuration& configuration,
                        const compound::PlanRequest& asked) {
    config::Findings findings;
    const config::ResolvedConfiguration resolved =
        config::resolve(configuration, compound::displayOf(configuration, asked), findings);
    std::set<std::size_t> taking;
    std::set<std::size_t> drawing;
    for (const config::ResolvedCompound& each : resolved.compounds) {
        if (each.destination && each.tasks.assemble && !each.inputFrames.empty())
            taking.insert(*each.destination);
        if (each.destination && each.tasks.draw)
            drawing.insert(*each.destination);
    }
    for (const std::size_t index : taking)
        if (const config::Destination& taker = resolved.destinations[index];
            !drawing.contains(index) && compound::isPartOf(taker, asked.outputs.front()))
            return absl::UnimplementedError(
                "channel '" + taker.name +
                "' shows what others have drawn, which picks do not go through; pick in those");
    return absl::OkStatus();
}

absl::Status firstError(const config::Findings& findings) {
    for (const config::Finding& finding : findings.all())
        if (finding.kind == config::Finding::Kind::Error)
            return absl::InvalidArgumentError(finding.message);
    return absl::OkStatus();
}

config::Viewport fractionOf(const fabric::PixelViewport& part, const fabric::PixelViewport& whole) {
    if (part.isEmpty() || whole.isEmpty())
        return {0, 0, 0, 0};
    return {static_cast<double>(part.x - whole.x) / whole.width,
            static_cast<double>(part.y - whole.y) / whole.height,
            static_cast<double>(part.width) / whole.width,
            static_cast<double>(part.height) / whole.height};
}

/// A compound may draw several times in a frame: for two eyes, or tile by tile.
struct Drawn {
    equalizer::CompoundTime time;
    fabric::PixelViewport asked;    ///< around all its tasks
    fabric::PixelViewport covered;  ///< around what is in their pictures
};

void add(Drawn& sum, const ActiveConfiguration::Taken& taken, const fabric::PixelViewport& asked) {
    equalizer::CompoundTime& time = sum.time;
    if (!(time.draw >= 0))
        time.draw = 0;
    time.draw += taken.stages.total - taken.stages.readback;
    time.readback += taken.stages.readback;
    time.transmit += std::max(0.0, taken.milliseconds - taken.stages.total);
    sum.asked = fabric::enclosing(sum.asked, asked);
    sum.covered = fabric::enclosing(sum.covered, taken.covered);
    time.covered = fractionOf(sum.covered, sum.asked);
}

/// Both are the same trees.
void takeBuffers(const std::vector<config::Compound>& from, std::vector<config::Compound>& to) {
    for (std::size_t i = 0; i < to.size(); ++i) {
        to[i].buffers = from[i].buffers;
        takeBuffers(from[i].children, to[i].children);
    }
}

}  // namespace

ActiveConfiguration::ActiveConfiguration(config::Configuration written)
    : written_(std::move(written)) {
    balances_.push_front({0, written_, equalizer::Equalizers(written_)});
    // Whoever read the configuration has told of errors in it.
    (void)show(config::initialState(written_));
}

/// Errors: that of what is shown from now on all the same.
absl::Status ActiveConfiguration::show(config::ConfigurationState state) {
    state_ = std::move(state);
    display_ = displayOf(written_, state_);
    shown_ = config::applied(written_, state_);
    onDisplay_ = config::onDisplay(shown_, state_);
    for (Balance& balance : balances_) showIn(balance.live);
    config::Findings findings;
    resolved_ = config::resolve(shown_, display_, findings);
    drawn_.reset();
    pipes_ = pipesOf(shown_, resolved_);
    return firstError(findings);
}

void ActiveConfiguration::showIn(config::Configuration& live) const {
    live.layouts = shown_.layouts;
    live.observers = shown_.observers;
    takeBuffers(shown_.compounds, live.compounds);
}

/// One that is new begins with what was learned last: a page that is loaded again goes on so.
ActiveConfiguration::Balance& ActiveConfiguration::balanceOf(std::uint64_t session) {
    const auto known = std::ranges::find(balances_, session, &Balance::session);
    if (known != balances_.end()) {
        balances_.splice(balances_.begin(), balances_, known);
        return balances_.front();
    }
    balances_.push_front(balances_.front());
    balances_.front().session = session;
    if (balances_.size() > kMostBalances)
        balances_.pop_back();
    return balances_.front();
}

absl::Status ActiveConfiguration::become(config::ConfigurationState state, bool choosesLayouts) {
    for (std::size_t i = 0; i < state.equalizers.size(); ++i)
        if (state.equalizers[i] != state_.equalizers[i] || state.views != state_.views)
            RETURN_IF_ERROR(compound::checkDivision(written_, state, i));
    config::ConfigurationState before = state_;
    if (absl::Status shown = show(std::move(state)); !shown.ok()) {
        (void)show(std::move(before));
        return shown;
    }
    for (std::size_t i = 0; i < state_.equalizers.size(); ++i)
        if (state_.equalizers[i] != before.equalizers[i])
            for (Balance& balance : balances_)
                RETURN_IF_ERROR(balance.equalizers.tune(i, state_.equalizers[i]));
    if (choosesLayouts)
        ++layoutChoices_;
    return absl::OkStatus();
}

void ActiveConfiguration::renameNodes(std::vector<config::Node> nodes) {
    for (Balance& balance : balances_) balance.live.nodes = nodes;
    written_.nodes = std::move(nodes);
    (void)show(std::move(state_));
}

absl::Status ActiveConfiguration::switchLayout(std::string_view canvas, std::string_view layout) {
    config::ConfigurationState state = state_;
    RETURN_IF_ERROR(config::switchLayout(written_, state, canvas, layout));
    return become(std::move(state), true);
}

absl::Status ActiveConfiguration::setHead(std::string_view observer,
                                          const fabric::Mat4& roomFromHead) {
    config::ConfigurationState state = state_;
    RETURN_IF_ERROR(config::setHead(written_, state, observer, roomFromHead));
    return become(std::move(state));
}

absl::Status ActiveConfiguration::setView(std::string_view layout, std::string_view view,
                                          const config::ViewState& settings) {
    config::ConfigurationState state = state_;
    RETURN_IF_ERROR(config::setView(written_, state, layout, view, settings));
    return become(std::move(state));
}

absl::Status ActiveConfiguration::setObserver(std::string_view observer,
                                              const config::ObserverState& settings) {
    config::ConfigurationState state = state_;
    RETURN_IF_ERROR(config::setObserver(written_, state, observer, settings));
    return become(std::move(state));
}

absl::Status ActiveConfiguration::tune(std::string_view equalizer,
                                       const equalizer::Tuning& tuning) {
    ASSIGN_OR_RETURN(const std::size_t position, balances_.front().equalizers.find(equalizer));
    config::ConfigurationState state = state_;
    RETURN_IF_ERROR(config::tuneEqualizer(written_, state, position, tuning));
    return become(std::move(state));
}

absl::StatusOr<compound::Output> ActiveConfiguration::outputOf(const Shown& shown,
                                                               const FrameRequest& request) const {
    compound::Output output;
    if (!shown.canvas.empty()) {
        ASSIGN_OR_RETURN(output.canvas,
                         config::findNamed(written_.canvases, "canvas", shown.canvas));
    }
    if (!shown.segment.empty() && output.canvas < written_.canvases.size()) {
        ASSIGN_OR_RETURN(
            output.segment,
            config::findNamed(written_.canvases[output.canvas].segments, "segment", shown.segment));
    }
    output.size = config::PixelSize{request.width, request.height};
    if (!request.part.isEmpty())
        output.part = request.part;
    output.eye = shown.eye;
    output.stereo = shown.stereo;
    output.wantsDepth = request.wantsDepth;
    return output;
}

absl::StatusOr<compound::PlanRequest> ActiveConfiguration::planRequestOf(
    const FrameRequest& request) const {
    compound::PlanRequest asked;
    asked.display = display_;
    asked.fovYDegrees = request.camera.fovYDegrees;
    for (const Shown& shown : request.shown) {
        ASSIGN_OR_RETURN(compound::Output output, outputOf(shown, request));
        asked.outputs.push_back(output);
    }
    return asked;
}

absl::StatusOr<fabric::SeenAreas> ActiveConfiguration::seen(const FrameRequest& request) const {
    ASSIGN_OR_RETURN(const compound::PlanRequest asked, planRequestOf(request));
    // Of the configuration without what drives its compounds: those that draw in turn, a frame
    // each, see the same.
    ASSIGN_OR_RETURN(const compound::Plan plan,
                     compound::makePlan(config::oneChannel(shown_), asked));
    if (plan.pictures.empty())
        return absl::InvalidArgumentError("no picture is asked for");
    RETURN_IF_ERROR(checkDrawn(shown_, asked));
    return plan.pictures.front().seen;
}

absl::StatusOr<compound::Plan> ActiveConfiguration::plan(const FrameRequest& request,
                                                         std::uint64_t frameNumber,
                                                         const std::vector<std::string>& away) {
    ASSIGN_OR_RETURN(compound::PlanRequest asked, planRequestOf(request));
    asked.frameNumber = frameNumber;
    Balance& balance = balanceOf(request.session);
    std::vector<std::size_t> canvases;
    for (const compound::Output& output : asked.outputs) canvases.push_back(output.canvas);
    balance.equalizers.apply(balance.live,
                             {frameNumber, drawnAs(asked), gone(away),
                              request.completeness == fabric::Completeness::Complete, canvases});
    return compound::makePlan(balance.live, asked);
}

/// Not as large as it is written: equalizers share out, reduce and enlarge what is asked for.
const config::ResolvedConfiguration& ActiveConfiguration::drawnAs(
    const compound::PlanRequest& asked) {
    config::Display display = compound::displayOf(shown_, asked);
    if (!drawn_ || drawn_->display != display) {
        config::Findings findings;  // those of what is shown
        config::ResolvedConfiguration resolved = config::resolve(shown_, display, findings);
        drawn_ = Sized{std::move(display), std::move(resolved)};
    }
    return drawn_->resolved;
}

/// The channels whose renderer is away; none where all are.
std::vector<config::ChannelIndex> ActiveConfiguration::gone(
    const std::vector<std::string>& away) const {
    std::set<Pipe> pipes;
    for (const auto& [pipe, renderer] : renderers_)
        if (std::ranges::find(away, renderer) != away.end())
            pipes.insert(pipe);
    std::vector<config::ChannelIndex> gone;
    if (pipes.size() == renderers_.size())
        return gone;
    for (const config::ResolvedCompound& compound : resolved_.compounds)
        if (compound.channel && pipes.contains({compound.channel->node, compound.channel->pipe}) &&
            std::ranges::find(gone, *compound.channel) == gone.end())
            gone.push_back(*compound.channel);
    return gone;
}

Takers ActiveConfiguration::takersOf(const compound::Plan& plan) const {
    Takers takers;
    for (const compound::PlannedDraw& draw : plan.draws) {
        takers.preferred.push_back(rendererFor(draw.channel));
        takers.queueOf.push_back(draw.queue);
    }
    for (const auto& channels : plan.queues) {
        std::vector<std::string>& queue = takers.queues.emplace_back();
        for (const config::ChannelIndex& channel : channels) queue.push_back(rendererFor(channel));
    }
    return takers;
}

void ActiveConfiguration::record(std::uint64_t session, const compound::Plan& plan,
                                 std::uint64_t frameNumber, std::span<const Taken> taken) {
    const auto known = std::ranges::find(balances_, session, &Balance::session);
    if (known == balances_.end())
        return;
    std::vector<Drawn> drawn(resolved_.compounds.size());
    for (std::size_t i = 0; i < plan.draws.size(); ++i) {
        const compound::PlannedDraw& draw = plan.draws[i];
        if (draw.compound < drawn.size())
            add(drawn[draw.compound], taken[i], draw.task.pixelViewport);
    }
    equalizer::FrameTimes times;
    times.frameNumber = frameNumber;
    for (const Drawn& each : drawn) times.compounds.push_back(each.time);
    known->equalizers.record(times);
}

}  // namespace eyrie::coordinator
