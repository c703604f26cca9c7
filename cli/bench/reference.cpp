// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/reference.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "cli/bench/flights.h"
#include "cli/bench/resident_memory.h"
#include "cli/bench/uniform_levels.h"
#include "cli/load_scene.h"
#include "cli/progress_bar.h"
#include "cli/values.h"
#include "fabric/status.h"

namespace eyrie::cli::bench {
namespace {

absl::StatusOr<std::uint64_t> limitOf(const ReferenceOptions& options) {
    if (options.memory.empty())
        return static_cast<std::uint64_t>(kShareOfMemory * static_cast<double>(availableBytes()));
    return parseBytes(options.memory, "--reference-memory");
}

JudgedFrames judgedOf(const RunPlan& plan, int frames) {
    const coordinator::FrameRequest& request = plan.play.request;
    const auto held = std::ranges::count_if(
        plan.asked, [](const Asked& asked) { return asked.budgetMilliseconds > 0; });
    double finest = kFinestTauPixels;
    for (const Asked& asked : plan.asked) finest = std::min(finest, asked.tauPixels);
    return {request.width,
            request.height,
            plan.play.frames,
            frames,
            static_cast<int>(held) * static_cast<int>(plan.renderers.size()),
            finest};
}

absl::StatusOr<ReferenceMemory> memoryOf(const JudgedFrames& frames,
                                         const ReferenceOptions& options) {
    ASSIGN_OR_RETURN(const std::uint64_t limit, limitOf(options));
    return ReferenceMemory{
        limit, neededBytes(frames),
        fmt::format("{} frames of {} x {} pixels", std::min(frames.judged, frames.played),
                    frames.width, frames.height)};
}

absl::StatusOr<std::unique_ptr<PictureSource>> open(const RunPlan& plan, int renderers,
                                                    const std::stop_token& stop) {
    PictureSourceOptions options = plan.pictures;
    options.renderers = renderers;
    return PictureSource::open(plan.scene, options, stop);
}

absl::StatusOr<FlightJudge> judgeFor(const ReferencePlan& reference, const RunPlan& plan,
                                     const std::stop_token& stop) {
    ASSIGN_OR_RETURN(const auto pictures, open(plan, 0, stop));
    ASSIGN_OR_RETURN(const fabric::CameraPath path, plan.flight.over(pictures->sceneInfo().bounds));
    ASSIGN_OR_RETURN(ReferenceScene scene, readSources(reference.scene, reference.sources));
    return FlightJudge(std::move(scene), path.flight, reference.frames, reference.remote);
}

/// What colours are compared with is drawn with the memory that renderers have by themselves, or
/// more: nothing where the plan's have.
absl::StatusOr<std::unique_ptr<PictureSource>> openFinest(const RunPlan& plan, int renderers,
                                                          const std::stop_token& stop) {
    ASSIGN_OR_RETURN(const RendererOptions asked, rendererOptionsOf(plan.pictures.drawing));
    const RendererOptions usual;
    RunPlan finest = plan;
    if (asked.memoryBytes < usual.memoryBytes)
        finest.pictures.drawing.memory = DrawingOptions().memory;
    if (asked.hostMemoryBytes < usual.hostMemoryBytes)
        finest.pictures.drawing.hostMemory = DrawingOptions().hostMemory;
    const bool isLimited =
        asked.memoryBytes < usual.memoryBytes || asked.hostMemoryBytes < usual.hostMemoryBytes;
    return isLimited ? open(finest, renderers, stop) : nullptr;
}

/// A tau draws the same again; what a frame time came to is in the pictures that were kept.
absl::StatusOr<MeasuredErrors> measureRun(FlightJudge& judge, const RunPlan& plan, BenchRun& run,
                                          const std::function<void()>& frameDone,
                                          const std::stop_token& stop) {
    ASSIGN_OR_RETURN(const auto pictures, open(plan, run.renderers, stop));
    ASSIGN_OR_RETURN(const auto unlimited, openFinest(plan, run.renderers, stop));
    PictureSource& finest = unlimited ? *unlimited : *pictures;
    coordinator::FrameRequest request = plan.play.request;
    request.tauPixels = run.tauPixels;
    if (run.budgetMilliseconds > 0)
        return judge.judge(std::exchange(run.played.kept, {}), finest, request, frameDone, stop);
    return judge.judge(*pictures, finest, request, frameDone, stop);
}

absl::Status checkCompared(const std::vector<BenchRun>& runs) {
    for (const BenchRun& run : runs)
        for (const FrameError& error : run.measured->frames)
            if (error.compared > 0)
                return absl::OkStatus();
    const std::string& ofSize = runs.front().sizeNote;
    return absl::FailedPreconditionError(fmt::format(
        "nothing was measured: no frame that was held against the source shows anything of it "
        "(what is see-through does not count); {}",
        ofSize.empty() ? "take another flight, or more --reference-frames" : ofSize));
}

double largestP99(const std::vector<BenchRun>& runs) {
    double largest = 0;
    for (const BenchRun& run : runs)
        for (const FrameError& error : run.measured->frames)
            largest = std::max(largest, error.p99Pixels);
    return largest;
}

/// Of the frames in which some run has something to measure.
std::vector<fabric::Camera> measuredCameras(const FlightJudge& judge,
                                            const std::vector<BenchRun>& runs) {
    const std::vector<fabric::Camera> judged = judge.cameras();
    std::vector<fabric::Camera> measured;
    for (std::size_t i = 0; i < judged.size(); ++i)
        if (std::ranges::any_of(
                runs, [i](const BenchRun& run) { return !isEmpty(run.measured->frames[i]); }))
            measured.push_back(judged[i]);
    return measured;
}

/// Of the frames that do not keep their promise, the one that is farthest off.
std::optional<FrameError> worstBroken(const std::vector<FrameError>& frames) {
    std::optional<FrameError> worst;
    const auto beyond = [](const FrameError& error) {
        return error.maxPixels - error.promisedPixels;
    };
    for (const FrameError& frame : frames)
        if (!keepsPromise(frame) && (!worst || beyond(frame) > beyond(*worst)))
            worst = frame;
    return worst;
}

std::string whatIsWrong(const FrameError& error) {
    if (hasWrongPixels(error))
        return fmt::format(
            "away from outlines, {} pixels are empty where the source is, {} are drawn where it is "
            "not, {} show what is hidden in it",
            error.holes, error.falseHits, error.misplaced);
    return fmt::format(
        "a surface is {:.4f} px from where the source has it, and {:.4f} px were promised",
        error.maxPixels, error.promisedPixels);
}

}  // namespace

void addReferenceOptions(CLI::App& command, ReferenceOptions& options) {
    CLI::Option* const reference = command.add_flag(
        "--reference", options.isAsked,
        "Measure errors, too: hold frames against the full-resolution source by rays in double "
        "precision, and compare with uniform decimation. It judges what the camera itself sees, "
        "so it goes with --compound, but not with --config, --eye, --stereo, --canvas and "
        "--segment");
    command
        .add_option("--reference-frames", options.frames,
                    "How many of a flight's frames, one of each equal part of it")
        ->check(CLI::Range(1, 1000))
        ->needs(reference)
        ->capture_default_str();
    command
        .add_option(
            "--source", options.sources,
            "The source's files, all that follow up to the next option, where they are neither "
            "where they were imported from nor beside the import")
        ->needs(reference)
        ->type_name("FILE");
    command
        .add_option("--reference-memory", options.memory,
                    "What the source and the judged frames may take; 70 % of what is free "
                    "otherwise")
        ->needs(reference)
        ->type_name("BYTES");
}

absl::StatusOr<ReferencePlan> planReference(const RunPlan& plan, const ReferenceOptions& options,
                                            const std::stop_token& stop) {
    ReferencePlan reference;
    reference.frames = judgedOf(plan, options.frames);
    reference.judged = judgedFrames(reference.frames);
    ASSIGN_OR_RETURN(const ReferenceMemory memory, memoryOf(reference.frames, options));
    ASSIGN_OR_RETURN(const RemoteData remote, remoteDataOf(plan.pictures.drawing.cache));
    reference.remote = page::sourceOptions(remote.cacheFolder, remote.cacheBytes);
    ASSIGN_OR_RETURN(NamedScene named,
                     loadScene(std::span(&plan.scene, 1), plan.pictures.drawing.cache,
                               plan.pictures.quiet, stop));
    reference.scene = std::move(named.scene);
    ASSIGN_OR_RETURN(reference.sources,
                     findSources(reference.scene, options.sources, memory, reference.remote));
    return reference;
}

absl::StatusOr<std::vector<UniformLevel>> measureRuns(const ReferencePlan& reference,
                                                      const RunPlan& plan,
                                                      std::vector<BenchRun>& runs,
                                                      const std::stop_token& stop) {
    ProgressBar bar("reference", reference.frames.judged, "frames", progressStyle(plan));
    const import::Progress progress = bar.callback();
    ASSIGN_OR_RETURN(FlightJudge judge, judgeFor(reference, plan, stop));
    for (BenchRun& run : runs) {
        int done = 0;
        const auto frameDone = [&] { progress(run.label, ++done / judge.frames()); };
        ASSIGN_OR_RETURN(run.measured, measureRun(judge, plan, run, frameDone, stop));
    }
    RETURN_IF_ERROR(checkCompared(runs));
    int done = 0;
    const auto levelDone = [&] { progress("uniform decimation", 1 - std::ldexp(1.0, -++done)); };
    return uniformLevels(judge.reference(), measuredCameras(judge, runs), plan.play.request.width,
                         plan.play.request.height, largestP99(runs), levelDone, stop);
}

absl::Status checkPromises(const std::vector<BenchRun>& runs) {
    for (const BenchRun& run : runs) {
        if (!run.measured)
            continue;
        const auto broken = worstBroken(run.measured->frames);
        if (broken)
            return absl::InternalError(
                fmt::format("ERROR: the promise is broken at {}, second {:.3f} of the flight: {}",
                            run.label, broken->seconds, whatIsWrong(*broken)));
    }
    return absl::OkStatus();
}

}  // namespace eyrie::cli::bench
