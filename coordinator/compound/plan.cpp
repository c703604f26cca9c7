// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/plan.h"

#include <algorithm>

#include <fmt/format.h>

#include "coordinator/compound/needs.h"
#include "coordinator/compound/pictures.h"
#include "coordinator/compound/seen_areas.h"
#include "coordinator/compound/shares.h"
#include "coordinator/compound/steps.h"
#include "coordinator/compound/work.h"
#include "coordinator/config/destinations.h"
#include "fabric/status.h"

namespace eyrie::compound {
namespace {

absl::Status checkSize(const char* what, const std::optional<config::PixelSize>& size) {
    constexpr std::int32_t kMost = 1 << 18;  // of canvases; what is drawn at once is less
    if (!size ||
        (size->width >= 1 && size->height >= 1 && size->width <= kMost && size->height <= kMost))
        return absl::OkStatus();
    return absl::InvalidArgumentError(fmt::format("{} of {}x{} pixels; 1 to {} a side are possible",
                                                  what, size->width, size->height, kMost));
}

absl::Status checkOutput(const config::Configuration& configuration, const Output& output) {
    if (configuration.canvases.empty())
        return absl::InvalidArgumentError(
            "the configuration has no canvas, so it shows nothing; give it one, with a segment and "
            "a layout of a view");
    if (output.canvas >= configuration.canvases.size())
        return absl::InvalidArgumentError(
            fmt::format("there is no canvas {}: the configuration has {}", output.canvas,
                        configuration.canvases.size()));
    const config::Canvas& canvas = configuration.canvases[output.canvas];
    if (output.segment && *output.segment >= canvas.segments.size())
        return absl::InvalidArgumentError(fmt::format("there is no segment {}: canvas {} has {}",
                                                      *output.segment, output.canvas,
                                                      canvas.segments.size()));
    return checkSize("a picture", output.size);
}

config::ShownCanvas& entry(config::Display& display, std::size_t canvas) {
    if (display.canvases.size() <= canvas)
        display.canvases.resize(canvas + 1);
    return display.canvases[canvas];
}

/// The outputs' sizes become those of what is on display.
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

absl::StatusOr<config::ResolvedConfiguration> resolved(const config::Configuration& configuration,
                                                       const config::Display& display) {
    for (const config::ShownCanvas& canvas : display.canvases) {
        RETURN_IF_ERROR(checkSize("a canvas", canvas.size));
        for (const auto& segment : canvas.segments)
            RETURN_IF_ERROR(checkSize("a segment", segment));
    }
    config::Findings findings;
    config::ResolvedConfiguration resolved = config::resolve(configuration, display, findings);
    for (const config::Finding& finding : findings.all())
        if (finding.kind == config::Finding::Kind::Error)
            return absl::InvalidArgumentError(
                fmt::format("the configuration has an error: {}", finding.message));
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
                const auto pass = passFor(destination, eye);
                if (isPartOf(destination, output) && pass &&
                    std::ranges::find(passes, *pass) == passes.end())
                    passes.push_back(*pass);
            }
    return passes;
}

/// A segment of one eye has nothing for the other.
absl::Status checkEye(const config::ResolvedConfiguration& resolved, const Output& output) {
    bool showsAnything = false;
    for (const config::Destination& each : resolved.destinations) {
        if (!isPartOf(each, output))
            continue;
        if (!output.eye || passFor(each, *output.eye))
            return absl::OkStatus();
        showsAnything = true;
    }
    if (!showsAnything)
        return absl::OkStatus();
    const char* const eye = *output.eye == Eye::Left    ? "left"
                            : *output.eye == Eye::Right ? "right"
                                                        : "middle";
    return absl::InvalidArgumentError(fmt::format(
        "nothing of what is asked for of canvas {} is shown to the {} eye", output.canvas, eye));
}

}  // namespace

absl::StatusOr<Plan> makePlan(const config::Configuration& configuration,
                              const PlanRequest& asked) {
    RETURN_IF_ERROR(checkShares(configuration));
    for (const Output& output : asked.outputs) RETURN_IF_ERROR(checkOutput(configuration, output));
    PlanRequest request = asked;
    request.display = displayOf(configuration, asked);
    ASSIGN_OR_RETURN(const config::ResolvedConfiguration shown,
                     resolved(configuration, request.display));
    for (const Output& output : request.outputs) RETURN_IF_ERROR(checkEye(shown, output));
    WorkList list;
    for (const Pass& pass : passesFor(configuration, shown, request))
        RETURN_IF_ERROR(addWork(configuration, shown, request, pass, list));
    Plan plan;
    for (std::size_t i = 0; i < request.outputs.size(); ++i)
        for (Picture& picture : picturesOf(configuration, shown, request.outputs[i], i, list)) {
            picture.seen = seenAreas(picture, list, request.fovYDegrees);
            plan.pictures.push_back(std::move(picture));
        }
    ASSIGN_OR_RETURN(const std::vector<Work> works, inOrder(list));
    ASSIGN_OR_RETURN(plan.steps, stepsOf(shown, works, list));
    plan.frames = list.frames.size();
    plan.draws = std::move(list.draws);
    plan.queues = std::move(list.queues);
    for (const WorkingBuffer& each : list.framebuffers)
        plan.framebuffers.push_back(each.framebuffer);
    keepWhatIsNeeded(plan);
    return plan;
}

}  // namespace eyrie::compound
