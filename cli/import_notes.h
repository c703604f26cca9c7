// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "renderer/import/mesh_import.h"

namespace eyrie::cli {

/// What was odd in a mesh's sources, what its import left out of them, and levels of detail that
/// are finer than they had to be; lines for people.
std::vector<std::string> notesOf(const import::MeshImportReport& made);

/// Which of the vertices had to stay in each level of detail, and why; nothing without levels.
std::string keptLine(const import::MeshImportReport& made);

}  // namespace eyrie::cli
