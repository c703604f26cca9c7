// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/data_cache.h"
#include "cli/json_object.h"
#include "cli/progress_bar.h"
#include "cli/stop_signal.h"
#include "fabric/status.h"
#include "renderer/import/geotiff_writer.h"
#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_synth.h"
#include "renderer/import/ply_writer.h"
#include "renderer/import/terrain_import.h"
#include "renderer/import/terrain_synth.h"

namespace eyrie::cli {
namespace {

/// Posts a side: the grid is held in memory.
constexpr int kMaxPosts = 32768;

struct Options {
    std::uint64_t size = 0;
    std::uint64_t seed = 1;
    std::string out;
    bool quiet = false;
    bool json = false;
};

absl::Status wrongEnding(const std::string& out, std::string_view endings) {
    return absl::InvalidArgumentError(
        fmt::format("-o is '{}'; its name must end in {}", out, endings));
}

void report(const Options& options, std::string_view unit, std::uint64_t count) {
    const std::uint64_t bytes = std::filesystem::file_size(options.out);
    if (options.json)
        fmt::print(
            "{}\n",
            JsonObject().text("file", options.out).count(unit, count).count("bytes", bytes).str());
    else if (!options.quiet)
        fmt::print(stderr, "{}: {} {}, {:.1f} MB\n", options.out, count, unit,
                   static_cast<double>(bytes) / 1e6);
}

absl::Status synthTerrain(const Options& options) {
    StopSignal stop;
    const std::string ending = std::filesystem::path(options.out).extension().string();
    if (ending != ".tif" && ending != ".eyt")
        return wrongEnding(options.out, ".tif (a source) or .eyt (imported)");
    ProgressBar bar(options.out, static_cast<double>(options.size * options.size) / 1e6,
                    "M samples", ProgressBar::styleFor(options.quiet));
    const import::ImportControl control{bar.callback(), stop.token()};
    control.report("making", 0);
    const terrain::HeightGrid grid =
        import::synthesizeTerrain(static_cast<std::uint32_t>(options.size), options.seed);
    RETURN_IF_ERROR(control.check());
    control.report("writing", 0);
    if (ending == ".tif")
        RETURN_IF_ERROR(import::writeGeoTiff(grid, options.out));
    else
        RETURN_IF_ERROR(
            import::importTerrain(grid, {options.out, "", 0}, options.out, control).status());
    report(options, "samples", options.size * options.size);
    return absl::OkStatus();
}

absl::Status synthMesh(const Options& options) {
    StopSignal stop;
    const std::string ending = std::filesystem::path(options.out).extension().string();
    if (ending != ".ply" && ending != ".eym")
        return wrongEnding(options.out, ".ply (a source) or .eym (imported)");
    ProgressBar bar(options.out, static_cast<double>(options.size) / 1e6, "M triangles",
                    ProgressBar::styleFor(options.quiet));
    const import::ImportControl control{bar.callback(), stop.token()};
    control.report("making", 0);
    import::TriangleMesh mesh = import::synthesizeMesh(options.size, options.seed);
    const std::uint64_t triangles = mesh.triangles.size();
    RETURN_IF_ERROR(control.check());
    control.report("writing", 0);
    if (ending == ".ply")
        RETURN_IF_ERROR(import::writePly(mesh, options.out));
    else
        RETURN_IF_ERROR(import::importMesh(std::move(mesh), options.out, {}, control).status());
    report(options, "triangles", triangles);
    return absl::OkStatus();
}

CLI::App* addKind(CLI::App& parent, const char* name, const char* description, Run& run,
                  absl::Status (*make)(const Options&), double least, double most,
                  const char* sizeHelp) {
    auto options = std::make_shared<Options>();
    CLI::App* command = parent.add_subcommand(name, description);
    command->add_option("--size", options->size, sizeHelp)
        ->check(CLI::Range(least, most))
        ->required();
    command->add_option("--seed", options->seed, "The same seed makes the same data")
        ->capture_default_str();
    command->add_option("-o,--output", options->out, "File to write")
        ->type_name("FILE")
        ->required();
    command->add_flag("--quiet", options->quiet, "No progress");
    command->add_flag("--json", options->json, "Print what was made as JSON");
    command->callback([options, make, &run] { run = [options, make] { return make(*options); }; });
    return command;
}

}  // namespace

void addSynth(CLI::App& app, Run& run) {
    CLI::App* synth = app.add_subcommand("synth", "Make test data of any size");
    synth->require_subcommand(1);
    addKind(*synth, "terrain", "Mountains and valleys", run, synthTerrain, 2, kMaxPosts,
            "Posts a side, 30 m apart")
        ->footer("Example:\n  eyrie synth terrain --size 4096 --seed 1 -o big.tif");
    addKind(*synth, "mesh", "A closed bumpy ball", run, synthMesh, 8,
            static_cast<double>(import::kMaxSyntheticTriangles), "Triangles, about")
        ->footer("Example:\n  eyrie synth mesh --size 1000000 --seed 1 -o big.ply");
}

}  // namespace eyrie::cli
