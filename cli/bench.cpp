// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/bench/flights.h"
#include "cli/bench/play.h"
#include "cli/bench/reference.h"
#include "cli/bench/report.h"
#include "cli/bench/uniform_levels.h"
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
    std::string size = "1280x720";
    int frames = 120;
    int repeats = 3;
    fabric::Occlusion occlusion = fabric::Occlusion::Auto;
    PictureSourceOptions pictures;
    bench::ReferenceOptions reference;
    std::string out;
    bool json = false;
};

absl::Status checkTaus(const std::vector<double>& taus) {
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

absl::StatusOr<std::vector<bench::BenchRun>> playAll(PictureSource& pictures,
                                                     const fabric::Flight& flight,
                                                     const Options& options,
                                                     const PictureSize& size,
                                                     const std::stop_token& stop) {
    std::vector<bench::BenchRun> runs;
    const int framesOfRun = options.frames * (options.repeats + 1);
    ProgressBar bar("bench", framesOfRun, "frames", ProgressBar::styleFor(options.pictures.quiet));
    const import::Progress progress = bar.callback();
    for (const double tau : options.taus) {
        bench::PlayOptions play{{}, options.frames, options.repeats};
        play.request.tauPixels = tau;
        play.request.width = size.width;
        play.request.height = size.height;
        play.request.occlusion = options.occlusion;
        int done = 0;
        const auto frameDone = [&] {
            progress(fmt::format("tau {} px", tau), static_cast<double>(++done) / framesOfRun);
        };
        ASSIGN_OR_RETURN(bench::Played played,
                         bench::play(pictures, flight, play, frameDone, stop));
        runs.push_back({tau, std::move(played)});
    }
    return runs;
}

/// Adds what was measured to `runs`, and gives the uniform levels to compare with.
absl::StatusOr<std::vector<bench::UniformLevel>> measureAll(
    PictureSource& pictures, bench::FlightJudge& judge, const Options& options,
    const PictureSize& size, std::vector<bench::BenchRun>& runs, const std::stop_token& stop) {
    ProgressBar bar("reference", judge.frames(), "frames",
                    ProgressBar::styleFor(options.pictures.quiet));
    const import::Progress progress = bar.callback();
    double untilPixels = 0;
    for (bench::BenchRun& run : runs) {
        coordinator::FrameRequest request;
        request.tauPixels = run.tauPixels;
        request.width = size.width;
        request.height = size.height;
        request.occlusion = options.occlusion;
        int done = 0;
        const auto frameDone = [&] {
            progress(fmt::format("tau {} px", run.tauPixels), ++done / judge.frames());
        };
        ASSIGN_OR_RETURN(run.measured, judge.judge(pictures, request, frameDone, stop));
        for (const bench::FrameError& error : run.measured->frames)
            untilPixels = std::max(untilPixels, error.p99Pixels);
    }
    int done = 0;
    const auto levelDone = [&] { progress("uniform decimation", 1 - std::ldexp(1.0, -++done)); };
    return bench::uniformLevels(judge.reference(), judge.cameras(), size.width, size.height,
                                untilPixels, levelDone, stop);
}

absl::Status runBench(const Options& options) {
    const StopSignal stop;
    RETURN_IF_ERROR(checkTaus(options.taus));
    ASSIGN_OR_RETURN(const PictureSize size, parsePictureSize(options.size, "--size"));
    std::optional<bench::ReferencePlan> plan;
    if (options.reference.isAsked) {
        ASSIGN_OR_RETURN(plan, bench::planReference(options.scene, options.pictures,
                                                    options.reference, stop.token()));
    }
    ASSIGN_OR_RETURN(const auto pictures,
                     PictureSource::open(options.scene, options.pictures, stop.token()));
    ASSIGN_OR_RETURN(const fabric::Flight flight,
                     bench::flightNamed(options.flight, pictures->sceneInfo().bounds));
    ASSIGN_OR_RETURN(auto runs, playAll(*pictures, flight, options, size, stop.token()));
    std::vector<bench::UniformLevel> uniform;
    if (plan) {
        ASSIGN_OR_RETURN(
            bench::FlightJudge judge,
            bench::judgeFor(*plan, flight,
                            {size.width, size.height, options.frames, options.reference.frames}));
        ASSIGN_OR_RETURN(uniform, measureAll(*pictures, judge, options, size, runs, stop.token()));
    }
    const bench::BenchFacts facts = factsOf(options, size);
    RETURN_IF_ERROR(bench::writeReport(facts, runs, options.out));
    if (options.json)
        fmt::print("{}", bench::summaryJson(facts, runs));
    else if (!options.pictures.quiet)
        fmt::print("{}{}\n", bench::table(runs), options.out + "/index.html shows it");
    for (const bench::BenchRun& run : runs)
        if (run.measured)
            RETURN_IF_ERROR(bench::checkPromise(run.tauPixels, *run.measured));
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
    bench::addReferenceOptions(*command, options->reference);
    command->add_option("-o,--output", options->out, "Folder for the report")
        ->type_name("FOLDER")
        ->required();
    addCacheOptions(*command, options->pictures.cache);
    command->add_flag("--quiet", options->pictures.quiet, "Only errors");
    command->add_flag("--json", options->json, "Print the summary as JSON");
    command->footer(
        "The report is index.html to look at, summary.json and frames.csv to work with. The error\n"
        "in it is the one promised for every frame; frames that promise more than was asked count\n"
        "as framesBeyondTau. With --reference errors are measured, too, and a frame that is "
        "farther\n"
        "off than it promises is an error (exit status 1, after the report is written).\n\n"
        "Examples:\n"
        "  eyrie bench dem.eyt --flight walkthrough -o report\n"
        "  eyrie bench scan.eym --tau 1,4 --reference -o report\n"
        "  eyrie bench scene.json --flight flight.json --tau 1,2 --renderers 2 -o report");
    command->callback([options, &run] { run = [options] { return runBench(*options); }; });
}

}  // namespace eyrie::cli
