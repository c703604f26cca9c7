// SPDX-License-Identifier: Apache-2.0
#include "cli/shown_data.h"

#include <CLI/CLI.hpp>

#include "fabric/log.h"

namespace eyrie::cli {

void addShownData(CLI::App& command, ShownData& data) {
    command
        .add_option(
            "data", data.names,
            "Scenes (.json), imported data (.eyt, .eym), or sources: meshes (.ply, .obj, .glb "
            "and more) and any rasters that GDAL reads, which together are one terrain; imported "
            "when they are new. Imported data may lie at URLs: https://…, or GDAL's /vsis3/…, "
            "/vsigs/…, /vsiaz/… [what programs set, of what is in --data]")
        ->type_name("FILE|URL");
    command
        .add_option("--data", data.folder,
                    "Where programs may name imported files, import more, and keep flights; and "
                    "where the scene and settings that they set are kept for the next start, which "
                    "takes them up while the command line has the same scene and --config "
                    "[nowhere]")
        ->type_name("DIR");
}

void logWhoShows(const ShownData& data) {
    if (!data.names.empty())
        return;
    if (data.folder.empty())
        spdlog::warn(
            "there is nothing to show, and programs cannot name anything: name data, or --data "
            "DIR");
    else
        spdlog::info("no data is named: programs set what is shown, of {}", data.folder);
}

}  // namespace eyrie::cli
