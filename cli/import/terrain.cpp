// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/imagery_facts.h"
#include "cli/import/options.h"
#include "cli/json_object.h"
#include "cli/log.h"
#include "cli/progress_bar.h"
#include "cli/several_sources.h"
#include "cli/source_record.h"
#include "cli/stop_signal.h"
#include "cli/values.h"
#include "fabric/shown_name.h"
#include "fabric/status.h"
#include "renderer/import/mesh_reader.h"
#include "renderer/import/terrain_import.h"
#include "renderer/import/terrain_shard.h"

namespace eyrie::cli {
namespace {

struct TerrainOptions : ImportOptions {
    std::string memory = "512M";
    std::string scratch;
    std::vector<std::string> imagery;
    double errorMetres = 0;
    int threads = 0;
    bool fresh = false;
    std::string shard;
    bool merges = false;
};

/// Wall-clock seconds since it was made.
class StopWatch {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    }

private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

absl::StatusOr<import::TerrainImportOptions> importOptions(const TerrainOptions& options) {
    import::TerrainImportOptions result;
    ASSIGN_OR_RETURN(result.memoryBytes, parseBytes(options.memory, "--memory"));
    if (result.memoryBytes < import::kLeastImportMemory)
        return absl::InvalidArgumentError(
            fmt::format("--memory is {}; an import takes at least {}M", options.memory,
                        import::kLeastImportMemory >> 20));
    result.scratchFolder = options.scratch;
    result.imagery = options.imagery;
    if (std::isnan(options.errorMetres))  // which passes every check of a range
        return absl::InvalidArgumentError("--error is not a number; give metres, such as 0.5");
    if (options.errorMetres > 0)
        result.errorMetres = options.errorMetres;
    result.startsOver = options.fresh;
    result.threads = options.threads;
    result.mergesParts = options.merges;
    return result;
}

/// As anybody may see them.
std::vector<std::string> shown(std::vector<std::string> notes) {
    for (std::string& note : notes) note = fabric::shownName(note);
    return notes;
}

void printNotes(const TerrainOptions& options, const std::vector<std::string>& notes) {
    for (const std::string& note : notes)
        tell(fmt::format("{}: {}", titleOf(options.sources), note));
}

/// GDAL would say of a mesh that it is no raster, which nobody can mend who wants a mesh.
absl::Status checkFiles(const TerrainOptions& options) {
    RETURN_IF_ERROR(checkEnding(options, ".eyt"));
    for (const std::string& source : options.sources) {
        std::error_code error;
        if (import::isMeshSource(source) && std::filesystem::is_regular_file(source, error))
            return absl::InvalidArgumentError(
                fmt::format("{}: is a mesh by its name, and {} would be a terrain; import it with "
                            "`eyrie import mesh`, to a name that ends in .eym",
                            source, options.out));
    }
    return absl::OkStatus();
}

absl::Status importTerrain(const TerrainOptions& options) {
    StopSignal stop;
    RETURN_IF_ERROR(checkFiles(options));
    ASSIGN_OR_RETURN(const import::TerrainImportOptions how, importOptions(options));
    const StopWatch watch;
    absl::StatusOr<import::TerrainImportReport> made;
    {
        ProgressBar bar(titleOf(options.sources), megabytesOf(options.sources), "MB",
                        progressStyle(options));
        made = import::importTerrain(options.sources, options.out, how,
                                     {bar.callback(), stop.token()});
    }
    RETURN_IF_ERROR(made.status());
    RETURN_IF_ERROR(recordSources(options.out, options.sources));
    const auto samples =
        static_cast<std::uint64_t>(made->columns) * static_cast<std::uint64_t>(made->rows);
    if (options.json) {
        JsonObject json;
        json.text("file", options.out)
            .count("samples", samples)
            .count("levels", static_cast<std::uint64_t>(made->levels))
            .count("nodataSamples", made->nodataPosts)
            .count("bytes", made->sizeBytes)
            .object("errorMetres", JsonObject()
                                       .number("coarsest", made->coarsestErrorMetres)
                                       .number("finest", made->finestErrorMetres));
        if (made->imagery)
            json.object("imagery", imageryJson(*made->imagery));
        fmt::print(
            "{}\n",
            json.texts("notes", shown(made->notes)).number("seconds", watch.seconds()).str());
        return absl::OkStatus();
    }
    if (options.quiet)
        return absl::OkStatus();
    printNotes(options, made->notes);
    tell(fmt::format("{}: {} x {} samples, {} levels, {:.1f} MB, {:.2f} s", options.out,
                     made->columns, made->rows, made->levels,
                     static_cast<double>(made->sizeBytes) / 1e6, watch.seconds()));
    if (made->imagery)
        tell(fmt::format("{}: {}", options.out, imageryText(*made->imagery)));
    return absl::OkStatus();
}

absl::Status importShard(const TerrainOptions& options) {
    StopSignal stop;
    RETURN_IF_ERROR(checkFiles(options));
    ASSIGN_OR_RETURN(const ShardNumber shard,
                     parseShard(options.shard, import::kMaxShards, "--shard"));
    ASSIGN_OR_RETURN(const import::TerrainImportOptions how, importOptions(options));
    const StopWatch watch;
    absl::StatusOr<import::TerrainShardReport> made;
    {
        ProgressBar bar(titleOf(options.sources), megabytesOf(options.sources), "MB",
                        progressStyle(options));
        made = import::importTerrainShard(options.sources, options.out, {shard.index, shard.count},
                                          how, {bar.callback(), stop.token()});
    }
    RETURN_IF_ERROR(made.status());
    if (options.json) {
        fmt::print("{}\n", JsonObject()
                               .text("file", made->part)
                               .count("shard", shard.index)
                               .count("shards", shard.count)
                               .count("samples", made->posts)
                               .count("bytes", made->sizeBytes)
                               .texts("notes", shown(made->notes))
                               .number("seconds", watch.seconds())
                               .str());
        return absl::OkStatus();
    }
    if (options.quiet)
        return absl::OkStatus();
    printNotes(options, made->notes);
    if (made->wasThere)
        tell(fmt::format("{}: is there already", made->part));
    else
        tell(fmt::format(
            "{}: {} samples, {:.1f} MB, {:.2f} s; with all shards done, give the "
            "same command --merge instead of --shard",
            made->part, made->posts, static_cast<double>(made->sizeBytes) / 1e6, watch.seconds()));
    return absl::OkStatus();
}

}  // namespace

void addImportTerrain(CLI::App& parent, Run& run) {
    auto options = std::make_shared<TerrainOptions>();
    CLI::App* command = parent.add_subcommand("terrain", "Elevation models to .eyt");
    command
        ->add_option("sources", options->sources,
                     "Any rasters that GDAL reads, as many as you like: they become one terrain")
        ->type_name("FILE")
        ->required();
    command
        ->add_option(
            "--imagery", options->imagery,
            "Pictures to lay over it, all files that follow up to the next option, of any CRS and "
            "resolution. Where none has a pixel the terrain is tinted by height")
        ->type_name("FILE");
    addCommonOptions(*command, *options);
    command
        ->add_option("--error", options->errorMetres,
                     "Metres that heights of the finest level may be off; outlines of nodata stay "
                     "as they are. Without it, or with less than that, it is as exact as its "
                     "heights are stored; 1 saves much where posts are close and noisy")
        ->type_name("METRES")
        ->check(CLI::Range(1e-6, 1e6));
    command
        ->add_option("--memory", options->memory,
                     "About as much is used; the rest goes to a scratch file. Beyond some billion "
                     "posts it takes a byte for ten of them at least. Pictures that can only be "
                     "decoded whole, such as progressive JPEG and WebP, have to fit")
        ->type_name("BYTES")
        ->capture_default_str();
    command
        ->add_option(
            "--scratch", options->scratch,
            "Folder for that file (9 bytes a post, and with imagery 4/3 byte for each texel "
            "that a picture covers); beside the output otherwise")
        ->type_name("FOLDER")
        ->check(CLI::ExistingDirectory);
    command->add_option("--threads", options->threads, "0: as many as there are cores")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    command->add_flag("--fresh", options->fresh,
                      "Start over instead of going on with an interrupted import");
    CLI::Option* const shard =
        command
            ->add_option("--shard", options->shard,
                         "Do one of N shares of the work, I from 0 to N-1, and leave it in "
                         "OUTPUT.parts, a folder that all machines share; see below")
            ->type_name("I/N");
    command->add_flag("--merge", options->merges, "Make the output of the shares of all shards")
        ->excludes(shard);
    command->footer(
        "Several files are laid over each other: the finest wins, among equals the one named\n"
        "last; gaps stay open. Degrees become metres (in UTM where they are few), feet too.\n"
        "An import that did not fit in --memory and was stopped or killed goes on, with the same\n"
        "command, where it was: at most its last two stages or batches of tiles are made anew.\n"
        "A large one spreads over machines: run it with --shard 0/N to --shard N-1/N, at once or\n"
        "one after the other, then once with --merge, all with the same sources and options. The\n"
        "file is the one that a single machine would make. A share that was interrupted goes on\n"
        "with what it has read and measured, and makes all of its tiles anew.\n"
        "Examples:\n"
        "  eyrie import terrain dem.tif -o dem.eyt\n"
        "  eyrie import terrain tiles/*.tif survey.tif -o all.eyt\n"
        "  eyrie import terrain dem.tif --imagery ortho/*.tif -o dem.eyt\n"
        "  eyrie import terrain huge.vrt -o huge.eyt --memory 2G --scratch /fast/disk\n"
        "  eyrie import terrain huge.vrt -o /shared/huge.eyt --shard $JOB_COMPLETION_INDEX/16\n"
        "  eyrie import terrain huge.vrt -o /shared/huge.eyt --merge");
    command->callback([options, &run] {
        run = [options] {
            return options->shard.empty() ? importTerrain(*options) : importShard(*options);
        };
    });
}

}  // namespace eyrie::cli
