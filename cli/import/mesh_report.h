// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/import/mesh_options.h"
#include "cli/tune_mesh.h"
#include "renderer/import/mesh_import.h"

/// What is said of a mesh that was imported.
namespace eyrie::cli {

/// One object on standard output; with what was tried, where --tune tried anything.
void printJson(const MeshImportChoices& choices, const import::MeshImportReport& made,
               const MeshTuning& tuning);

/// Lines for people, on standard error.
void printText(const MeshImportChoices& choices, const import::MeshImportReport& made);

}  // namespace eyrie::cli
