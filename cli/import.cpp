// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include "cli/commands.h"

namespace eyrie::cli {

void addImport(CLI::App& app, Run& run) {
    CLI::App* command = app.add_subcommand("import", "Make data that renderers can draw");
    command->require_subcommand(1);
    addImportTerrain(*command, run);
    addImportMesh(*command, run);
}

}  // namespace eyrie::cli
