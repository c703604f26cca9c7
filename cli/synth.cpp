// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/data_cache.h"
#include "cli/json_object.h"
#include "cli/log.h"
#include "cli/options/whole_number.h"
#include "cli/output_reader.h"
#include "cli/own_places.h"
#include "cli/progress_bar.h"
#include "cli/stop_signal.h"
#include "fabric/status.h"
#include "renderer/import/geotiff_writer.h"
#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_reader.h"
#include "renderer/import/mesh_synth.h"
#include "renderer/import/ply_writer.h"
#include "renderer/import/terrain_import.h"
#include "renderer/import/terrain_synth.h"
#include "renderer/mesh/output_file.h"

namespace eyrie::cli {
namespace {

/// Posts a side: the grid is held in memory.
constexpr int kMaxPosts = 32768;

struct Options {
    std::uint64_t size = 0;
    std::uint64_t seed = 1;
    std::string from;
    double roughness = import::kScanRoughness;
    int subdivisions = 0;
    double displacementMetres = 0;
    std::string out;
    bool quiet = false;
    bool json = false;
};

absl::Status wrongEnding(const std::string& out, std::string_view endings) {
    return absl::InvalidArgumentError(
        fmt::format("-o is '{}'; its name must end in {}", out, endings));
}

void report(const Options& options, std::string_view unit, std::uint64_t count) {
    std::error_code isNoFile;  // but a pipe or a device
    const std::uint64_t size = std::filesystem::file_size(options.out, isNoFile);
    const std::uint64_t bytes = isNoFile ? 0 : size;
    if (options.json)
        fmt::print(
            "{}\n",
            JsonObject().text("file", options.out).count(unit, count).count("bytes", bytes).str());
    else if (!options.quiet)
        tell(fmt::format("{}: {} {}, {:.1f} MB", options.out, count, unit,
                         static_cast<double>(bytes) / 1e6));
}

absl::Status synthTerrain(const Options& options) {
    StopSignal stop;
    const std::string ending = std::filesystem::path(options.out).extension().string();
    if (ending != ".tif" && ending != ".eyt")
        return wrongEnding(options.out, ".tif (a source) or .eyt (imported)");
    RETURN_IF_ERROR(mesh::OutputFile::check(options.out));
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

bool isFinite(const fabric::Vec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

absl::StatusOr<import::TriangleMesh> makeMesh(const Options& options,
                                              const import::ImportControl& control) {
    if (options.from.empty())
        return import::synthesizeMesh(options.size, options.seed, options.roughness);
    ASSIGN_OR_RETURN(import::TriangleMesh source, import::readMesh(options.from, control));
    RETURN_IF_ERROR(control.check());
    ASSIGN_OR_RETURN(import::TriangleMesh mesh,
                     import::subdivide(std::move(source), options.subdivisions));
    if (options.displacementMetres == 0)
        return mesh;
    import::displace(mesh, options.displacementMetres, options.seed);
    if (!std::ranges::all_of(mesh.positions, isFinite))
        return absl::InvalidArgumentError(
            fmt::format("--displace is {} m: what comes of {} is larger than coordinates of 32 "
                        "bits can say; ask for less",
                        options.displacementMetres, options.from));
    return mesh;
}

absl::Status synthMesh(const Options& options) {
    if ((options.size == 0) == options.from.empty())
        return absl::InvalidArgumentError("expected either --size or --from; name one");
    if (!std::isfinite(options.roughness))
        return absl::InvalidArgumentError(
            fmt::format("--roughness is {}; expected a number from 0 to 0.5", options.roughness));
    if (!std::isfinite(options.displacementMetres))
        return absl::InvalidArgumentError(
            fmt::format("--displace is {}; expected a length in metres, such as 0.001",
                        options.displacementMetres));
    StopSignal stop;
    const std::string ending = std::filesystem::path(options.out).extension().string();
    if (ending != ".ply" && ending != ".eym")
        return wrongEnding(options.out, ".ply (a source) or .eym (imported)");
    RETURN_IF_ERROR(checkOwnPlaces(std::array{NamedFile{"-o", options.out}},
                                   std::array{NamedFile{"--from", options.from}}));
    RETURN_IF_ERROR(mesh::OutputFile::check(options.out));
    ASSIGN_OR_RETURN(const OutputReader reader, OutputReader::await(options.out, stop.token()));
    ProgressBar bar(options.out, static_cast<double>(options.size) / 1e6, "M triangles",
                    ProgressBar::styleFor(options.quiet));
    const import::ImportControl control{bar.callback(), stop.token()};
    control.report("making", 0);
    ASSIGN_OR_RETURN(import::TriangleMesh mesh, makeMesh(options, control));
    const std::uint64_t triangles = mesh.triangles.size();
    RETURN_IF_ERROR(control.check());
    control.report("writing", 0);
    if (ending == ".ply")
        RETURN_IF_ERROR(import::writePly(mesh, options.out, stop.token()));
    else
        RETURN_IF_ERROR(import::importMesh(std::move(mesh), options.out, {}, control).status());
    report(options, "triangles", triangles);
    return absl::OkStatus();
}

struct Kind {
    CLI::App* command;
    std::shared_ptr<Options> options;
};

/// What it shares with imports says of itself that an import, or writing, was cancelled.
absl::Status inItsOwnWords(const absl::Status& status) {
    return absl::IsCancelled(status) ? absl::CancelledError("stopped") : status;
}

Kind addKind(CLI::App& parent, const char* name, const char* description, Run& run,
             absl::Status (*make)(const Options&), double least, double most,
             const char* sizeHelp) {
    auto options = std::make_shared<Options>();
    CLI::App* command = parent.add_subcommand(name, description);
    command->add_option("--size", options->size, sizeHelp)->check(CLI::Range(least, most));
    command->add_option("--seed", options->seed, "The same seed makes the same data")
        ->transform(wholeNumber())
        ->capture_default_str();
    command->add_option("-o,--output", options->out, "File to write")
        ->type_name("FILE")
        ->required();
    command->add_flag("--quiet", options->quiet,
                      "No progress, and nothing of what was made: only errors");
    command->add_flag("--json", options->json, "Print what was made as JSON");
    command->callback(
        [options, make, &run] { run = [options, make] { return inItsOwnWords(make(*options)); }; });
    return {command, options};
}

}  // namespace

void addSynth(CLI::App& app, Run& run) {
    CLI::App* synth = app.add_subcommand("synth", "Make test data of any size");
    synth->require_subcommand(1);
    const Kind terrain = addKind(*synth, "terrain", "Mountains and valleys", run, synthTerrain, 2,
                                 kMaxPosts, "Posts a side, 30 m apart");
    terrain.command->get_option("--size")->required();
    terrain.command->footer("Example:\n  eyrie synth terrain --size 4096 --seed 1 -o big.tif");
    const Kind mesh = addKind(*synth, "mesh", "A closed bumpy ball, or a mesh made larger", run,
                              synthMesh, 8, static_cast<double>(import::kMaxSyntheticTriangles),
                              "Triangles of the ball, about");
    CLI::Option* const from =
        mesh.command->add_option("--from", mesh.options->from, "Mesh to take instead of the ball")
            ->type_name("FILE");
    mesh.command
        ->add_option("--roughness", mesh.options->roughness,
                     fmt::format("How high the ball's bumps are beside those of twice their width; "
                                 "{} is as steep at every size, which simplifies badly",
                                 import::kEvenRoughness))
        ->check(CLI::Range(0.0, 0.5))
        ->capture_default_str()
        ->excludes(from);
    mesh.command
        ->add_option("--subdivide", mesh.options->subdivisions,
                     "Times to cut each of its triangles into four")
        ->check(CLI::Range(0, 8))
        ->needs("--from");
    mesh.command
        ->add_option("--displace", mesh.options->displacementMetres,
                     "Noise to add to it, in metres")
        ->check(CLI::NonNegativeNumber)
        ->needs("--from");
    mesh.command->footer(
        "Examples:\n  eyrie synth mesh --size 1000000 --seed 1 -o big.ply\n  eyrie synth mesh "
        "--from scan.ply --subdivide 2 --displace 0.00005 -o big.ply");
}

}  // namespace eyrie::cli
