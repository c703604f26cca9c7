// SPDX-License-Identifier: Apache-2.0
#include "cli/import_notes.h"

#include <fmt/format.h>

namespace eyrie::cli {

std::vector<std::string> notesOf(const import::MeshImportReport& made) {
    std::vector<std::string> notes = made.notes;
    const import::PackCounts& counts = made.counts;
    if (made.droppedFaces + counts.degenerateTriangles + counts.duplicateTriangles > 0)
        notes.push_back(
            fmt::format("left out {} faces of fewer than three corners, {} triangles without area, "
                        "{} that were there already",
                        made.droppedFaces, counts.degenerateTriangles, counts.duplicateTriangles));
    return notes;
}

}  // namespace eyrie::cli
