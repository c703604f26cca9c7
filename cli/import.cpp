// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/json_object.h"
#include "cli/progress_bar.h"
#include "cli/stop_signal.h"
#include "fabric/status.h"
#include "renderer/import/mesh_import.h"
#include "renderer/import/terrain_import.h"

namespace eyrie::cli {
namespace {

struct Options {
    std::string source;
    std::string out;
    bool quiet = false;
    bool json = false;
};

double sourceMegabytes(const Options& options) {
    std::error_code none;
    const auto bytes = std::filesystem::file_size(options.source, none);
    return none ? 0 : static_cast<double>(bytes) / 1e6;
}

/// Wall-clock seconds since it was made.
class StopWatch {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    }

private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

absl::Status checkEnding(const Options& options, std::string_view ending) {
    if (std::filesystem::path(options.out).extension() == ending)
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("-o is '{}'; its name must end in {}", options.out, ending));
}

absl::Status importTerrain(const Options& options) {
    StopSignal stop;
    RETURN_IF_ERROR(checkEnding(options, ".eyt"));
    const StopWatch watch;
    absl::StatusOr<import::TerrainImportReport> made;
    {
        ProgressBar bar(options.source, sourceMegabytes(options), "MB",
                        ProgressBar::styleFor(options.quiet));
        made = import::importTerrain({options.source}, options.out, {}, {bar.callback(), stop.token()});
    }
    RETURN_IF_ERROR(made.status());
    const auto samples =
        static_cast<std::uint64_t>(made->columns) * static_cast<std::uint64_t>(made->rows);
    if (options.json) {
        fmt::print("{}\n",
                   JsonObject()
                       .text("file", options.out)
                       .count("samples", samples)
                       .count("levels", static_cast<std::uint64_t>(made->levels))
                       .count("nodataSamples", made->nodataPosts)
                       .count("bytes", made->sizeBytes)
                       .object("errorMetres", JsonObject()
                                                  .number("coarsest", made->coarsestErrorMetres)
                                                  .number("finest", made->finestErrorMetres))
                       .number("seconds", watch.seconds())
                       .str());
        return absl::OkStatus();
    }
    if (options.quiet)
        return absl::OkStatus();
    for (const std::string& note : made->notes)
        fmt::print(stderr, "{}: {}\n", options.source, note);
    fmt::print(stderr, "{}: {} x {} samples, {} levels, {:.1f} MB, {:.2f} s\n", options.out,
               made->columns, made->rows, made->levels, static_cast<double>(made->sizeBytes) / 1e6,
               watch.seconds());
    return absl::OkStatus();
}

absl::Status importMesh(const Options& options) {
    StopSignal stop;
    RETURN_IF_ERROR(checkEnding(options, ".eym"));
    absl::StatusOr<import::MeshImportReport> made;
    {
        ProgressBar bar(options.source, sourceMegabytes(options), "MB",
                        ProgressBar::styleFor(options.quiet));
        made = import::importMesh(options.source, options.out, {}, {bar.callback(), stop.token()});
    }
    RETURN_IF_ERROR(made.status());
    if (options.json) {
        fmt::print("{}\n", JsonObject()
                               .text("file", options.out)
                               .count("triangles", made->triangles)
                               .count("vertices", made->vertices)
                               .count("droppedFaces", made->droppedFaces)
                               .count("degenerateTriangles", made->counts.degenerateTriangles)
                               .count("nodes", made->nodes)
                               .count("bytes", made->bytes)
                               .number("errorMetres", made->errorMetres)
                               .number("seconds", made->seconds.total)
                               .str());
        return absl::OkStatus();
    }
    if (options.quiet)
        return absl::OkStatus();
    if (made->droppedFaces + made->counts.degenerateTriangles > 0)
        fmt::print(stderr,
                   "{}: left out {} faces of fewer than three corners, {} triangles without area\n",
                   options.source, made->droppedFaces, made->counts.degenerateTriangles);
    fmt::print(stderr, "{}: {} triangles, {} vertices, {:.1f} MB, {:.2f} s\n", options.out,
               made->triangles, made->vertices, static_cast<double>(made->bytes) / 1e6,
               made->seconds.total);
    return absl::OkStatus();
}

CLI::App* addKind(CLI::App& parent, const char* name, const char* description, Run& run,
                  absl::Status (*work)(const Options&), const char* sourceHelp) {
    auto options = std::make_shared<Options>();
    CLI::App* command = parent.add_subcommand(name, description);
    command->add_option("source", options->source, sourceHelp)->type_name("FILE")->required();
    command->add_option("-o,--output", options->out, "File to write")
        ->type_name("FILE")
        ->required();
    command->add_flag("--quiet", options->quiet, "No progress");
    command->add_flag("--json", options->json, "Print what was made as JSON");
    command->callback([options, work, &run] { run = [options, work] { return work(*options); }; });
    return command;
}

}  // namespace

void addImport(CLI::App& app, Run& run) {
    CLI::App* command = app.add_subcommand("import", "Make data that renderers can draw");
    command->require_subcommand(1);
    addKind(*command, "terrain", "An elevation model to .eyt", run, importTerrain,
            "Any raster that GDAL reads")
        ->footer("Example:\n  eyrie import terrain dem.tif -o dem.eyt");
    addKind(*command, "mesh", "A polygon mesh to .eym", run, importMesh, "A .ply file")
        ->footer("Example:\n  eyrie import mesh scan.ply -o scan.eym");
}

}  // namespace eyrie::cli
