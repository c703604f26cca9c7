// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/report.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/bench/errors_csv.h"
#include "cli/bench/page.h"
#include "cli/bench/report_page.h"
#include "cli/bench/run_summary.h"
#include "cli/bench/summary_file.h"
#include "cli/bench/summary_json.h"
#include "fabric/status.h"
#include "renderer/mesh/output_file.h"

namespace eyrie::cli::bench {
namespace {

namespace fs = std::filesystem;

/// [[run, pass, seconds, milliseconds, beyond tau], ...]
std::string frameTimes(const std::vector<BenchRun>& runs) {
    std::string json;
    for (std::size_t run = 0; run < runs.size(); ++run)
        for (const PlayedFrame& frame : runs[run].played.frames)
            json += fmt::format("{}[{},{},{:.3f},{:.2f},{:d}]", json.empty() ? "" : ",", run,
                                frame.pass, frame.seconds, frame.milliseconds, isBeyondTau(frame));
    return "[" + json + "]";
}

/// Empty where there was no frame time to hold.
std::string budgetColumns(const std::optional<fabric::BudgetUse>& budget) {
    return budget ? fmt::format("{},{:.3f},{}", budget->milliseconds, budget->predictedMilliseconds,
                                budget->tauPixels)
                  : ",,";
}

/// Empty where no frame was drawn smaller than asked for.
std::string smallerWords(const RunSummary& s, std::size_t frames) {
    return s.framesSmaller == 0
               ? ""
               : fmt::format(
                     "; {} of {} frames were drawn smaller, their pixels stretched up to "
                     "{:.2f} times",
                     s.framesSmaller, frames, s.stretchMax);
}

/// What became of the frame time of a run, for a terminal.
std::string budgetLine(const BenchRun& run) {
    const RunSummary s = summarize(run.played);
    const std::string within =
        std::isfinite(s.withinBudget)
            ? fmt::format("{:.1f} % of frames within {:g} ms after the first second",
                          100 * s.withinBudget, 1.2 * run.budgetMilliseconds)
            : "no frame after the first second to tell by, take more --frames";
    return fmt::format("{} ms to hold: {}; promised px p50 {:.2f}, p95 {:.2f}{}\n",
                       run.budgetMilliseconds, within, s.tauAchieved.p50, s.tauAchieved.p95,
                       smallerWords(s, run.played.frames.size()));
}

JsonObject toJson(const FrameError& error) {
    JsonObject json;
    json.number("seconds", error.seconds)
        .number("promised", error.promisedPixels)
        .number("p50", error.p50Pixels)
        .number("p99", error.p99Pixels)
        .number("max", error.maxPixels)
        .count("holes", error.holes)
        .count("falseHits", error.falseHits)
        .count("misplaced", error.misplaced)
        .number("silhouette", error.silhouettePixels)
        .flag("kept", keepsPromise(error));
    return json;
}

/// One list for each run, empty where nothing was measured: frames' errors, or the worst frames.
template <typename ListOf>
std::string perRun(const std::vector<BenchRun>& runs, const ListOf& listOf) {
    std::string json;
    for (const BenchRun& run : runs) {
        std::string list;
        if (run.measured)
            for (const JsonObject& object : listOf(*run.measured))
                list += (list.empty() ? "" : ",") + object.str();
        json += fmt::format("{}[{}]", json.empty() ? "" : ",", list);
    }
    return "[" + json + "]";
}

std::vector<JsonObject> judgedFramesOf(const MeasuredErrors& measured) {
    std::vector<JsonObject> objects;
    for (const FrameError& frame : measured.frames)
        if (!isEmpty(frame))
            objects.push_back(toJson(frame));
    return objects;
}

std::vector<JsonObject> worstOf(const MeasuredErrors& measured) {
    std::vector<JsonObject> objects;
    for (const WorstFrame& frame : measured.worst)
        objects.push_back(toJson(frame.error)
                              .text("picture", base64(frame.picturePng))
                              .text("heatMap", base64(frame.heatMapPng)));
    return objects;
}

std::string tableHead() {
    return "asked    drawn by         promised px  frames/s  median ms   p95 ms   p99 ms  in "
           "flight  latency ms  first pass ms   triangles    points   loaded    memory  overhead  "
           "limited "
           "by\n";
}

std::string tableLine(const BenchRun& run, const RunSummary& s) {
    return fmt::format(
        "{:<8} {:<15}  {:>11.3f}  {:>8.1f}  {:>9.1f}  {:>7.1f}  {:>7.1f}  {:>9}  {:>10.1f}  "
        "{:>13.1f}  "
        "{:>10.0f}  {:>8.0f}  "
        "{:>4} MiB  {:>4} MiB  {:>6.2f} %  {}\n",
        run.label, drawnBy(run.renderers, run.compound), s.tauAchievedMax, s.fpsMedian, s.frame.p50,
        s.frame.p95, s.frame.p99, run.played.framesInFlight, s.latency.p50, s.firstPass.p50,
        s.trianglesMean, s.pointsMean, s.bytesLoaded >> 20, run.played.peakResidentBytes >> 20,
        run.played.overheadPercent, fabric::limitingStage(s.stages));
}

}  // namespace

std::string summaryJson(const Report& report) { return summaryOf(report).str() + "\n"; }

std::string framesCsv(const std::vector<BenchRun>& runs) {
    std::string csv =
        "asked,tau,renderers,pass,seconds,milliseconds,cull,draw,readback,encode,triangles,points,"
        "nodes,"
        "nodesHidden,pagesLoaded,bytesLoaded,tauAchieved,beyondTau,complete,normalDegrees,"
        "normalMeanDegrees,budgetMs,predictedMs,"
        "budgetTau,latency,stretch\n";
    for (const BenchRun& run : runs)
        for (const PlayedFrame& frame : run.played.frames) {
            const fabric::FrameStatistics& s = frame.statistics;
            const fabric::StageMilliseconds& ms = s.milliseconds;
            csv += fmt::format(
                "{},{},{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{},{},{},{},{},{},{},{:d},{:d},"
                "{},{},{},"
                "{:.3f},{:.4f}\n",
                run.label, run.tauPixels, run.renderers, frame.pass, frame.seconds,
                frame.milliseconds, ms.cull, ms.draw, ms.readback, ms.encode, s.triangles, s.points,
                s.nodes, s.nodesHidden, s.pagesLoaded, s.bytesLoaded, s.tauAchievedPixels,
                isBeyondTau(frame), s.complete, s.normalErrorDegrees, s.normalErrorMeanDegrees,
                budgetColumns(s.budget), frame.latencyMilliseconds, frame.stretch);
        }
    return csv;
}

std::string reportPage(const Report& report) {
    return withData(kReportPage,
                    fmt::format("{{...{}, frames: {}, errors: {}, worst: {}}}",
                                summaryOf(report).str(), frameTimes(report.runs),
                                perRun(report.runs, judgedFramesOf), perRun(report.runs, worstOf)));
}

std::string table(const std::vector<BenchRun>& runs) {
    std::string text = tableHead();
    std::string beyond;
    std::string notes;
    for (const BenchRun& run : runs) {
        const RunSummary summary = summarize(run.played);
        text += tableLine(run, summary);
        if (summary.framesBeyond > 0)
            beyond += fmt::format("{}, {}: {} of {} frames promise more than was asked\n",
                                  run.label, drawnBy(run.renderers, run.compound),
                                  summary.framesBeyond, run.played.frames.size());
        if (summary.framesEmpty > 0 && notes.empty())
            notes = fmt::format("{} of {} frames show nothing of the scene\n", summary.framesEmpty,
                                run.played.frames.size());
    }
    for (const BenchRun& run : runs)
        if (run.budgetMilliseconds > 0)
            text += budgetLine(run);
    return text + beyond + notes;
}

absl::Status checkReportFolder(const std::string& folder) {
    static constexpr std::array<std::string_view, 4> kFiles = {"frames.csv", "errors.csv",
                                                               "index.html", "summary.json"};
    RETURN_IF_ERROR(checkFolder(folder, kFiles));
    if (isSummary(folder + "/summary.json"))
        return absl::OkStatus();
    std::error_code error;
    for (const std::string_view name : kFiles)
        if (const fs::path file = fs::path(folder) / name; fs::exists(file, error))
            return absl::InvalidArgumentError(fmt::format(
                "{}: is of no report of eyrie bench, which would replace it; move it away, or name "
                "another folder",
                file.string()));
    return absl::OkStatus();
}

absl::Status writeReport(const Report& report, const std::string& folder) {
    RETURN_IF_ERROR(makeFolder(folder));
    std::vector<mesh::OutputFile> files;
    const auto write = [&](const std::string& text, const char* name) -> absl::Status {
        ASSIGN_OR_RETURN(mesh::OutputFile file, mesh::OutputFile::create(folder + "/" + name));
        RETURN_IF_ERROR(file.write(std::as_bytes(std::span(text))));
        files.push_back(std::move(file));
        return absl::OkStatus();
    };
    const std::string errors = errorsCsv(report.runs);
    RETURN_IF_ERROR(write(framesCsv(report.runs), "frames.csv"));
    if (!errors.empty())
        RETURN_IF_ERROR(write(errors, "errors.csv"));
    RETURN_IF_ERROR(write(reportPage(report), "index.html"));
    RETURN_IF_ERROR(write(summaryJson(report), "summary.json"));
    // There is room for all of them: what replaces an earlier report is whole, or its summary gone.
    std::error_code error;
    fs::remove(folder + "/summary.json", error);
    if (errors.empty())
        fs::remove(folder + "/errors.csv", error);
    for (mesh::OutputFile& file : files) RETURN_IF_ERROR(file.commit());
    return absl::OkStatus();
}

}  // namespace eyrie::cli::bench
