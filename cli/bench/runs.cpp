// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/runs.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "coordinator/frame/problem.h"
#include "fabric/status.h"

namespace eyrie::cli::bench {
namespace {

/// A run that has not been played.
BenchRun runOf(const Asked& asked, int renderers, const ConfigOptions& config) {
    BenchRun run;
    run.label = asked.budgetMilliseconds > 0 ? fmt::format("{} ms", asked.budgetMilliseconds)
                                             : fmt::format("{} px", asked.tauPixels);
    run.tauPixels = asked.tauPixels;
    run.budgetMilliseconds = asked.budgetMilliseconds;
    run.renderers = renderers;
    if (renderers > 1)
        run.compound = config.file.empty() ? config.compound
                                           : std::filesystem::path(config.file).filename().string();
    return run;
}

std::uint64_t hashOf(const fabric::SceneInfo& scene) {
    std::uint64_t hash = 0;
    const auto add = [&](std::uint64_t value) { hash = hash * 31 + value; };
    for (const fabric::DataFile& file : scene.files) add(file.checksum);
    for (const fabric::ObjectInfo& object : scene.objects)
        for (const fabric::Vec3& corner : {object.bounds.min, object.bounds.max})
            for (int axis = 0; axis < 3; ++axis) add(std::bit_cast<std::uint64_t>(corner[axis]));
    return hash;
}

absl::Status playRun(const RunPlan& plan, BenchRun& run, const std::function<void()>& frameDone,
                     const std::stop_token& stop) {
    PictureSourceOptions options = plan.pictures;
    options.renderers = run.renderers;
    ASSIGN_OR_RETURN(const auto pictures, PictureSource::open(plan.scene, options, stop));
    ASSIGN_OR_RETURN(fabric::CameraPath path, plan.flight.over(pictures->sceneInfo().bounds));
    run.flightNote = std::move(path.note);
    run.sizeNote = coordinator::noteOfSize(pictures->sceneInfo().bounds);
    run.sceneHash = hashOf(pictures->sceneInfo());
    PlayOptions play = plan.play;
    play.request.tauPixels = run.tauPixels;
    if (run.budgetMilliseconds > 0) {
        play.request.budgetMilliseconds = run.budgetMilliseconds;
        play.request.completeness = fabric::Completeness::Interactive;
        play.keeps = plan.keeps;
    }
    absl::StatusOr<Played> played = bench::play(*pictures, path.flight, play, frameDone, stop);
    if (!played.ok())
        return fabric::withContext(played.status(), plan.flight.name());
    run.played = *std::move(played);
    return absl::OkStatus();
}

/// What runs before keep is none of a run's.
void leaveOutKept(const std::vector<BenchRun>& before, std::uint64_t& bytes) {
    for (const BenchRun& run : before) bytes -= std::min(bytes, keptBytes(run.played));
}

}  // namespace

std::string drawnBy(int renderers, const std::string& compound) {
    if (renderers == 0)
        return "one process";
    return renderers == 1 ? "1 renderer" : fmt::format("{} renderers, {}", renderers, compound);
}

ProgressBar::Style progressStyle(const RunPlan& plan) {
    return plan.progressJson ? ProgressBar::Style::Json
                             : ProgressBar::styleFor(plan.pictures.quiet);
}

absl::StatusOr<std::vector<BenchRun>> playRuns(const RunPlan& plan, const std::stop_token& stop) {
    const auto passesOf = [&](const Asked& asked) {
        const bool keeps = asked.budgetMilliseconds > 0 && !plan.keeps.empty();
        return plan.play.repeats + (keeps ? 2 : 1);
    };
    ProgressBar bar("bench", plan.play.frames * (plan.play.repeats + 1), "frames",
                    progressStyle(plan));
    const import::Progress progress = bar.callback();
    std::vector<BenchRun> runs;
    for (const int renderers : plan.renderers)
        for (const Asked& asked : plan.asked) {
            BenchRun run = runOf(asked, renderers, plan.pictures.config);
            const std::string stage =
                fmt::format("{}, {}", run.label, drawnBy(renderers, run.compound));
            const int frames = plan.play.frames * passesOf(asked);
            int done = 0;
            const auto frameDone = [&] { progress(stage, static_cast<double>(++done) / frames); };
            RETURN_IF_ERROR(playRun(plan, run, frameDone, stop));
            leaveOutKept(runs, run.played.peakResidentBytes);
            runs.push_back(std::move(run));
        }
    return runs;
}

}  // namespace eyrie::cli::bench
