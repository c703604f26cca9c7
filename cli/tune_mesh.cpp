// SPDX-License-Identifier: Apache-2.0
#include "cli/tune_mesh.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "cli/bench/flights.h"
#include "cli/bench/play.h"
#include "cli/bench/run_summary.h"
#include "cli/picture_source.h"
#include "fabric/status.h"
#include "renderer/mesh/tuned_leaf.h"
#include "renderer/renderer.h"

namespace eyrie::cli {
namespace {

constexpr std::size_t kRounds = 3;
constexpr int kFrames = 24;
constexpr double kEqual = 1.03;

/// For what is tried, on the disk of the output, so that the best is only renamed.
class FolderBeside {
public:
    static absl::StatusOr<FolderBeside> create(const std::string& outPath) {
        const std::filesystem::path path = fmt::format("{}.tuning-{}", outPath, getpid());
        std::error_code error;
        std::filesystem::create_directory(path, error);
        if (error)
            return fabric::writeError(path.string(), "cannot make the folder", error.value());
        return FolderBeside(path);
    }
    FolderBeside(FolderBeside&& other) noexcept : path_(std::exchange(other.path_, {})) {}
    FolderBeside& operator=(FolderBeside&&) = delete;
    ~FolderBeside() {
        std::error_code ignored;
        if (!path_.empty())
            std::filesystem::remove_all(path_, ignored);
    }

    std::string file(std::uint32_t leafTriangles) const {
        return (path_ / fmt::format("{}.eym", leafTriangles)).string();
    }

private:
    explicit FolderBeside(std::filesystem::path path) : path_(std::move(path)) {}

    std::filesystem::path path_;
};

absl::StatusOr<bench::Played> playOnce(const std::string& path, const bench::NamedFlight& flight,
                                       const std::stop_token& stop) {
    PictureSourceOptions quiet;
    quiet.quiet = true;
    ASSIGN_OR_RETURN(const auto pictures, PictureSource::open(path, quiet, stop));
    ASSIGN_OR_RETURN(const fabric::CameraPath way, flight.over(pictures->sceneInfo().bounds));
    bench::PlayOptions once;
    once.frames = kFrames;
    once.repeats = 1;
    return bench::play(
        *pictures, way.flight, once, [] {}, stop);
}

/// What else the machine does only ever adds to frames: of the rounds' medians the least counts.
void add(const bench::Played& round, TriedLeaf& tried) {
    const bench::RunSummary summary = bench::summarize(round);
    if (tried.medianMs > 0 && tried.medianMs <= summary.frame.p50)
        return;
    tried.medianMs = summary.frame.p50;
    tried.trianglesMean = summary.trianglesMean;
    tried.promisedPixels = summary.tauAchievedMax;
    tried.limitingStage = fabric::limitingStage(summary.stages);
}

absl::Status keep(const std::string& from, std::uint32_t leafTriangles, const std::string& to) {
    RETURN_IF_ERROR(mesh::recordTunedLeaf(from, leafTriangles));
    std::error_code error;
    std::filesystem::rename(from, to, error);
    return error ? fabric::writeError(to, "cannot be put there", error.value()) : absl::OkStatus();
}

}  // namespace

std::size_t bestOf(const std::vector<TriedLeaf>& tried) {
    const auto fastest = std::ranges::min_element(tried, {}, &TriedLeaf::medianMs);
    auto best = fastest;
    for (auto one = tried.begin(); one != tried.end(); ++one)
        if (one->medianMs <= kEqual * fastest->medianMs && one->report.bytes < best->report.bytes)
            best = one;
    return static_cast<std::size_t>(best - tried.begin());
}

absl::StatusOr<MeshTuning> tuneMesh(const std::string& outPath, const bench::NamedFlight& flight,
                                    const ImportLeaf& importLeaf,
                                    const std::function<void(std::string_view, double)>& done,
                                    const std::stop_token& stop) {
    // A flight that is none, or a machine that cannot draw, is told before anything is imported.
    RETURN_IF_ERROR(Renderer::create({}).status());
    RETURN_IF_ERROR(flight.over({{0, 0, 0}, {1, 1, 1}}).status());
    ASSIGN_OR_RETURN(const FolderBeside folder, FolderBeside::create(outPath));
    MeshTuning tuning;
    for (const std::uint32_t leafTriangles : kTriedLeafTriangles) {
        TriedLeaf& tried = tuning.tried.emplace_back();
        tried.leafTriangles = leafTriangles;
        ASSIGN_OR_RETURN(tried.report, importLeaf(leafTriangles, folder.file(leafTriangles)));
        if (tried.report.triangles <= leafTriangles)
            break;
    }
    // In turn, so that what else the machine does falls to all alike.
    const std::size_t count = tuning.tried.size();
    for (std::size_t i = 0; i < kRounds * count; ++i) {
        TriedLeaf& tried = tuning.tried[i % count];
        done("measuring", static_cast<double>(i) / static_cast<double>(kRounds * count));
        ASSIGN_OR_RETURN(const bench::Played round,
                         playOnce(folder.file(tried.leafTriangles), flight, stop));
        add(round, tried);
    }
    done("measuring", 1);
    tuning.best = bestOf(tuning.tried);
    const std::uint32_t best = tuning.tried[tuning.best].leafTriangles;
    RETURN_IF_ERROR(keep(folder.file(best), best, outPath));
    return tuning;
}

std::string table(const MeshTuning& tuning) {
    std::string text = "leaf size  median ms  triangles  file MB  promised px  limited by\n";
    for (std::size_t i = 0; i < tuning.tried.size(); ++i) {
        const TriedLeaf& one = tuning.tried[i];
        text += fmt::format("{:>9}  {:>9.2f}  {:>9.0f}  {:>7.2f}  {:>11.3f}  {:<10}{}\n",
                            one.leafTriangles, one.medianMs, one.trianglesMean,
                            static_cast<double>(one.report.bytes) / 1e6, one.promisedPixels,
                            one.limitingStage, i == tuning.best ? "  kept" : "");
    }
    return text;
}

}  // namespace eyrie::cli
