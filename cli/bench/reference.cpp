// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/reference.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "cli/bench/resident_memory.h"
#include "cli/values.h"
#include "fabric/status.h"

namespace eyrie::cli::bench {
namespace {

absl::StatusOr<std::uint64_t> memoryOf(const ReferenceOptions& options) {
    if (options.memory.empty())
        return static_cast<std::uint64_t>(kShareOfMemory * static_cast<double>(availableBytes()));
    return parseBytes(options.memory, "--reference-memory");
}

}  // namespace

void addReferenceOptions(CLI::App& command, ReferenceOptions& options) {
    CLI::Option* const reference = command.add_flag(
        "--reference", options.isAsked,
        "Measure errors, too: hold frames against the full-resolution source by rays in double "
        "precision, and compare with uniform decimation");
    command
        .add_option("--reference-frames", options.frames,
                    "How many of a flight's frames, evenly spread")
        ->check(CLI::Range(1, 1000))
        ->needs(reference)
        ->capture_default_str();
    command
        .add_option("--source", options.sources,
                    "The source's files, where they are neither where they were imported from nor "
                    "beside the import")
        ->needs(reference)
        ->type_name("FILE");
    command
        .add_option("--reference-memory", options.memory,
                    "What the source may take; 70 % of what is free otherwise")
        ->needs(reference)
        ->type_name("BYTES");
}

absl::StatusOr<ReferencePlan> planReference(const std::string& scene,
                                            const PictureSourceOptions& pictures,
                                            const ReferenceOptions& options,
                                            const std::stop_token& stop) {
    ReferencePlan plan;
    ASSIGN_OR_RETURN(const std::uint64_t memory, memoryOf(options));
    ASSIGN_OR_RETURN(const RemoteData remote, remoteDataOf(pictures.cache));
    plan.remote = page::sourceOptions(remote.cacheFolder, remote.cacheBytes);
    ASSIGN_OR_RETURN(plan.scene, loadScene(scene, pictures, stop));
    ASSIGN_OR_RETURN(plan.sources, findSources(plan.scene, options.sources, memory, plan.remote));
    return plan;
}

absl::StatusOr<FlightJudge> judgeFor(const ReferencePlan& plan, const fabric::Flight& flight,
                                     const JudgedFrames& frames) {
    ASSIGN_OR_RETURN(ReferenceScene reference, readSources(plan.scene, plan.sources));
    return FlightJudge(std::move(reference), flight, frames, plan.remote);
}

absl::Status checkPromise(double tauPixels, const MeasuredErrors& measured) {
    const auto beyond = [](const FrameError& error) {
        return error.maxPixels - error.promisedPixels;
    };
    const auto worst = std::ranges::max_element(measured.frames, {}, beyond);
    if (worst == measured.frames.end() || keepsPromise(*worst))
        return absl::OkStatus();
    return absl::InternalError(fmt::format(
        "ERROR: the promise is broken at tau {} px, second {:.3f} of the flight: a surface is "
        "{:.4f} px from where the source has it, and {:.4f} px were promised",
        tauPixels, worst->seconds, worst->maxPixels, worst->promisedPixels));
}

}  // namespace eyrie::cli::bench
