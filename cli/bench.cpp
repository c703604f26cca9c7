// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/bench/flights.h"
#include "cli/bench/play.h"
#include "cli/bench/report.h"
#include "cli/cache_options.h"
#include "cli/commands.h"
#include "cli/compound_names.h"
#include "cli/occlusion_option.h"
#include "cli/picture_source.h"
#include "cli/progress_bar.h"
#include "cli/renderer_processes.h"
#include "cli/stop_signal.h"
#include "cli/values.h"
#include "fabric/frame_data.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

struct Options {
    std::string scene;
    std::string flight = "orbit";
    std::vector<double> taus{0.5, 1, 2, 4, 8};
    std::vector<double> budgets;  ///< milliseconds
    std::string size = "1280x720";
    int frames = 120;
    int repeats = 3;
    fabric::Occlusion occlusion = fabric::Occlusion::Auto;
    PictureSourceOptions pictures;
    std::string out;
    bool hasTaus = false;  ///< were given
    bool json = false;
};

absl::Status checkTaus(const std::vector<double>& taus, const std::vector<double>& budgets) {
    for (const double budget : budgets)
        RETURN_IF_ERROR(
            fabric::withContext(fabric::validateBudgetMilliseconds(budget), "--budget-ms"));
    for (const double tau : taus)
        if (!(tau >= fabric::kMinTauPixels && tau <= fabric::kMaxTauPixels))
            return absl::InvalidArgumentError(fmt::format("--tau has {}; expected {} to {} pixels",
                                                          tau, fabric::kMinTauPixels,
                                                          fabric::kMaxTauPixels));
    return absl::OkStatus();
}

bench::BenchFacts factsOf(const Options& options, const PictureSize& size) {
    const std::filesystem::path flight(options.flight);
    return {std::filesystem::path(options.scene).filename().string(),
            flight.filename().string(),
            size.width,
            size.height,
            options.frames,
            options.repeats,
            options.pictures.renderers,
            options.pictures.compound == coordinator::Decomposition::TwoD ? "2D" : "DB"};
}

/// What each run asks of its frames, beside size and the like: a tau, or a frame time, at which the
/// finest of the taus is asked for.
std::vector<coordinator::FrameRequest> requestsOf(const Options& options) {
    std::vector<coordinator::FrameRequest> requests;
    if (options.budgets.empty() || options.hasTaus)
        for (const double tau : options.taus) requests.emplace_back().tauPixels = tau;
    for (const double budget : options.budgets) {
        coordinator::FrameRequest& request = requests.emplace_back();
        request.tauPixels = *std::min_element(options.taus.begin(), options.taus.end());
        request.budgetMilliseconds = budget;
        request.completeness = fabric::Completeness::Interactive;
    }
    return requests;
}

absl::StatusOr<std::vector<bench::BenchRun>> playAll(PictureSource& pictures,
                                                     const fabric::Flight& flight,
                                                     const Options& options,
                                                     const PictureSize& size,
                                                     const std::stop_token& stop) {
    std::vector<bench::BenchRun> runs;
    const int framesOfRun = options.frames * (options.repeats + 1);
    ProgressBar bar("bench", framesOfRun, "frames", ProgressBar::styleFor(options.pictures.quiet));
    const import::Progress progress = bar.callback();
    for (const coordinator::FrameRequest& request : requestsOf(options)) {
        bench::PlayOptions play{request, options.frames, options.repeats};
        play.request.width = size.width;
        play.request.height = size.height;
        play.request.occlusion = options.occlusion;
        int done = 0;
        const auto frameDone = [&] {
            progress(request.budgetMilliseconds ? fmt::format("{} ms", *request.budgetMilliseconds)
                                                : fmt::format("tau {} px", request.tauPixels),
                     static_cast<double>(++done) / framesOfRun);
        };
        ASSIGN_OR_RETURN(bench::Played played,
                         bench::play(pictures, flight, play, frameDone, stop));
        runs.push_back(
            {request.tauPixels, std::move(played), request.budgetMilliseconds.value_or(0)});
    }
    return runs;
}

absl::Status runBench(const Options& options) {
    const StopSignal stop;
    RETURN_IF_ERROR(checkTaus(options.taus, options.budgets));
    ASSIGN_OR_RETURN(const PictureSize size, parsePictureSize(options.size, "--size"));
    ASSIGN_OR_RETURN(const auto pictures,
                     PictureSource::open(options.scene, options.pictures, stop.token()));
    ASSIGN_OR_RETURN(const fabric::Flight flight,
                     bench::flightNamed(options.flight, pictures->sceneInfo().bounds));
    ASSIGN_OR_RETURN(const auto runs, playAll(*pictures, flight, options, size, stop.token()));
    const bench::BenchFacts facts = factsOf(options, size);
    RETURN_IF_ERROR(bench::writeReport(facts, runs, options.out));
    if (options.json)
        fmt::print("{}", bench::summaryJson(facts, runs));
    else if (!options.pictures.quiet)
        fmt::print("{}{}\n", bench::table(runs), options.out + "/index.html shows it");
    return absl::OkStatus();
}

void addMeasuringOptions(CLI::App& command, Options& options) {
    command
        .add_option(
            "--flight", options.flight,
            R"(orbit, walkthrough, or a JSON file: {"keys":[{"seconds":0,"camera":{...}}]})")
        ->type_name("NAME|FILE")
        ->capture_default_str();
    command.add_option("--tau", options.taus, "Screen-space errors to allow, in pixels")
        ->delimiter(',')
        ->capture_default_str();
    command
        .add_option("--budget-ms", options.budgets,
                    "Frame times to hold, in ms, by drawing coarser than the least --tau as needed;"
                    " then taus only where they are given")
        ->delimiter(',');
    command.add_option("--size", options.size, "Of the picture, in pixels")
        ->type_name("WIDTHxHEIGHT")
        ->capture_default_str();
    command.add_option("--frames", options.frames, "Of one pass along the flight, evenly in time")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str();
    command.add_option("--repeats", options.repeats, "Passes that count; one before them loads")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    addOcclusionOption(command, options.occlusion);
    command
        .add_option("--renderers", options.pictures.renderers,
                    "Draw with so many processes instead of in this one")
        ->check(CLI::Range(1, RendererProcesses::kMaxCount));
    command
        .add_option("--compound", options.pictures.compound,
                    "How these cut the frame: 2D, by pixels, or DB, by data [2D]")
        ->transform(CLI::CheckedTransformer(compoundNames()).description(""))
        ->type_name("2D|DB");
}

}  // namespace

void addBench(CLI::App& app, Run& run) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("bench", "Measure speed against error along a flight");
    command->add_option("scene", options->scene, "What is drawn, as for `eyrie serve`")
        ->type_name("FILE")
        ->required();
    addMeasuringOptions(*command, *options);
    command->add_option("-o,--output", options->out, "Folder for the report")
        ->type_name("FOLDER")
        ->required();
    addCacheOptions(*command, options->pictures.cache);
    command->add_flag("--quiet", options->pictures.quiet, "Only errors");
    command->add_flag("--json", options->json, "Print the summary as JSON");
    command->footer(
        "The report is index.html to look at, summary.json and frames.csv to work with. The error\n"
        "in it is the one promised for every frame; frames that promise more than was asked count\n"
        "as framesBeyondTau. At a frame time to hold, frames do not wait for data.\n\n"
        "Examples:\n"
        "  eyrie bench dem.eyt --flight walkthrough -o report\n"
        "  eyrie bench scene.json --flight flight.json --tau 1,2 --renderers 2 -o report\n"
        "  eyrie bench dem.eyt --flight walkthrough --budget-ms 33,50 -o report");
    command->callback([options, command, &run] {
        options->hasTaus = command->count("--tau") > 0;
        run = [options] { return runBench(*options); };
    });
}

}  // namespace eyrie::cli
