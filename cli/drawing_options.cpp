// SPDX-License-Identifier: Apache-2.0
#include "cli/drawing_options.h"

#include <map>

#include "cli/options/one_of.h"
#include "cli/values.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

const std::map<std::string, TileDecoding>& decodeNames() {
    static const std::map<std::string, TileDecoding> names = {
        {"auto", TileDecoding::Auto}, {"cpu", TileDecoding::Cpu}, {"gpu", TileDecoding::Gpu}};
    return names;
}

std::string nameOf(TileDecoding decoding) {
    for (const auto& [name, value] : decodeNames())
        if (value == decoding)
            return name;
    return "auto";
}

}  // namespace

void addDrawingOptions(CLI::App& command, DrawingOptions& options) {
    command
        .add_option("--memory", options.memory,
                    "Limit of geometry and textures that a renderer keeps on its device; while "
                    "another scene is opened, its textures of meshes come on top, up to half as "
                    "much as a rule")
        ->type_name("BYTES[K|M|G|T]")
        ->capture_default_str();
    command
        .add_option("--host-memory", options.hostMemory,
                    "Limit of a renderer's indices of terrains, 31 bytes a tile, and of pages kept "
                    "in memory, those being read included; of tables of meshes, when they are "
                    "opened. Beside it picks keep 16 MiB, and another scene that is being opened "
                    "its indices")
        ->type_name("BYTES[K|M|G|T]")
        ->capture_default_str();
    command
        .add_option("--decode", options.decoding,
                    "What makes terrain's vertices; auto: what a measurement finds faster [auto]")
        ->transform(valueOf(decodeNames()))
        ->type_name("auto|cpu|gpu");
    addCacheOptions(command, options.cache);
}

absl::StatusOr<RendererOptions> rendererOptionsOf(const DrawingOptions& options) {
    RendererOptions settings;
    ASSIGN_OR_RETURN(settings.memoryBytes, parseBytes(options.memory, "--memory"));
    ASSIGN_OR_RETURN(settings.hostMemoryBytes, parseBytes(options.hostMemory, "--host-memory"));
    ASSIGN_OR_RETURN(settings.remote, remoteDataOf(options.cache));
    settings.decoding = options.decoding;
    return settings;
}

std::vector<std::string> argumentsOf(const DrawingOptions& options) {
    std::vector<std::string> arguments = {
        "--memory", options.memory,           "--host-memory", options.hostMemory,
        "--decode", nameOf(options.decoding), "--cache-size",  options.cache.size};
    if (!options.cache.folder.empty())
        arguments.insert(arguments.end(), {"--cache", options.cache.folder});
    return arguments;
}

}  // namespace eyrie::cli
