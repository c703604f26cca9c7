// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/compare_report.h"

#include <cmath>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "cli/bench/compare_page.h"
#include "cli/bench/page.h"
#include "cli/bench/runs.h"
#include "cli/image_files.h"
#include "cli/json_object.h"
#include "fabric/status.h"

namespace eyrie::cli::bench {
namespace {

JsonObject toJson(const Figure& figure) {
    JsonObject json;
    json.text("name", figure.name)
        .text("unit", figure.unit)
        .number("a", figure.a)
        .number("b", figure.b)
        .text("verdict", wordFor(figure))
        .flag("beyondNoise", figure.verdict == Verdict::Less || figure.verdict == Verdict::More);
    if (figure.ratio)
        json.number("ratio", figure.ratio->estimate)
            .number("low", figure.ratio->low)
            .number("high", figure.ratio->high)
            .number("confidence", figure.ratio->confidence);
    return json;
}

/// Of the curves.
JsonObject toJson(const WrittenRun& run) {
    std::vector<JsonObject> passes;
    for (const PassSummary& pass : run.passes)
        passes.emplace_back().number("p50", pass.frame.p50).number("p95", pass.frame.p95);
    JsonObject tauAchieved;
    tauAchieved.number("p50", run.tauAchieved.p50).number("p95", run.tauAchieved.p95);
    JsonObject json;
    json.number("tauAchievedMax", run.tauAchievedMax)
        .number("budgetMs", run.budgetMilliseconds)
        .object("tauAchieved", tauAchieved)
        .number("p50", run.frame.p50)
        .number("p95", run.frame.p95)
        .objects("passes", passes);
    return json;
}

JsonObject toJson(const RunComparison& run) {
    std::vector<JsonObject> figures;
    for (const Figure& figure : run.figures) figures.push_back(toJson(figure));
    JsonObject json;
    json.text("label", run.a.label)
        .count("renderers", static_cast<std::uint64_t>(run.a.renderers))
        .text("compound", run.a.compound)
        .object("a", toJson(run.a))
        .object("b", toJson(run.b))
        .objects("figures", figures);
    return json;
}

JsonObject toJson(const WrittenReport& report) {
    JsonObject json;
    json.text("name", report.name)
        .text("scene", report.scene)
        .text("flight", report.flight)
        .number("width", report.width)
        .number("height", report.height)
        .number("frames", report.frames)
        .text("processor", report.processor)
        .text("device", report.device)
        .text("command", report.command);
    return json;
}

std::string intervalOf(const Figure& figure) {
    if (figure.ratio)
        return fmt::format("{:>6.3f}  {:.3f} to {:.3f}", figure.ratio->estimate, figure.ratio->low,
                           figure.ratio->high);
    return figure.a > 0 && std::isfinite(figure.a) && std::isfinite(figure.b)
               ? fmt::format("{:>6.3f}", figure.b / figure.a)
               : "";
}

std::string noteLines(const Comparison& comparison) {
    std::string text;
    for (const std::string& note : comparison.notes) text += "note: " + note + "\n";
    return text;
}

}  // namespace

std::string_view wordFor(const Figure& figure) {
    const bool isTime = figure.unit == "ms";
    switch (figure.verdict) {
        case Verdict::Equal:
            return "equal";
        case Verdict::WithinNoise:
            return "within noise";
        case Verdict::Less:
            return isTime ? "faster" : "less";
        case Verdict::More:
            return isTime ? "slower" : "more";
        case Verdict::TooFewPasses:
            return "too few passes to tell";
        case Verdict::NotRepeated:
            return "not judged";
    }
    return "";
}

std::string table(const Comparison& comparison) {
    std::string text = fmt::format("A: {}\nB: {}\n{}", comparison.a.name, comparison.b.name,
                                   noteLines(comparison));
    for (const RunComparison& run : comparison.runs) {
        text += fmt::format("\n{:<28}{:>12}{:>12}   {:<24} {}\n",
                            run.a.label + ", " + drawnBy(run.a.renderers, run.a.compound), "A", "B",
                            " B / A", "B is");
        for (const Figure& figure : run.figures)
            text += fmt::format("  {:<26}{:>12.5g}{:>12.5g}   {:<24} {}\n",
                                figure.name + (figure.unit.empty() ? "" : ", " + figure.unit),
                                figure.a, figure.b, intervalOf(figure), wordFor(figure));
    }
    const int beyond = countBeyondNoise(comparison);
    return text + (beyond == 0 ? std::string("\nnothing is beyond noise\n")
                               : fmt::format("\n{} figures are beyond noise\n", beyond));
}

std::string comparisonJson(const Comparison& comparison) {
    std::vector<JsonObject> runs;
    for (const RunComparison& run : comparison.runs) runs.push_back(toJson(run));
    std::vector<JsonObject> notes;
    for (const std::string& note : comparison.notes) notes.emplace_back().text("note", note);
    JsonObject json;
    json.object("a", toJson(comparison.a))
        .object("b", toJson(comparison.b))
        .objects("runs", runs)
        .objects("notes", notes)
        .count("beyondNoise", static_cast<std::uint64_t>(countBeyondNoise(comparison)));
    return json.str() + "\n";
}

std::string comparisonPage(const Comparison& comparison) {
    return withData(kComparePage, comparisonJson(comparison));
}

absl::Status writeComparison(const Comparison& comparison, const std::string& folder) {
    const auto has = [&](const char* name) {
        std::error_code error;
        return std::filesystem::exists(folder + "/" + name, error);
    };
    if (has("summary.json"))
        return absl::InvalidArgumentError(
            fmt::format("-o {}: holds a report, whose page the comparison would replace; name "
                        "another folder",
                        folder));
    if (has("index.html") && !has("comparison.json"))
        return absl::InvalidArgumentError(
            fmt::format("-o {}: its index.html is of no comparison, which would replace it; move "
                        "it away, or name another folder",
                        folder));
    RETURN_IF_ERROR(fabric::withContext(makeFolder(folder), "-o"));
    RETURN_IF_ERROR(writeText(comparisonPage(comparison), folder + "/index.html"));
    return writeText(comparisonJson(comparison), folder + "/comparison.json");
}

}  // namespace eyrie::cli::bench
