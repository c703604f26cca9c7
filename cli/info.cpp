// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/bound_text.h"
#include "cli/cache_options.h"
#include "cli/commands.h"
#include "cli/crs_notes.h"
#include "cli/data_cache.h"
#include "cli/imagery_facts.h"
#include "cli/json_object.h"
#include "cli/scene_files.h"
#include "fabric/shown_name.h"
#include "fabric/status.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/page/remote_name.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::cli {
namespace {

/// What a data file says of itself.
struct Facts {
    std::string kind;
    fabric::Box bounds;
    std::string unit;  ///< what `count` counts
    std::uint64_t count = 0;
    std::uint64_t triangles = 0;
    int levels = 0;
    std::string crs;
    std::uint64_t bytes = 0;
    double coarsestErrorMetres = 0;
    double finestErrorMetres = 0;
    /// Of meshes with colours, by level from the coarsest; none without.
    std::vector<double> colourReachMetres = {};
    /// Of meshes, by level from the coarsest: mesh::Node's of the same names.
    std::vector<double> normalErrorDegrees = {};
    std::vector<double> normalErrorMeanDegrees = {};
    std::uint64_t tunedLeafTriangles = 0;  ///< of meshes; 0: not tuned
    std::optional<terrain::ImagerySummary> imagery;
    std::uint64_t materials = 0;  ///< of a mesh, that are more than a colour
    std::uint64_t textures = 0;
    double textureRmsError = 0;  ///< of the worst of them, of 255
    std::uint64_t lights = 0;    ///< of a mesh
};

absl::StatusOr<Facts> terrainFacts(const std::string& path, const page::SourceOptions& sources) {
    ASSIGN_OR_RETURN(const auto file, terrain::EytFile::open(path, sources));
    const terrain::EytIndex& index = file->index();
    const terrain::Quadtree& tree = index.quadtree;
    return Facts{.kind = "terrain",
                 .bounds = index.bounds(),
                 .unit = "samples",
                 .count = static_cast<std::uint64_t>(tree.columns()) *
                          static_cast<std::uint64_t>(tree.rows()),
                 .triangles = index.triangles(),
                 .levels = tree.levels(),
                 .crs = index.crsWkt,
                 .bytes = file->sizeBytes(),
                 .coarsestErrorMetres = index.coarsestErrorMetres(),
                 .finestErrorMetres = index.finestErrorMetres(),
                 .imagery = index.imagery ? std::optional(terrain::summaryOf(*index.imagery))
                                          : std::nullopt};
}

/// The most of a level's nodes, from the root down.
template <typename ValueOf>
std::vector<double> byLevel(const mesh::EymFile& file, const ValueOf& valueOf) {
    std::vector<double> most(static_cast<std::size_t>(file.levels()));
    std::vector<std::pair<std::uint32_t, std::size_t>> left = {{0, 0}};
    while (!left.empty()) {
        const auto [index, level] = left.back();
        left.pop_back();
        const mesh::Node& node = file.nodes()[index];
        most[level] = std::max(most[level], double{valueOf(node)});
        if (node.isLeaf())
            continue;
        for (const std::int32_t child : {node.left, node.right})
            left.emplace_back(static_cast<std::uint32_t>(child), level + 1);
    }
    return most;
}

absl::StatusOr<Facts> meshFacts(const std::string& path, const page::SourceOptions& sources) {
    ASSIGN_OR_RETURN(const mesh::EymFile file, mesh::EymFile::open(path, sources));
    double worst = 0;
    for (const mesh::ImageRecord& image : file.images())
        worst = std::max(worst, double{image.shape.rmsError});
    return Facts{
        .kind = "mesh",
        .bounds = file.bounds(),
        .unit = "triangles",
        .count = file.triangleCount(),
        .triangles = file.triangleCount(),
        .levels = file.levels(),
        .crs = "",
        .bytes = file.fileBytes(),
        .coarsestErrorMetres = file.coarsestErrorMetres(),
        .finestErrorMetres = file.finestErrorMetres(),
        .colourReachMetres = file.hasColours()
                                 ? byLevel(file, std::mem_fn(&mesh::Node::colourReachMetres))
                                 : std::vector<double>(),
        .normalErrorDegrees = byLevel(file, std::mem_fn(&mesh::Node::normalErrorDegrees)),
        .normalErrorMeanDegrees = byLevel(file, std::mem_fn(&mesh::Node::normalErrorMeanDegrees)),
        .tunedLeafTriangles = file.tunedLeafTriangles(),
        .imagery = {},
        .materials = file.materials().size(),
        .textures = file.images().size(),
        .textureRmsError = worst,
        .lights = file.lights().count()};
}

absl::StatusOr<Facts> dataFacts(const std::string& path, const page::SourceOptions& sources) {
    switch (dataFileOf(path)) {
        case DataFile::Terrain:
            return terrainFacts(path, sources);
        case DataFile::Mesh:
            return meshFacts(path, sources);
        default:
            break;
    }
    RETURN_IF_ERROR(page::checkScheme(path));
    if (!page::isVirtual(path) && !std::filesystem::exists(path))
        return absl::NotFoundError(fmt::format("{}: no such file", path));
    return absl::InvalidArgumentError(fmt::format(
        "{}: this is no .eyt, .eym or .json file; make one of it with `eyrie import`", path));
}

JsonObject toJson(const Facts& facts) {
    JsonObject json;
    json.text("kind", facts.kind).box("bounds", facts.bounds).count(facts.unit, facts.count);
    if (facts.unit != "triangles")
        json.count("triangles", facts.triangles);
    json.count("levels", static_cast<std::uint64_t>(facts.levels))
        .text("crs", facts.crs)
        .count("bytes", facts.bytes)
        .object("errorMetres", JsonObject()
                                   .number("coarsest", facts.coarsestErrorMetres)
                                   .number("finest", facts.finestErrorMetres));
    if (!facts.colourReachMetres.empty())
        json.numbers("colourReachMetres", facts.colourReachMetres);
    if (!facts.normalErrorDegrees.empty())
        json.numbers("normalErrorDegrees", facts.normalErrorDegrees)
            .numbers("normalErrorMeanDegrees", facts.normalErrorMeanDegrees);
    if (facts.tunedLeafTriangles > 0)
        json.count("tunedLeafTriangles", facts.tunedLeafTriangles);
    if (facts.materials > 0)
        json.count("materials", facts.materials)
            .count("textures", facts.textures)
            .number("textureRmsError", facts.textureRmsError);
    if (facts.lights > 0)
        json.count("lights", facts.lights);
    if (facts.imagery)
        json.object("imagery", imageryJson(*facts.imagery));
    return json;
}

void printFacts(const std::string& name, const Facts& facts) {
    const fabric::Box& b = facts.bounds;
    fmt::print("{}: {}\n", fabric::shownName(name), facts.kind);
    fmt::print("  bounds      {:.10g} {:.10g} {:.10g} to {:.10g} {:.10g} {:.10g} m\n", b.min.x,
               b.min.y, b.min.z, b.max.x, b.max.y, b.max.z);
    fmt::print("  {:<11} {}\n", facts.unit, facts.count);
    fmt::print("  levels      {}\n", facts.levels);
    fmt::print("  crs         {}\n", crsName(facts.crs));
    fmt::print("  bytes       {}\n", facts.bytes);
    fmt::print("  error       {} m at the coarsest, {} m at the finest\n",
               boundText(facts.coarsestErrorMetres), boundText(facts.finestErrorMetres));
    if (!facts.colourReachMetres.empty())
        fmt::print("  colours     from within {} m at the coarsest\n",
                   boundText(facts.colourReachMetres.front()));
    if (!facts.normalErrorDegrees.empty())
        fmt::print("  normals     off by at most {} degrees, {} on average over a node\n",
                   boundText(*std::ranges::max_element(facts.normalErrorDegrees)),
                   boundText(*std::ranges::max_element(facts.normalErrorMeanDegrees)));
    if (facts.tunedLeafTriangles > 0)
        fmt::print("  leaves      of at most {} triangles, which was measured to be fastest\n",
                   facts.tunedLeafTriangles);
    if (facts.materials > 0)
        fmt::print("  materials   {}, {} textures within {:.2g} of 255 (RMS)\n", facts.materials,
                   facts.textures, facts.textureRmsError);
    if (facts.lights > 0)
        fmt::print("  lights      {}, which shine in scenes without lights of their own\n",
                   facts.lights);
    if (facts.imagery)
        fmt::print("  imagery     {}\n", imageryText(*facts.imagery));
}

/// How facts are told.
enum class Form { Text, Json, Nothing };

absl::Status sceneInfo(const std::string& path, const page::SourceOptions& sources, Form form) {
    ASSIGN_OR_RETURN(const fabric::Scene scene, readSceneFile(path));
    std::vector<JsonObject> objects;
    fabric::Box bounds;
    std::uint64_t bytes = 0;
    std::uint64_t triangles = 0;
    for (const fabric::SceneObject& object : scene.objects) {
        JsonObject one;
        one.text("name", object.name).text("path", fabric::shownName(object.path));
        const DataFile file = dataFileOf(object.path);
        if (file == DataFile::Terrain || file == DataFile::Mesh) {
            ASSIGN_OR_RETURN(const Facts facts, dataFacts(object.path, sources));
            bounds.grow(fabric::transformed(facts.bounds, object.worldFromObject));
            bytes += facts.bytes;
            triangles += facts.triangles;
            one.object("data", toJson(facts));
            if (form == Form::Text)
                printFacts(object.name, facts);
        } else if (form == Form::Text) {
            fmt::print("{}: {}, not imported yet\n", object.name, fabric::shownName(object.path));
        }
        objects.push_back(std::move(one));
    }
    if (form != Form::Json)
        return absl::OkStatus();
    JsonObject whole;
    whole.text("kind", "scene").count("triangles", triangles).count("bytes", bytes);
    if (!bounds.isEmpty())
        whole.box("bounds", bounds);
    fmt::print("{}\n", whole.objects("objects", objects).str());
    return absl::OkStatus();
}

absl::Status info(const std::string& path, const CacheOptions& cache, Form form) {
    ASSIGN_OR_RETURN(const RemoteData remote, remoteDataOf(cache));
    const page::SourceOptions sources = page::sourceOptions(remote.cacheFolder, remote.cacheBytes);
    if (dataFileOf(path) == DataFile::Scene)
        return sceneInfo(path, sources, form);
    ASSIGN_OR_RETURN(const Facts facts, dataFacts(path, sources));
    if (form == Form::Json)
        fmt::print("{}\n", toJson(facts).str());
    else if (form == Form::Text)
        printFacts(path, facts);
    return absl::OkStatus();
}

}  // namespace

void addInfo(CLI::App& app, Run& run) {
    struct Options {
        std::string file;
        CacheOptions cache;
        bool json = false;
        bool quiet = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("info", "Say what a data or scene file is");
    command
        ->add_option("file", options->file, "An .eyt, .eym or scene .json file, or the URL of data")
        ->type_name("FILE|URL")
        ->required();
    addCacheOptions(*command, options->cache);
    command->add_flag("--json", options->json, "Print it as JSON");
    command->add_flag("--quiet", options->quiet, "Print nothing: the exit status tells");
    command->footer(
        "Example:\n  eyrie info dem.eyt --json\n  eyrie info https://data.example/dem.eyt");
    command->callback([options, &run] {
        const Form form = options->quiet ? Form::Nothing : options->json ? Form::Json : Form::Text;
        run = [options, form] { return info(options->file, options->cache, form); };
    });
}

}  // namespace eyrie::cli
