// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/plan_check.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "coordinator/compound/equalizer/equalizers.h"
#include "coordinator/compound/plan.h"
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

class Checker {
public:
    Checker(const config::Configuration& configuration, config::Findings& findings)
        : configuration_(configuration),
          live_(balanced(configuration)),
          findings_(findings),
          frames_(framesOf(configuration.compounds, 1)) {}

    void check() {
        PlanRequest request;
        request.looksForGaps = true;
        request.display.canvases.resize(configuration_.canvases.size());
        for (std::size_t i = 0; i < configuration_.canvases.size(); ++i)
            request.outputs.emplace_back().canvas = i;
        plan(request);
        for (std::size_t i = 0; i < configuration_.canvases.size(); ++i)
            for (std::size_t layout = 1; layout < configuration_.canvases[i].layouts.size();
                 ++layout) {
                request.outputs.assign(1, {});
                request.outputs.front().canvas = i;
                request.display.canvases[i].layout = layout;
                plan(request);
                request.display.canvases[i].layout = 0;
            }
    }

private:
    void plan(PlanRequest& request) {
        for (std::int64_t frame = 0; frame < frames_; ++frame) {
            request.frameNumber = static_cast<std::uint64_t>(frame);
            Refusals refusals;
            const std::optional<Plan> plan = makePlan(live_, request, refusals);
            for (const config::Finding& each : refusals.impossible.all())
                if (isNew(each))
                    findings_.error(each.place, each.message);
            for (const config::Finding& each : refusals.tooLarge.all()) warn(each);
            if (plan)
                for (const config::Finding& each : plan->gaps.all()) warn(each);
        }
    }

    void warn(const config::Finding& finding) {
        if (isNew(finding))
            findings_.warning(finding.place, finding.message);
    }

    bool isNew(const config::Finding& finding) {
        return said_.insert({describe(finding.place), finding.message}).second;
    }

    const config::Configuration& configuration_;
    config::Configuration live_;
    config::Findings& findings_;
    std::int64_t frames_;
    std::set<std::pair<std::string, std::string>> said_;
};

}  // namespace

void checkPlans(const config::Configuration& configuration, config::Findings& findings) {
    if (configuration.canvases.empty())
        return findings.warning({},
                                "there is no canvas, so nothing is shown; give it one, with a "
                                "segment and a layout of a view");
    Checker(configuration, findings).check();
}

}  // namespace eyrie::compound
