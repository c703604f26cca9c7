// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "renderer/import/mesh_import.h"

namespace eyrie::cli {

/// What was odd in a mesh's sources and what its import left out of them; lines for people.
std::vector<std::string> notesOf(const import::MeshImportReport& made);

}  // namespace eyrie::cli
