// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/plan.h"

#include <algorithm>
#include <set>
#include <string>

#include <fmt/format.h>

#include "coordinator/compound/gaps.h"
#include "coordinator/compound/lost_depth.h"
#include "coordinator/compound/needs.h"
#include "coordinator/compound/pictures.h"
#include "coordinator/compound/seen_areas.h"
#include "coordinator/compound/shares.h"
#include "coordinator/compound/steps.h"
#include "coordinator/compound/work.h"
#include "coordinator/config/destinations.h"

namespace eyrie::compound {
namespace {

void checkSize(const char* what, const std::optional<config::PixelSize>& size,
               const config::Place& place, Refusals& refusals) {
    constexpr std::int32_t kMost = 1 << 18;  // of canvases; what is drawn at once is less
    if (size &&
        (size->width < 1 || size->height < 1 || size->width > kMost || size->height > kMost))
        refusals.tooLarge.error(
            place, fmt::format("{} of {}x{} pixels; 1 to {} a side are possible", what, size->width,
                               size->height, kMost));
}

void checkOutput(const config::Configuration& configuration, const Output& output,
                 Refusals& refusals) {
    config::Findings& findings = refusals.impossible;
    if (configuration.canvases.empty())
        return findings.error(
            {},
            "the configuration has no canvas, so it shows nothing; give it one, with a segment and "
            "a layout of a view");
    if (output.canvas >= configuration.canvases.size())
        return findings.error({}, fmt::format("there is no canvas {}: the configuration has {}",
                                              output.canvas, configuration.canvases.size()));
    const config::Canvas& canvas = configuration.canvases[output.canvas];
    if (output.segment && *output.segment >= canvas.segments.size())
        return findings.error(
            canvas.place, fmt::format("there is no segment {}: canvas {} has {}", *output.segment,
                                      output.canvas, canvas.segments.size()));
    checkSize("a picture", output.size, canvas.place, refusals);
}

config::ShownCanvas& entry(config::Display& display, std::size_t canvas) {
    if (display.canvases.size() <= canvas)
        display.canvases.resize(canvas + 1);
    return display.canvases[canvas];
}

/// A destination shows an eye where one of its compounds does.
void showEyesOfCompounds(config::ResolvedConfiguration& resolved) {
    for (config::Destination& each : resolved.destinations) each.eyes = {};
    for (const config::ResolvedCompound& each : resolved.compounds)
        if (each.destination) {
            config::Eyes& eyes = resolved.destinations[*each.destination].eyes;
            eyes = {eyes.cyclop || each.eyes.cyclop, eyes.left || each.eyes.left,
                    eyes.right || each.eyes.right};
        }
}

/// Nothing, and why, where sizes or what is written make no sense.
std::optional<config::ResolvedConfiguration> resolved(const config::Configuration& configuration,
                                                      const config::Display& display,
                                                      Refusals& refusals) {
    for (std::size_t i = 0; i < display.canvases.size(); ++i) {
        const config::ShownCanvas& canvas = display.canvases[i];
        const config::Place place =
            i < configuration.canvases.size() ? configuration.canvases[i].place : config::Place{};
        checkSize("a canvas", canvas.size, place, refusals);
        for (const auto& segment : canvas.segments)
            checkSize("a segment", segment, place, refusals);
    }
    if (refusals.tooLarge.hasErrors())
        return std::nullopt;
    config::Findings findings;
    config::ResolvedConfiguration resolved = config::resolve(configuration, display, findings);
    for (const config::Finding& finding : findings.all())
        if (finding.kind == config::Finding::Kind::Error)
            refusals.impossible.error(finding.place, finding.message);
    if (refusals.impossible.hasErrors())
        return std::nullopt;
    showEyesOfCompounds(resolved);
    return resolved;
}

/// Those in which the outputs' pictures come to be, each once.
std::vector<Pass> passesFor(const config::Configuration& configuration,
                            const config::ResolvedConfiguration& resolved,
                            const PlanRequest& request) {
    std::vector<Pass> passes;
    for (const Output& output : request.outputs)
        for (const Eye eye : shownEyes(configuration, resolved, output).eyes)
            for (const config::Destination& destination : resolved.destinations) {
                const auto pass = passFor(destination, output, eye);
                if (isPartOf(destination, output) && pass &&
                    std::ranges::find(passes, *pass) == passes.end())
                    passes.push_back(*pass);
            }
    return passes;
}

void sayWhatIsBlind(const WorkList& list, Plan& plan) {
    std::set<std::size_t> destinations;
    for (Picture& picture : plan.pictures)
        for (const std::vector<PicturePart>* const parts : {&picture.parts, &picture.right})
            for (const PicturePart& part : *parts) {
                const Blind* const blind = list.blindOf(part.framebuffer);
                if (blind == nullptr)
                    continue;
                destinations.insert(list.framebuffers[part.framebuffer].destination);
                if (picture.whyBlind.empty())
                    picture.whyBlind = std::string(blind->why.message());
            }
    plan.blind = destinations.size();
}

/// A segment of one eye has nothing for the other.
void checkEye(const config::ResolvedConfiguration& resolved, const Output& output,
              Refusals& refusals) {
    bool showsAnything = false;
    for (const config::Destination& each : resolved.destinations) {
        if (!isPartOf(each, output))
            continue;
        if (!output.eye || passFor(each, output, *output.eye))
            return;
        showsAnything = true;
    }
    if (!showsAnything)
        return;
    const char* const eye = *output.eye == Eye::Left    ? "left"
                            : *output.eye == Eye::Right ? "right"
                                                        : "middle";
    refusals.impossible.error(
        {}, fmt::format("nothing of what is asked for of canvas {} is shown to the {} eye",
                        output.canvas, eye));
}

bool hasAny(const Refusals& refusals) {
    return refusals.impossible.hasErrors() || refusals.tooLarge.hasErrors();
}

}  // namespace

config::Display displayOf(const config::Configuration& configuration, const PlanRequest& request) {
    config::Display display = request.display;
    for (const Output& output : request.outputs) {
        config::ShownCanvas& canvas = entry(display, output.canvas);
        if (output.segment) {
            if (canvas.segments.size() <= *output.segment)
                canvas.segments.resize(*output.segment + 1);
            if (output.size)
                canvas.segments[*output.segment] = output.size;
        } else if (output.size) {
            canvas.size = output.size;
        } else if (!canvas.size) {
            canvas.size =
                config::configuredSize(configuration, configuration.canvases[output.canvas]);
        }
    }
    return display;
}

std::optional<Plan> makePlan(const config::Configuration& configuration, const PlanRequest& asked,
                             Refusals& refusals) {
    checkShares(configuration, refusals.impossible);
    for (const Output& output : asked.outputs) checkOutput(configuration, output, refusals);
    if (hasAny(refusals))
        return std::nullopt;
    PlanRequest request = asked;
    request.display = displayOf(configuration, asked);
    const std::optional<config::ResolvedConfiguration> resolvedNow =
        resolved(configuration, request.display, refusals);
    if (!resolvedNow)
        return std::nullopt;
    const config::ResolvedConfiguration& shown = *resolvedNow;
    for (const Output& output : request.outputs) checkEye(shown, output, refusals);
    WorkList list(refusals);
    for (const Pass& pass : passesFor(configuration, shown, request))
        addWork(configuration, shown, request, pass, list);
    Plan plan;
    for (std::size_t i = 0; i < request.outputs.size(); ++i)
        for (Picture& picture : picturesOf(configuration, shown, request.outputs[i], i, list))
            plan.pictures.push_back(std::move(picture));
    StepList steps = stepsOf(shown, inOrder(shown, list), list);
    if (hasAny(refusals))
        return std::nullopt;
    if (request.looksForGaps) {
        warnOfGaps(shown, list, plan.pictures, steps.contents, plan.gaps);
        plan.lostDepth = lostDepth(shown, list, steps.frames);
    }
    leaveOutEmptyParts(steps.steps, plan.pictures);
    for (Picture& picture : plan.pictures)
        picture.seen = seenAreas(picture, list, request.fovYDegrees);
    plan.steps = std::move(steps.steps);
    plan.frames = list.frames.size();
    plan.draws = std::move(list.draws);
    plan.queues = std::move(list.queues);
    for (const WorkingBuffer& each : list.framebuffers)
        plan.framebuffers.push_back(each.framebuffer);
    sayWhatIsBlind(list, plan);
    keepWhatIsNeeded(plan);
    return plan;
}

absl::StatusOr<Plan> makePlan(const config::Configuration& configuration,
                              const PlanRequest& request) {
    Refusals refusals;
    if (std::optional<Plan> plan = makePlan(configuration, request, refusals))
        return *std::move(plan);
    if (!refusals.impossible.hasErrors())
        return absl::InvalidArgumentError(refusals.tooLarge.all().front().message);
    const config::Finding& first = refusals.impossible.all().front();
    const std::string place = describe(first.place);
    return absl::InvalidArgumentError(
        place.empty() ? first.message
                      : fmt::format("the configuration, at {}: {}", place, first.message));
}

}  // namespace eyrie::compound
