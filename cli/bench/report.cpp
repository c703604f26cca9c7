// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/report.h"

#include <cerrno>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "cli/bench/machine.h"
#include "cli/bench/report_page.h"
#include "cli/bench/run_summary.h"
#include "cli/image_files.h"
#include "cli/json_object.h"
#include "fabric/status.h"

namespace eyrie::cli::bench {
namespace {

/// Where report.html takes its data.
constexpr std::string_view kDataPlace = "REPORT_DATA";

JsonObject toJson(const Percentiles& values) {
    JsonObject json;
    json.number("p50", values.p50)
        .number("p95", values.p95)
        .number("p99", values.p99)
        .number("max", values.max);
    return json;
}

JsonObject toJson(const fabric::StageMilliseconds& stages) {
    JsonObject json;
    json.number("cull", stages.cull)
        .number("draw", stages.draw)
        .number("vertices", stages.vertices)
        .number("fill", stages.fill)
        .number("readback", stages.readback)
        .number("encode", stages.encode);
    return json;
}

JsonObject toJson(const BenchRun& run) {
    const RunSummary summary = summarize(run.played);
    JsonObject json;
    json.number("tau", run.tauPixels)
        .number("fpsMedian", summary.fpsMedian)
        .object("frameMs", toJson(summary.frame))
        .object("firstPassMs", toJson(summary.firstPass))
        .object("stagesMs", toJson(summary.stages))
        .text("limitingStage", std::string(fabric::limitingStage(summary.stages)))
        .number("trianglesMean", summary.trianglesMean)
        .count("pagesLoaded", summary.pagesLoaded)
        .count("bytesLoaded", summary.bytesLoaded)
        .count("peakResidentBytes", run.played.peakResidentBytes)
        .number("tauAchievedMax", summary.tauAchievedMax)
        .count("framesBeyondTau", summary.framesBeyond);
    if (run.budgetMilliseconds > 0)
        json.number("budgetMs", run.budgetMilliseconds)
            .number("withinBudget", summary.withinBudget)
            .object("tauAchieved", toJson(summary.tauAchieved));
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
        .count("renderers", static_cast<std::uint64_t>(facts.renderers))
        .text("compound", facts.compound);
    return json;
}

JsonObject summary(const BenchFacts& facts, const std::vector<BenchRun>& runs) {
    std::vector<JsonObject> runObjects;
    for (const BenchRun& run : runs) runObjects.push_back(toJson(run));
    const fabric::DeviceInfo device =
        runs.empty() ? fabric::DeviceInfo{} : runs.front().played.device;
    JsonObject json;
    json.object("machine", machineJson(device))
        .object("bench", toJson(facts))
        .objects("runs", runObjects);
    return json;
}

/// [[run, pass, seconds, milliseconds], ...]
std::string frameTimes(const std::vector<BenchRun>& runs) {
    std::string json;
    for (std::size_t run = 0; run < runs.size(); ++run)
        for (const PlayedFrame& frame : runs[run].played.frames)
            json += fmt::format("{}[{},{},{:.3f},{:.2f}]", json.empty() ? "" : ",", run, frame.pass,
                                frame.seconds, frame.milliseconds);
    return "[" + json + "]";
}

/// Empty where there was no frame time to hold.
std::string budgetColumns(const std::optional<fabric::BudgetUse>& budget) {
    return budget ? fmt::format("{},{:.3f},{}", budget->milliseconds, budget->predictedMilliseconds,
                                budget->tauPixels)
                  : ",,";
}

/// What became of the frame time of a run, for a terminal.
std::string budgetLine(const BenchRun& run) {
    const RunSummary s = summarize(run.played);
    return fmt::format(
        "{} ms to hold: {:.1f} % of frames within {:.0f} ms after the first second; promised px "
        "p50 {:.2f}, p95 {:.2f}\n",
        run.budgetMilliseconds, 100 * s.withinBudget, 1.2 * run.budgetMilliseconds,
        s.tauAchieved.p50, s.tauAchieved.p95);
}

/// "</script>" in a file's name must not end the script that holds it.
std::string forScript(std::string json) {
    for (std::size_t at = 0; (at = json.find("</", at)) != std::string::npos; at += 3)
        json.replace(at, 2, "<\\/");
    return json;
}

}  // namespace

std::string summaryJson(const BenchFacts& facts, const std::vector<BenchRun>& runs) {
    return summary(facts, runs).str() + "\n";
}

std::string framesCsv(const std::vector<BenchRun>& runs) {
    std::string csv =
        "tau,pass,seconds,milliseconds,cull,draw,readback,encode,triangles,nodes,nodesHidden,"
        "pagesLoaded,"
        "bytesLoaded,tauAchieved,complete,budgetMs,predictedMs,budgetTau\n";
    for (const BenchRun& run : runs)
        for (const PlayedFrame& frame : run.played.frames) {
            const fabric::FrameStatistics& s = frame.statistics;
            const fabric::StageMilliseconds& ms = s.milliseconds;
            csv += fmt::format(
                "{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{},{},{},{},{},{},{:d},{}\n",
                run.tauPixels, frame.pass, frame.seconds, frame.milliseconds, ms.cull, ms.draw,
                ms.readback, ms.encode, s.triangles, s.nodes, s.nodesHidden, s.pagesLoaded,
                s.bytesLoaded, s.tauAchievedPixels, s.complete, budgetColumns(s.budget));
        }
    return csv;
}

std::string reportPage(const BenchFacts& facts, const std::vector<BenchRun>& runs) {
    const std::string json = summary(facts, runs).str();
    std::string page(kReportPage);
    page.replace(page.find(kDataPlace), kDataPlace.size(),
                 forScript(fmt::format("{{...{}, frames: {}}}", json, frameTimes(runs))));
    return page;
}

std::string table(const std::vector<BenchRun>& runs) {
    std::string text =
        "tau px  promised px  frames/s  median ms   p95 ms   p99 ms   triangles   loaded   "
        "memory  limited by\n";
    for (const BenchRun& run : runs) {
        const RunSummary s = summarize(run.played);
        text += fmt::format(
            "{:>6}  {:>11.3f}  {:>8.1f}  {:>9.1f}  {:>7.1f}  {:>7.1f}  {:>10.0f}  "
            "{:>4} MiB {:>4} MiB  {}\n",
            run.tauPixels, s.tauAchievedMax, s.fpsMedian, s.frame.p50, s.frame.p95, s.frame.p99,
            s.trianglesMean, s.bytesLoaded >> 20, run.played.peakResidentBytes >> 20,
            fabric::limitingStage(s.stages));
    }
    for (const BenchRun& run : runs)
        if (run.budgetMilliseconds > 0)
            text += budgetLine(run);
    return text;
}

absl::Status writeReport(const BenchFacts& facts, const std::vector<BenchRun>& runs,
                         const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        return fabric::writeError(folder, "cannot make the folder", error.value());
    RETURN_IF_ERROR(writeText(framesCsv(runs), folder + "/frames.csv"));
    RETURN_IF_ERROR(writeText(reportPage(facts, runs), folder + "/index.html"));
    return writeText(summaryJson(facts, runs), folder + "/summary.json");
}

}  // namespace eyrie::cli::bench
