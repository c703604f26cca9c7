// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <absl/status/status.h>

namespace CLI {
class App;
}

/// The subcommands of `eyrie`, one file each. An add function declares its options under `app` and,
/// when the user names the subcommand, sets `run` to what it does.
namespace eyrie::cli {

using Run = std::function<absl::Status()>;

void addServe(CLI::App& app, Run& run);
void addCoordinator(CLI::App& app, Run& run);
void addRenderer(CLI::App& app, Run& run);
void addHealth(CLI::App& app, Run& run);
void addImport(CLI::App& app, Run& run);
void addImportTerrain(CLI::App& app, Run& run);  ///< of `eyrie import`
void addImportMesh(CLI::App& app, Run& run);     ///< of `eyrie import`
void addInfo(CLI::App& app, Run& run);
void addCheck(CLI::App& app, Run& run);
void addBench(CLI::App& app, Run& run);
void addRender(CLI::App& app, Run& run);
void addPick(CLI::App& app, Run& run);
void addSynth(CLI::App& app, Run& run);

}  // namespace eyrie::cli
