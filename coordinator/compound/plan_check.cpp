// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/plan_check.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "coordinator/compound/equalizer/equalizers.h"
#include "coordinator/compound/lone_eyes.h"
#include "coordinator/compound/plan.h"
#include "coordinator/config/destinations.h"
#include "coordinator/config/resolved.h"

namespace eyrie::compound {
namespace {

/// After how many frames compounds do the same again.
std::int64_t framesOf(const std::vector<config::Compound>& compounds, std::int64_t before) {
    for (const config::Compound& each : compounds) {
        if (before >= kMostFramesTried)
            break;
        const std::int64_t period =
            std::clamp<std::int64_t>(each.period.value_or(1), 1, kMostFramesTried);
        before = framesOf(each.children, std::lcm(before, period));
    }
    return std::min(before, kMostFramesTried);
}

/// As its equalizers share it out before the first frame: in any layout alike.
config::Configuration balanced(const config::Configuration& written) {
    config::Configuration live = written;
    config::Findings findings;  // told by whoever resolved it before
    const config::ResolvedConfiguration resolved = config::resolve(written, findings);
    equalizer::Equalizers(written).apply(live, {.frameNumber = 0, .resolved = resolved});
    return live;
}

/// Where nothing but sizes is in the way, as of a canvas larger than pictures may be, that of
/// smaller pictures: such are what is asked for then.
std::optional<Plan> planOf(const config::Configuration& live, PlanRequest request,
                           Refusals& refusals) {
    constexpr int kMostParts = 1 << 16;
    std::optional<Plan> plan = makePlan(live, request, refusals);
    for (int parts = 2; !plan && !refusals.impossible.hasErrors() && parts <= kMostParts;
         parts *= 2) {
        for (Output& output : request.outputs)
            if (const auto size = config::configuredSize(live, live.canvases[output.canvas]))
                output.size = {std::max(1, size->width / parts), std::max(1, size->height / parts)};
        Refusals ofSmaller;
        plan = makePlan(live, request, ofSmaller);
        refusals.impossible = std::move(ofSmaller.impossible);
    }
    return plan;
}

/// How many plans were made, of how many there are.
struct Tried {
    std::int64_t plans = 0;
    std::int64_t all = 0;
};

/// Each plan resolves all compounds: so many plans are made of as many.
std::int64_t mostPlans(const config::Configuration& live) {
    config::Findings told;  // by whoever resolved it before
    const std::size_t compounds = config::resolve(live, told).compounds.size();
    return kMostCompoundsTried /
           std::clamp<std::int64_t>(static_cast<std::int64_t>(compounds), 1, kMostCompoundsTried);
}

/// Sees the plan, or why there is none, of each canvas in each of its layouts and in each frame, or
/// of the first where these are very many.
Tried eachPlan(const config::Configuration& live,
               const std::function<void(const std::optional<Plan>&, const Refusals&)>& see) {
    Tried tried;
    const std::int64_t most = mostPlans(live);
    PlanRequest request;
    request.looksForGaps = true;
    request.display.canvases.resize(live.canvases.size());
    const std::int64_t frames = framesOf(live.compounds, 1);
    const auto eachFrame = [&] {
        for (std::int64_t frame = 0; frame < frames; ++frame) {
            if (tried.all++ >= most)
                continue;
            ++tried.plans;
            request.frameNumber = static_cast<std::uint64_t>(frame);
            Refusals refusals;
            const std::optional<Plan> plan = planOf(live, request, refusals);
            see(plan, refusals);
        }
    };
    for (std::size_t i = 0; i < live.canvases.size(); ++i)
        request.outputs.emplace_back().canvas = i;
    eachFrame();
    for (std::size_t i = 0; i < live.canvases.size(); ++i)
        for (std::size_t layout = 1; layout < live.canvases[i].layouts.size(); ++layout) {
            request.outputs.assign(1, {});
            request.outputs.front().canvas = i;
            request.display.canvases[i].layout = layout;
            eachFrame();
            request.display.canvases[i].layout = 0;
        }
    return tried;
}

const config::Place& placeOf(const LostDepth& lost) {
    return lost.frame != nullptr ? lost.frame->place : lost.compound->place;
}

class Checker {
public:
    explicit Checker(config::Findings& findings) : findings_(findings) {}

    void see(const std::optional<Plan>& plan, const Refusals& refusals) {
        for (const config::Finding& each : refusals.impossible.all())
            if (isNew(each.place, each.message))
                findings_.error(each.place, each.message);
        for (const config::Finding& each : refusals.tooLarge.all()) warn(each.place, each.message);
        if (!plan)
            return;
        for (const LostDepth& each : plan->lostDepth)
            warn(placeOf(each),
                 fmt::format("{} has a part of the data and no DEPTH, so it covers what is nearer; "
                             "buffer [ COLOR DEPTH ] compares them",
                             each.frame != nullptr
                                 ? "the outputframe"
                                 : "what the compound draws in pixels of its own"));
        for (const config::Finding& each : plan->gaps.all()) warn(each.place, each.message);
    }

private:
    void warn(const config::Place& place, const std::string& message) {
        if (isNew(place, message))
            findings_.warning(place, message);
    }

    bool isNew(const config::Place& place, const std::string& message) {
        return said_.insert({describe(place), message}).second;
    }

    config::Findings& findings_;
    std::set<std::pair<std::string, std::string>> said_;
};

bool isWithin(const config::Compound& tree, const config::Compound* compound) {
    return &tree == compound ||
           std::ranges::any_of(tree.children, [&](const config::Compound& child) {
               return isWithin(child, compound);
           });
}

/// With its compound's name, and where it is written.
std::string described(const LostDepth& lost) {
    const std::string frame = lost.frame == nullptr ? "what is drawn in pixels of its own"
                              : lost.frame->name.empty()
                                  ? "the outputframe"
                                  : "the outputframe \"" + lost.frame->name + "\"";
    const std::string& name = lost.compound->name;
    const std::string place = describe(placeOf(lost));
    return fmt::format("{}{}{}", frame,
                       name.empty() ? "" : fmt::format(" of compound \"{}\"", name),
                       place.empty() ? "" : " at " + place);
}

}  // namespace

void checkPlans(const config::Configuration& configuration, config::Findings& findings) {
    if (configuration.canvases.empty())
        return findings.warning({},
                                "there is no canvas, so nothing is shown; give it one, with a "
                                "segment and a layout of a view");
    config::Findings told;  // by whoever resolved it before
    warnOfLoneEyes(configuration, config::resolve(configuration, told), findings);
    Checker checker(findings);
    const Tried tried = eachPlan(balanced(configuration),
                                 [&](const std::optional<Plan>& plan, const Refusals& refusals) {
                                     checker.see(plan, refusals);
                                 });
    if (tried.plans < tried.all)
        findings.note({}, fmt::format("of {} pictures, of each canvas in each of its layouts and "
                                      "in each frame, the first {} were tried: with as many "
                                      "compounds the others would take long",
                                      tried.all, tried.plans));
}

absl::Status checkDivision(const config::Configuration& written,
                           const config::ConfigurationState& state, std::size_t equalizer) {
    const config::Configuration set = config::applied(written, state);
    if (!dividesData(*equalizersOf(set)[equalizer].equalizer) ||
        dividesData(*equalizersOf(written)[equalizer].equalizer))
        return absl::OkStatus();
    const config::Configuration live = balanced(set);
    const config::Compound& divided = *equalizersOf(live)[equalizer].compound;
    std::optional<std::string> lost;
    eachPlan(live, [&](const std::optional<Plan>& plan, const Refusals&) {
        if (!plan || lost)
            return;
        for (const LostDepth& each : plan->lostDepth)
            if (isWithin(divided, each.compound)) {
                lost = described(each);
                return;
            }
    });
    if (!lost)
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("equalizer {}: it cannot divide data: {} has no DEPTH, so it would cover what "
                    "is nearer; write buffer [ COLOR DEPTH ] there",
                    equalizer, *lost));
}

}  // namespace eyrie::compound
