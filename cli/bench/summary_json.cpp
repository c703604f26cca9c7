// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/summary_json.h"

#include <fmt/format.h>

#include "cli/bench/machine.h"
#include "cli/bench/run_summary.h"

namespace eyrie::cli::bench {
namespace {

JsonObject toJson(const Percentiles& values) {
    JsonObject json;
    json.number("p50", values.p50)
        .number("p95", values.p95)
        .number("p99", values.p99)
        .number("max", values.max);
    return json;
}

JsonObject toJson(const PassSummary& pass) {
    JsonObject json = toJson(pass.frame);
    json.number("tauP95", pass.tauP95)
        .number("triangles", pass.triangles)
        .number("points", pass.points);
    return json;
}

JsonObject toJson(const fabric::StageMilliseconds& stages) {
    JsonObject json;
    json.number("cull", stages.cull)
        .number("draw", stages.draw)
        .number("vertices", stages.vertices)
        .number("fill", stages.fill)
        .number("readback", stages.readback)
        .number("encode", stages.encode)
        .number("total", stages.total);
    return json;
}

JsonObject toJson(const UniformLevel& level) {
    JsonObject json;
    json.number("triangles", level.triangles)
        .number("trianglesWhole", level.trianglesWhole)
        .number("p99Px", level.p99Pixels)
        .number("maxPx", level.maxPixels);
    return json;
}

template <typename T>
std::vector<JsonObject> toJson(const std::vector<T>& values) {
    std::vector<JsonObject> objects;
    for (const T& value : values) objects.push_back(toJson(value));
    return objects;
}

void addMeasured(const ErrorSummary& errors, JsonObject& json) {
    JsonObject pixels;
    pixels.number("p50", errors.p50Pixels)
        .number("p99", errors.p99Pixels)
        .number("max", errors.maxPixels)
        .number("promised", errors.promisedPixels)
        .number("rounded", errors.roundedPixels);
    json.object("errorPx", pixels)
        .count("holes", errors.holes)
        .count("falseHits", errors.falseHits)
        .count("misplaced", errors.misplaced)
        .number("silhouettePx", errors.silhouettePixels)
        .number("psnrDb", errors.psnrDb)
        .number("ssim", errors.ssim)
        .number("flip", errors.flip)
        .flag("measuredWithinPromise", errors.withinPromise)
        .number("trianglesMeasured", errors.trianglesMean)
        .count("framesJudged", errors.judged)
        .count("framesMeasured", errors.frames);
}

JsonObject toJson(const BenchRun& run, const std::vector<UniformLevel>& uniform) {
    const RunSummary summary = summarize(run.played);
    JsonObject json;
    json.text("label", run.label)
        .number("tau", run.tauPixels)
        .count("renderers", static_cast<std::uint64_t>(run.renderers))
        .text("compound", run.compound)
        .number("fpsMedian", summary.fpsMedian)
        .object("frameMs", toJson(summary.frame))
        .count("framesInFlight", static_cast<std::uint64_t>(run.played.framesInFlight))
        .object("latencyMs", toJson(summary.latency))
        .objects("passes", toJson(summary.passes))
        .object("firstPassMs", toJson(summary.firstPass))
        .object("stagesMs", toJson(summary.stages))
        .object("stageMeansMs", toJson(summary.means))
        .text("limitingStage", std::string(fabric::limitingStage(summary.stages)))
        .number("overheadPercent", run.played.overheadPercent)
        .number("trianglesMean", summary.trianglesMean)
        .number("pointsMean", summary.pointsMean)
        .count("pagesLoaded", summary.pagesLoaded)
        .count("bytesLoaded", summary.bytesLoaded)
        .count("bytesLoadedFirstPass", summary.bytesLoadedFirstPass)
        .count("peakResidentBytes", run.played.peakResidentBytes)
        .number("tauAchievedMax", summary.tauAchievedMax)
        .object("tauAchieved", toJson(summary.tauAchieved))
        .number("normalErrorDegreesMax", summary.normalErrorDegreesMax)
        .number("normalErrorMeanDegreesMax", summary.normalErrorMeanDegreesMax)
        .count("framesBeyondTau", summary.framesBeyond)
        .count("framesEmpty", summary.framesEmpty);
    if (run.budgetMilliseconds > 0)
        json.number("budgetMs", run.budgetMilliseconds)
            .number("withinBudget", summary.withinBudget)
            .count("framesSmaller", summary.framesSmaller)
            .number("stretchMax", summary.stretchMax);
    if (!run.measured || run.measured->frames.empty())
        return json;
    const ErrorSummary errors = summarize(*run.measured);
    addMeasured(errors, json);
    if (const auto factor = efficiency(uniform, errors.p99Pixels, errors.trianglesMean))
        json.number("efficiency", *factor);
    else
        json.text("efficiencyMissing",
                  whyNoEfficiency(uniform, errors.p99Pixels, errors.trianglesMean));
    if (const auto factor = efficiency(uniform, errors.p99Pixels, errors.trianglesMean,
                                       &UniformLevel::trianglesWhole))
        json.number("efficiencyWhole", *factor);
    return json;
}

JsonObject toJson(const BenchFacts& facts) {
    JsonObject json;
    json.text("scene", facts.scene)
        .text("flight", facts.flight)
        .count("width", static_cast<std::uint64_t>(facts.width))
        .count("height", static_cast<std::uint64_t>(facts.height))
        .count("frames", static_cast<std::uint64_t>(facts.frames))
        .count("repeats", static_cast<std::uint64_t>(facts.repeats))
        .text("command", facts.command)
        .text("occlusion", facts.occlusion)
        .text("seen", facts.seen)
        .text("flightHash", fmt::format("{:016x}", facts.flightHash))
        .text("sceneHash", fmt::format("{:016x}", facts.sceneHash))
        .text("configurationHash", fmt::format("{:016x}", facts.configurationHash));
    return json;
}

}  // namespace

JsonObject summaryOf(const Report& report) {
    std::vector<JsonObject> runs;
    for (const BenchRun& run : report.runs) runs.push_back(toJson(run, report.uniform));
    const fabric::DeviceInfo device =
        report.runs.empty() ? fabric::DeviceInfo{} : report.runs.front().played.device;
    JsonObject json;
    json.object("machine", machineJson(device))
        .object("bench", toJson(report.facts))
        .objects("runs", runs);
    if (!report.uniform.empty())
        json.objects("uniform", toJson(report.uniform));
    return json;
}

}  // namespace eyrie::cli::bench
