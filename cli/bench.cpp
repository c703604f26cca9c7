// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/bench/compare_report.h"
#include "cli/bench/machine.h"
#include "cli/bench/reference.h"
#include "cli/bench/report.h"
#include "cli/commands.h"
#include "cli/drawing_options.h"
#include "cli/log.h"
#include "cli/occlusion_option.h"
#include "cli/options/common_options.h"
#include "cli/options/options_file.h"
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
    int repeats = 5;
    std::vector<int> renderers{0};
    fabric::Occlusion occlusion = fabric::Occlusion::Auto;
    PictureSourceOptions pictures;
    bench::ReferenceOptions reference;
    std::string out;
    bool hasTaus = false;  ///< were given
    bool json = false;
    bool progressJson = false;
    std::vector<std::string> compared;
    std::vector<std::string> given;  ///< options that say how to measure
    bool force = false;
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

using Configured = std::optional<config::Configuration>;

bench::BenchFacts factsOf(const Options& options, const bench::RunPlan& plan,
                          const Configured& configuration,
                          const std::vector<bench::BenchRun>& runs) {
    const auto nameOf = [](const std::filesystem::path& path) { return path.filename().string(); };
    return {nameOf(options.scene),
            nameOf(options.flight),
            plan.play.request.width,
            plan.play.request.height,
            options.frames,
            options.repeats,
            bench::commandLine(),
            cli::nameOf(options.occlusion),
            wordsOf(options.pictures.config),
            plan.flight.hash(),
            runs.front().sceneHash,
            configurationHash(configuration)};
}

/// In their order, each once.
template <typename T>
std::vector<T> withoutRepeats(const std::vector<T>& values) {
    std::vector<T> once;
    for (const T& value : values)
        if (std::ranges::find(once, value) == once.end())
            once.push_back(value);
    return once;
}

/// What each run asks of its frames: a tau, or a frame time, at which the finest of the taus is
/// asked for.
std::vector<bench::Asked> askedOf(const Options& options) {
    std::vector<bench::Asked> asked;
    if (options.budgets.empty() || options.hasTaus)
        for (const double tau : withoutRepeats(options.taus)) asked.push_back({tau});
    for (const double budget : withoutRepeats(options.budgets))
        asked.push_back({*std::ranges::min_element(options.taus), budget});
    return asked;
}

bench::RunPlan planOf(const Options& options, bench::NamedFlight flight, const PictureSize& size) {
    bench::PlayOptions play;
    play.frames = options.frames;
    play.repeats = options.repeats;
    play.request.width = size.width;
    play.request.height = size.height;
    play.request.occlusion = options.occlusion;
    play.request.shown = {options.pictures.config.shown};
    return {options.scene, std::move(flight), askedOf(options),    options.renderers,
            play,          options.pictures,  options.progressJson};
}

absl::StatusOr<bench::WrittenReport> readCompared(const std::string& path) {
    auto report = bench::readReport(path);
    if (!report.ok())
        return fabric::withContext(report.status(), "--compare");
    return report;
}

absl::Status runCompare(const Options& options) {
    if (!options.given.empty() && !options.pictures.quiet)
        tell(fmt::format("without effect, since --compare measures nothing: {}",
                         fmt::join(options.given, ", ")));
    ASSIGN_OR_RETURN(auto a, readCompared(options.compared[0]));
    ASSIGN_OR_RETURN(auto b, readCompared(options.compared[1]));
    ASSIGN_OR_RETURN(const bench::Comparison comparison,
                     bench::compare(std::move(a), std::move(b), options.force));
    if (!options.out.empty())
        RETURN_IF_ERROR(bench::writeComparison(comparison, options.out));
    if (options.json)
        fmt::print("{}", bench::comparisonJson(comparison));
    else if (!options.pictures.quiet)
        fmt::print("{}", bench::table(comparison));
    return absl::OkStatus();
}

/// What is judged is what the camera itself sees.
absl::Status checkReference(const Options& options) {
    const ConfigOptions& config = options.pictures.config;
    if (!options.reference.isAsked)
        return absl::OkStatus();
    if (!config.file.empty())
        return absl::InvalidArgumentError(
            "--reference judges what the camera itself sees, which a configuration's walls may "
            "not; leave --config out, or name a --compound");
    if (config.shown != coordinator::Shown{})
        return absl::InvalidArgumentError(
            "--reference judges what the camera itself sees, which is not what --eye, --stereo, "
            "--canvas and --segment show; leave them out");
    return absl::OkStatus();
}

/// As asked for or, with a configuration, as many as it uses. What only a configuration has is
/// drawn by at least one (PictureSource::open).
std::vector<int> renderersFor(const Options& options, const Configured& configuration) {
    std::vector<int> renderers = options.renderers;
    if (configuration)
        std::ranges::replace(renderers, 0, renderersOf(*configuration));
    else if (options.pictures.config.shown != coordinator::Shown{})
        std::ranges::replace(renderers, 0, 1);
    return withoutRepeats(renderers);
}

absl::Status runBench(const Options& options) {
    if (!options.compared.empty())
        return runCompare(options);
    if (options.scene.empty() || options.out.empty())
        return absl::InvalidArgumentError(
            "bench needs a scene and -o FOLDER, or --compare A B; `eyrie bench --help` explains "
            "it");
    noteIdleCompound(options.pictures, std::ranges::max(options.renderers));
    const StopSignal stop;
    RETURN_IF_ERROR(checkTaus(options.taus, options.budgets));
    RETURN_IF_ERROR(checkReference(options));
    RETURN_IF_ERROR(fabric::withContext(bench::checkReportFolder(options.out), "-o"));
    ASSIGN_OR_RETURN(const PictureSize size, parsePictureSize(options.size, "--size"));
    ASSIGN_OR_RETURN(bench::NamedFlight flight, bench::NamedFlight::read(options.flight));
    ASSIGN_OR_RETURN(const Configured configuration,
                     configurationOf(options.pictures.config, toldOf(options.pictures.quiet)));
    bench::RunPlan plan = planOf(options, std::move(flight), size);
    plan.pictures.configIsTold = true;
    plan.renderers = renderersFor(options, configuration);
    std::optional<bench::ReferencePlan> reference;
    if (options.reference.isAsked) {
        ASSIGN_OR_RETURN(reference, bench::planReference(plan, options.reference, stop.token()));
        plan.keeps = reference->judged;
    }
    ASSIGN_OR_RETURN(auto runs, bench::playRuns(plan, stop.token()));
    if (!options.pictures.quiet && !runs.front().flightNote.empty())
        tell(fmt::format("{}: {}", options.flight, runs.front().flightNote));
    if (!options.pictures.quiet && !runs.front().sizeNote.empty())
        tell(fmt::format("{}: {}", options.scene, runs.front().sizeNote));
    using Levels = std::vector<bench::UniformLevel>;
    absl::StatusOr<Levels> uniform = Levels();
    if (reference)
        uniform = bench::measureRuns(*reference, plan, runs, stop.token());
    if (absl::IsCancelled(uniform.status()))
        return uniform.status();
    if (!uniform.ok())  // how fast they were is known, after minutes maybe
        for (bench::BenchRun& run : runs) run.measured.reset();
    const bench::BenchFacts facts = factsOf(options, plan, configuration, runs);
    const bench::Report report{facts, std::move(runs), uniform.value_or(Levels())};
    RETURN_IF_ERROR(bench::writeReport(report, options.out));
    if (options.json)
        fmt::print("{}", bench::summaryJson(report));
    else if (!options.pictures.quiet)
        fmt::print("{}{}\n", bench::table(report.runs), options.out + "/index.html shows it");
    RETURN_IF_ERROR(uniform.status());
    return bench::checkPromises(report.runs);
}

void addMeasuringOptions(CLI::App& command, Options& options) {
    command
        .add_option("--flight", options.flight,
                    "orbit, walkthrough, worst, or a file, JSON or an older program's camera path; "
                    "see below")
        ->type_name("NAME|FILE")
        ->capture_default_str();
    command
        .add_option("--tau", options.taus,
                    "Screen-space errors to allow, in pixels, separated by commas")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->capture_default_str();
    command
        .add_option("--budget-ms", options.budgets,
                    "Frame times to hold, in ms, separated by commas, by drawing coarser than the "
                    "least --tau as needed; then taus only where they are given")
        ->delimiter(',')
        ->allow_extra_args(false);
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
        .add_option("--renderers", options.renderers,
                    "Numbers of processes to draw with, separated by commas; 0: draw in this one")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::Range(0, RendererProcesses::kMaxCount))
        ->capture_default_str();
    addConfigOptions(command, options.pictures.config);
    addShownOptions(command, options.pictures.config);
}

void addCompareOptions(CLI::App& command, Options& options) {
    command
        .add_option("--compare", options.compared,
                    "Two reports, folders or summary.json files, instead of a scene")
        ->type_name("A B")
        ->expected(2)
        ->excludes("scene");
    command
        .add_flag("--force", options.force,
                  "Compare though scene, flight, size, frames or what is seen differ")
        ->needs("--compare");
}

/// Options that were given and say how to measure, not how to compare.
std::vector<std::string> givenToMeasure(const CLI::App& command) {
    constexpr std::array<std::string_view, 5> kToCompare = {"compare", "force", "output", "quiet",
                                                            "json"};
    std::vector<std::string> given;
    for (const std::string& name : settableNames(command)) {
        const CLI::Option& option = *command.get_option("--" + name);
        const bool isOfMeasuring = option.get_group() != kCommonGroup &&
                                   std::ranges::find(kToCompare, name) == kToCompare.end();
        if (option.count() > 0 && isOfMeasuring)
            given.push_back("--" + name);
    }
    return given;
}

}  // namespace

void addBench(CLI::App& app, Run& run) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "bench", "Measure speed against error along a flight, or compare two such reports");
    command->add_option("scene", options->scene, "What is drawn, as for `eyrie serve`")
        ->type_name("FILE");
    addMeasuringOptions(*command, *options);
    bench::addReferenceOptions(*command, options->reference);
    command->add_option("-o,--output", options->out, "Folder for the report, or the comparison")
        ->type_name("FOLDER");
    addCompareOptions(*command, *options);
    addDrawingOptions(*command, options->pictures.drawing);
    command->add_flag("--quiet", options->pictures.quiet, "Only warnings and errors");
    command->add_flag("--json", options->json, "Print the summary as JSON");
    command->add_flag("--progress-json", options->progressJson,
                      "Progress as lines of JSON on standard error, for programs: a run, and how "
                      "far that is from 0 to 1");
    command->footer(
        "Flights are files of JSON, {\"keys\":[{\"seconds\":0,\"camera\":{...}}]}, as the page\n"
        "saves them, or camera paths: of eqPly (a line of 3 degrees that turn the model, then\n"
        "lines 'frames x y z heading pitch roll', the scene as the model), or a camera a line\n"
        "(eye, up and view-plane normal, 9 numbers). These are played at 30 cameras a second,\n"
        "45 degrees high.\n\n"
        "The report is index.html to look at, summary.json and frames.csv to work with.\n"
        "Processes have as many frames in flight as the configuration's latency and one (two\n"
        "without one, 8 at most): a frame's time is that since the frame before it, and\n"
        "latency, from choosing the view to having its picture, is told beside it. In this\n"
        "process they are the same. The error in it is the one promised for every frame;\n"
        "frames that promise more than was asked count as framesBeyondTau. At a frame time to\n"
        "hold (--budget-ms), frames do not wait for data, and may be drawn with fewer pixels\n"
        "than --size has: framesSmaller counts these, stretchMax and frames.csv (stretch)\n"
        "tell how far pixels are stretched. Errors are in pixels of --size. With --reference\n"
        "errors are measured, too (errors.csv has each frame's), at a frame time to hold of\n"
        "the pictures that one more pass shows; and a frame that is farther off than it\n"
        "promises, or has holes, is an error: exit status 1, after the report is written.\n"
        "Holes between channels of several renderers are told, but are no error where not all\n"
        "data were loaded or memory was short. Where the source is not found, or memory\n"
        "cannot hold it, this ends before anything is played, without a report; where errors\n"
        "cannot be measured after all, as of a source that has changed meanwhile, the report\n"
        "has the rest. The exit status is then 1 or 2, too.\n\n"
        "Examples:\n"
        "  eyrie bench dem.eyt --flight walkthrough -o report\n"
        "  eyrie bench scan.eym --tau 1,4 --reference -o report\n"
        "  eyrie bench scene.json --flight flight.json --tau 1,2 --renderers 0,1,2 -o report\n"
        "  eyrie bench dem.eyt --flight walkthrough --budget-ms 33,50 --reference -o report\n"
        "  eyrie bench --compare before after -o comparison");
    command->callback([options, command, &run] {
        options->hasTaus = command->count("--tau") > 0;
        options->given = givenToMeasure(*command);
        run = [options] { return runBench(*options); };
    });
}

}  // namespace eyrie::cli
