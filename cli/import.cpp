// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "cli/commands.h"
#include "cli/imagery_facts.h"
#include "cli/json_object.h"
#include "cli/progress_bar.h"
#include "cli/source_record.h"
#include "cli/stop_signal.h"
#include "cli/tune_mesh.h"
#include "cli/values.h"
#include "fabric/status.h"
#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_reader.h"
#include "renderer/import/terrain_import.h"
#include "renderer/import/terrain_shard.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/mesh/output_file.h"

namespace eyrie::cli {
namespace {

struct Options {
    std::vector<std::string> sources;
    std::string out;
    bool quiet = false;
    bool json = false;

    /// For the progress bar and messages.
    std::string title() const {
        return sources.size() == 1
                   ? sources.front()
                   : fmt::format("{} and {} more", sources.front(), sources.size() - 1);
    }
};

struct TerrainOptions : Options {
    std::string memory = "512M";
    std::string scratch;
    std::vector<std::string> imagery;
    double errorMetres = 0;
    int threads = 0;
    bool fresh = false;
    std::string shard;
    bool merges = false;
};

struct MeshOptions : Options {
    import::MeshImportOptions how;
    std::string normals = "smooth";
    std::string memory;
    std::string flight;  ///< to tune for; empty: the leaf size is `how`'s
};

double sourceMegabytes(const Options& options) {
    double megabytes = 0;
    for (const std::string& source : options.sources) {
        std::error_code none;
        const auto bytes = std::filesystem::file_size(source, none);
        megabytes += none ? 0 : static_cast<double>(bytes) / 1e6;
    }
    return megabytes;
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

absl::Status importTerrain(const TerrainOptions& options) {
    StopSignal stop;
    RETURN_IF_ERROR(checkEnding(options, ".eyt"));
    ASSIGN_OR_RETURN(const import::TerrainImportOptions how, importOptions(options));
    const StopWatch watch;
    absl::StatusOr<import::TerrainImportReport> made;
    {
        ProgressBar bar(options.title(), sourceMegabytes(options), "MB",
                        ProgressBar::styleFor(options.quiet));
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
        fmt::print("{}\n", json.number("seconds", watch.seconds()).str());
        return absl::OkStatus();
    }
    if (options.quiet)
        return absl::OkStatus();
    for (const std::string& note : made->notes)
        fmt::print(stderr, "{}: {}\n", options.title(), note);
    fmt::print(stderr, "{}: {} x {} samples, {} levels, {:.1f} MB, {:.2f} s\n", options.out,
               made->columns, made->rows, made->levels, static_cast<double>(made->sizeBytes) / 1e6,
               watch.seconds());
    if (made->imagery)
        fmt::print(stderr, "{}: {}\n", options.out, imageryText(*made->imagery));
    return absl::OkStatus();
}

absl::Status importShard(const TerrainOptions& options) {
    StopSignal stop;
    RETURN_IF_ERROR(checkEnding(options, ".eyt"));
    ASSIGN_OR_RETURN(const ShardNumber shard,
                     parseShard(options.shard, import::kMaxShards, "--shard"));
    ASSIGN_OR_RETURN(const import::TerrainImportOptions how, importOptions(options));
    const StopWatch watch;
    absl::StatusOr<import::TerrainShardReport> made;
    {
        ProgressBar bar(options.title(), sourceMegabytes(options), "MB",
                        ProgressBar::styleFor(options.quiet));
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
                               .number("seconds", watch.seconds())
                               .str());
        return absl::OkStatus();
    }
    if (options.quiet)
        return absl::OkStatus();
    if (made->wasThere)
        fmt::print(stderr, "{}: is there already\n", made->part);
    else
        fmt::print(stderr,
                   "{}: {} samples, {:.1f} MB, {:.2f} s; with all shards done, give the "
                   "same command --merge instead of --shard\n",
                   made->part, made->posts, static_cast<double>(made->sizeBytes) / 1e6,
                   watch.seconds());
    return absl::OkStatus();
}

std::vector<JsonObject> levelsJson(const import::MeshImportReport& made) {
    std::vector<JsonObject> levels;
    for (const mesh::LodLevel& level : made.levels)
        levels.push_back(JsonObject()
                             .count("nodes", level.nodes)
                             .count("triangles", level.trianglesAfter)
                             .number("errorMetres", level.largestErrorMetres)
                             .number("borderShare", level.borderShare));
    return levels;
}

/// Half of what this machine has, or of what its control group may use.
std::uint64_t halfOfMemory() {
    std::uint64_t bytes = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
                          static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    for (const char* const file :
         {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
        if (std::uint64_t limit = 0; std::ifstream(file) >> limit)  // no number: no limit
            bytes = std::min(bytes, limit);
    return std::max(bytes / 2, import::kLeastMeshMemory);
}

absl::StatusOr<std::uint64_t> memoryOf(const MeshOptions& options) {
    if (options.memory.empty())
        return halfOfMemory();
    ASSIGN_OR_RETURN(const std::uint64_t bytes, parseBytes(options.memory, "--memory"));
    if (bytes < import::kLeastMeshMemory)
        return absl::InvalidArgumentError(
            fmt::format("--memory is {}; the import of a mesh takes at least {}M", options.memory,
                        import::kLeastMeshMemory >> 20));
    return bytes;
}

absl::StatusOr<import::MeshImportOptions> importOptions(const MeshOptions& options) {
    constexpr std::string_view kCrease = "crease=";
    import::MeshImportOptions result = options.how;
    ASSIGN_OR_RETURN(result.memoryBytes, memoryOf(options));
    if (options.normals == "smooth")
        return result;
    if (options.normals == "file") {
        result.pack.normals = import::NormalSource::File;
        return result;
    }
    const std::string_view degrees(options.normals);
    const char* const end = degrees.data() + degrees.size();
    result.pack.normals = import::NormalSource::Crease;
    if (degrees.starts_with(kCrease)) {
        const auto [rest, error] =
            std::from_chars(degrees.data() + kCrease.size(), end, result.pack.creaseDegrees);
        if (error == std::errc() && rest == end && result.pack.creaseDegrees >= 0 &&
            result.pack.creaseDegrees <= 180)
            return result;
    }
    return absl::InvalidArgumentError(
        fmt::format("--normals is '{}'; give smooth, file, or crease= and degrees from 0 to 180, "
                    "such as crease=40",
                    options.normals));
}

absl::StatusOr<import::MeshImportReport> importMeshTo(const std::string& path,
                                                      const MeshOptions& options,
                                                      const import::MeshImportOptions& how,
                                                      const std::stop_token& stop) {
    ProgressBar bar(options.title(), sourceMegabytes(options), "MB",
                    ProgressBar::styleFor(options.quiet));
    return import::importMesh(options.sources, path, how, {bar.callback(), stop});
}

absl::StatusOr<MeshTuning> importTuned(const MeshOptions& options,
                                       const import::MeshImportOptions& how,
                                       const std::stop_token& stop) {
    RETURN_IF_ERROR(mesh::OutputFile::create(options.out).status());
    ProgressBar bar(options.out, 0, "", ProgressBar::styleFor(options.quiet));
    return tuneMesh(
        options.out, options.flight,
        [&](std::uint32_t leafTriangles, const std::string& path) {
            import::MeshImportOptions each = how;
            each.leafTriangles = leafTriangles;
            return importMeshTo(path, options, each, stop);
        },
        bar.callback(), stop);
}

std::vector<JsonObject> tuningJson(const MeshTuning& tuning) {
    std::vector<JsonObject> tried;
    for (const TriedLeaf& one : tuning.tried)
        tried.push_back(JsonObject()
                            .count("leafTriangles", one.leafTriangles)
                            .number("frameMs", one.medianMs)
                            .number("trianglesMean", one.trianglesMean)
                            .number("tauAchievedMax", one.promisedPixels)
                            .count("bytes", one.report.bytes)
                            .text("limitingStage", one.limitingStage));
    return tried;
}

void printJson(const MeshOptions& options, const import::MeshImportReport& made,
               const MeshTuning& tuning) {
    JsonObject json;
    json.text("file", options.out)
        .count("triangles", made.triangles)
        .count("vertices", made.vertices)
        .count("droppedFaces", made.droppedFaces)
        .count("degenerateTriangles", made.counts.degenerateTriangles)
        .count("duplicateTriangles", made.counts.duplicateTriangles)
        .count("turnedTriangles", made.counts.orient.turnedTriangles)
        .count("nodes", made.nodes)
        .count("bytes", made.bytes)
        .number("stepMetres", made.stepMetres)
        .number("errorMetres", made.errorMetres)
        .objects("simplified", levelsJson(made))
        .number("seconds", made.seconds.total);
    if (!tuning.tried.empty())
        json.objects("tuned", tuningJson(tuning));
    fmt::print("{}\n", json.str());
}

void printText(const MeshOptions& options, const import::MeshImportReport& made) {
    for (const std::string& note : made.notes)
        fmt::print(stderr, "{}: {}\n", options.title(), note);
    const import::PackCounts& counts = made.counts;
    if (made.droppedFaces + counts.degenerateTriangles + counts.duplicateTriangles > 0)
        fmt::print(stderr,
                   "{}: left out {} faces of fewer than three corners, {} triangles without area, "
                   "{} that were there already\n",
                   options.title(), made.droppedFaces, counts.degenerateTriangles,
                   counts.duplicateTriangles);
    if (options.how.pack.orients)
        fmt::print(stderr, "{}: turned {} triangles of {} surfaces, {} of which are closed\n",
                   options.title(), counts.orient.turnedTriangles, counts.orient.components,
                   counts.orient.closedComponents);
    fmt::print(stderr, "{}: {} triangles, {} vertices, {} simpler levels, {:.1f} MB, {:.2f} s\n",
               options.out, made.triangles, made.vertices, made.levels.size(),
               static_cast<double>(made.bytes) / 1e6, made.seconds.total);
}

absl::Status importMesh(const MeshOptions& options) {
    StopSignal stop;
    RETURN_IF_ERROR(checkEnding(options, ".eym"));
    ASSIGN_OR_RETURN(const import::MeshImportOptions how, importOptions(options));
    MeshTuning tuning;
    import::MeshImportReport made;
    if (options.flight.empty()) {
        ASSIGN_OR_RETURN(made, importMeshTo(options.out, options, how, stop.token()));
    } else {
        ASSIGN_OR_RETURN(tuning, importTuned(options, how, stop.token()));
        made = tuning.tried[tuning.best].report;
    }
    RETURN_IF_ERROR(recordSources(options.out, options.sources));
    if (options.json) {
        printJson(options, made, tuning);
    } else if (!options.quiet) {
        if (!tuning.tried.empty())
            fmt::print(stderr, "{}", table(tuning));
        printText(options, made);
    }
    return absl::OkStatus();
}

void addCommon(CLI::App& command, Options& options) {
    command.add_option("-o,--output", options.out, "File to write")->type_name("FILE")->required();
    command.add_flag("--quiet", options.quiet, "No progress");
    command.add_flag("--json", options.json, "Print what was made as JSON");
}

void addMesh(CLI::App& parent, Run& run) {
    auto options = std::make_shared<MeshOptions>();
    CLI::App* command = parent.add_subcommand("mesh", "A polygon mesh to .eym");
    command
        ->add_option(
            "sources", options->sources,
            fmt::format("Mesh files, as many as you like: they become one mesh. Read are {}",
                        import::meshSourceEndings()))
        ->type_name("FILE")
        ->required();
    command
        ->add_option("--normals", options->normals,
                     "smooth: means around vertices; crease=DEGREES: sharper edges stay sharp; "
                     "file: the source's own, smooth where it has none")
        ->type_name("WHICH")
        ->capture_default_str();
    command->add_flag("--orient", options->how.pack.orients,
                      "Turn faces so that neighbours wind the same way, closed surfaces outward");
    CLI::Option* const leaf =
        command
            ->add_option("--leaf", options->how.leafTriangles,
                         "Triangles that are drawn, or left out as hidden, at once at most")
            ->check(CLI::Range(std::uint32_t{1}, mesh::kMaxLeafVertices))
            ->capture_default_str();
    command
        ->add_option("--tune", options->flight,
                     "Choose --leaf by measuring on this machine: import with 4096, 8192, 16384 "
                     "and 32768, play a flight (as for `eyrie bench`) over each, keep the fastest. "
                     "The triangles of a batch are what --leaf makes them")
        ->type_name("NAME|FILE")
        ->excludes(leaf);
    addCommon(*command, *options);
    command
        ->add_option("--bits", options->how.pack.latticeBits,
                     "Bits of a coordinate: positions are rounded to a power of two, of which the "
                     "longest side has 2^(bits-1) or more. Fewer make a smaller file; what they "
                     "round is in the error that is promised")
        ->check(CLI::Range(mesh::kMinLatticeBits, mesh::kLatticeBits))
        ->capture_default_str();
    command->add_flag("--raw", options->how.isRaw,
                      "Leave pages uncoded, to be mapped: the file is three times as large, and "
                      "nothing is decoded");
    command->add_flag("--lossless", options->how.pack.keepsExact,
                      "Keep the source's own positions, bit for bit, beside those that are drawn");
    command
        ->add_option("--memory", options->memory,
                     "About as much is used; half of what there is otherwise. A PLY mesh that "
                     "would take more is imported part by part; see below")
        ->type_name("BYTES");
    command->footer(
        "By parts, what does not fit --memory goes to files without a name beside the output: "
        "about\n"
        "150 bytes a triangle, gone when the import ends or is stopped. The .eym is the same. "
        "Faces\n"
        "must be triangles then, and --orient needs all of a mesh at once. Files other than PLY "
        "are\n"
        "read as a whole, and refused where that would take more.\n"
        "Examples:\n"
        "  eyrie import mesh scan.ply -o scan.eym\n"
        "  eyrie import mesh huge.ply -o huge.eym --memory 2G\n"
        "  eyrie import mesh scan.ply --bits 17 -o small.eym\n"
        "  eyrie import mesh scan.ply --tune orbit -o scan.eym\n"
        "  eyrie import mesh house.obj garden.glb -o place.eym --orient --normals crease=40");
    command->callback([options, &run] { run = [options] { return importMesh(*options); }; });
}

void addTerrain(CLI::App& parent, Run& run) {
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
            "Pictures to lay over it, as many as you like, of any CRS and resolution. Where "
            "none has a pixel the terrain is tinted by height")
        ->type_name("FILE");
    addCommon(*command, *options);
    command
        ->add_option("--error", options->errorMetres,
                     "Metres that the finest level may be off. Without it, it is as exact as "
                     "its heights are stored; 1 saves much where posts are close and noisy")
        ->type_name("METRES")
        ->check(CLI::Range(1e-6, 1e6));
    command
        ->add_option("--memory", options->memory,
                     "About as much is used, whatever the size; the rest goes to a scratch file")
        ->type_name("BYTES")
        ->capture_default_str();
    command
        ->add_option("--scratch", options->scratch,
                     "Folder for that file (9 bytes a post); beside the output otherwise")
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
        "last; gaps stay open. Degrees become metres (UTM), feet too.\n"
        "An import that is stopped or killed goes on when the same command is run again.\n"
        "A large one spreads over machines: run it with --shard 0/N to --shard N-1/N, at once or\n"
        "one after the other, then once with --merge, all with the same sources and options. The\n"
        "file is the one that a single machine would make.\n"
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

}  // namespace

void addImport(CLI::App& app, Run& run) {
    CLI::App* command = app.add_subcommand("import", "Make data that renderers can draw");
    command->require_subcommand(1);
    addTerrain(*command, run);
    addMesh(*command, run);
}

}  // namespace eyrie::cli
