// SPDX-License-Identifier: Apache-2.0
// Predicts what frames would take with more renderers than there are: `simulator --help`.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/simulator/costs.h"
#include "bench/simulator/frames.h"
#include "bench/simulator/layouts.h"
#include "bench/simulator/plot.h"
#include "bench/simulator/text.h"
#include "coordinator/compound/equalizer/equalizers.h"
#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/resolved.h"
#include "fabric/status.h"

namespace eyrie::simulator {
namespace {

struct Options {
    std::string costs;
    std::string frames;
    std::string configuration;
    std::string plot;
    std::vector<int> renderers{1, 2, 4, 8, 16, 32, 64, 128};
    int width = 1280;
    int height = 720;
    Machines machines;
};

/// Tells what is found in it besides errors.
absl::StatusOr<config::Configuration> parsed(const std::string& text, const std::string& name) {
    config::Findings findings;
    config::Configuration configuration = config::readEqc(text, findings);
    if (!findings.hasErrors())
        config::resolve(configuration, findings);
    if (findings.hasErrors())
        return absl::InvalidArgumentError(config::describe(findings, name));
    fmt::print(stderr, "{}", config::describe(findings, name));
    return configuration;
}

/// As equalizers share it out before they know anything: in equal parts.
config::Configuration shared(const config::Configuration& written) {
    config::Configuration live = written;
    config::Findings findings;
    equalizer::Equalizers(written).apply(live, {1, config::resolve(written, findings)});
    return live;
}

double median(std::vector<double> values) {
    std::ranges::nth_element(values,
                             values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    return values[values.size() / 2];
}

std::string line(int renderers, const std::string& name, const Prediction& p, double ofOne) {
    return fmt::format("{:>9}  {:<12} {:>9.2f} {:>9.1f} {:>9.1f} {:>9.0f} % {:>9.2f}\n", renderers,
                       name, p.frameMilliseconds, p.framesPerSecond, p.processorMilliseconds,
                       100 * p.framesPerSecond / (ofOne * renderers), p.bytes / 1e6);
}

constexpr const char* kHead =
    "renderers  cut           ms/frame  frames/s    cpu ms  efficiency   MB/frame\n";

absl::Status predictFile(const Options& options, const Costs& costs, double triangles) {
    ASSIGN_OR_RETURN(const std::string text, textOf(options.configuration));
    ASSIGN_OR_RETURN(const config::Configuration configuration,
                     parsed(text, options.configuration));
    ASSIGN_OR_RETURN(const Prediction p,
                     predict(shared(configuration), costs, options.machines, triangles));
    fmt::print("{:.2f} ms a frame, {:.1f} frames a second, {:.1f} ms of processors, {:.2f} MB\n",
               p.frameMilliseconds, p.framesPerSecond, p.processorMilliseconds, p.bytes / 1e6);
    return absl::OkStatus();
}

absl::Status predictMany(const Options& options, const Costs& costs, double triangles) {
    std::map<std::string, Curve> milliseconds;
    std::map<std::string, Curve> speedups;
    ASSIGN_OR_RETURN(const config::Configuration alone,
                     parsed(layoutsOf(1, options.width, options.height)[0].eqc, "one"));
    ASSIGN_OR_RETURN(const Prediction one, predict(alone, costs, options.machines, triangles));
    fmt::print("{}", kHead);
    for (const int renderers : options.renderers)
        for (const Layout& layout : layoutsOf(renderers, options.width, options.height)) {
            ASSIGN_OR_RETURN(const config::Configuration configuration,
                             parsed(layout.eqc, layout.name));
            ASSIGN_OR_RETURN(const Prediction p,
                             predict(configuration, costs, options.machines, triangles));
            fmt::print("{}", line(renderers, layout.name, p, one.framesPerSecond));
            if (renderers == 1)
                continue;
            for (auto* curves : {&milliseconds, &speedups})
                curves->try_emplace(layout.name, Curve{layout.name, {}});
            milliseconds[layout.name].points.emplace_back(renderers, p.frameMilliseconds);
            speedups[layout.name].points.emplace_back(renderers,
                                                      p.framesPerSecond / one.framesPerSecond);
        }
    if (options.plot.empty())
        return absl::OkStatus();
    const auto curvesOf = [](const std::map<std::string, Curve>& named, double first) {
        std::vector<Curve> curves;
        for (const auto& [name, curve] : named) {
            curves.push_back(curve);
            curves.back().points.emplace(curves.back().points.begin(), 1, first);
        }
        return curves;
    };
    std::ofstream out(options.plot);
    out << plot(
        fmt::format("{:.0f} triangles, {}x{}, {} cores a host, {} Gbit/s", triangles, options.width,
                    options.height, options.machines.cores, options.machines.gigabitsPerSecond),
        curvesOf(milliseconds, one.frameMilliseconds), curvesOf(speedups, 1));
    if (!out.flush())
        return absl::UnavailableError(fmt::format("{} cannot be written", options.plot));
    return absl::OkStatus();
}

absl::Status run(const Options& options) {
    ASSIGN_OR_RETURN(const Costs costs, readCosts(options.costs));
    ASSIGN_OR_RETURN(const std::vector<double> triangles, readTriangles(options.frames));
    return options.configuration.empty() ? predictMany(options, costs, median(triangles))
                                         : predictFile(options, costs, median(triangles));
}

}  // namespace
}  // namespace eyrie::simulator

int main(int argc, char** argv) {
    using eyrie::simulator::Options;
    Options options;
    CLI::App app{"Predicts what frames take with any number of renderers, from measured costs"};
    app.add_option("costs", options.costs, "name,value lines, as bench/data/costs.csv")->required();
    app.add_option("frames", options.frames, "frames.csv of `eyrie bench --renderers 1`")
        ->required();
    app.add_option("--config", options.configuration, "An .eqc file, in place of the table");
    app.add_option("--plot", options.plot, "An SVG to write")->excludes("--config");
    app.add_option("--renderers", options.renderers, "Numbers for the table")
        ->delimiter(',')
        ->check(CLI::Range(1, 128))
        ->excludes("--config")
        ->capture_default_str();
    app.add_option("--width", options.width, "Of the picture")
        ->check(CLI::Range(1, 16384))
        ->excludes("--config");
    app.add_option("--height", options.height, "Of the picture")
        ->check(CLI::Range(1, 16384))
        ->excludes("--config");
    app.add_option("--per-host", options.machines.renderersPerHost, "Renderers of a host")
        ->check(CLI::Range(1, 128));
    app.add_option("--cores", options.machines.cores, "Of a host")->check(CLI::PositiveNumber);
    app.add_flag("--one-machine", options.machines.isOneMachine, "All of them on one host");
    app.add_option("--gigabits", options.machines.gigabitsPerSecond, "A second, of a host's link")
        ->check(CLI::PositiveNumber);
    app.add_option("--latency", options.machines.latencyMilliseconds, "Milliseconds, one way")
        ->check(CLI::NonNegativeNumber);
    CLI11_PARSE(app, argc, argv);
    const absl::Status status = eyrie::simulator::run(options);
    if (status.ok())
        return 0;
    fmt::print(stderr, "simulator: {}\n",
               std::string_view(status.message().data(), status.message().size()));
    return status.code() == absl::StatusCode::kUnavailable ? 1 : 2;
}
