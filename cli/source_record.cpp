// SPDX-License-Identifier: Apache-2.0
#include "cli/source_record.h"

#include <fstream>

#include "cli/image_files.h"
#include "fabric/name_beside.h"
#include "fabric/shown_name.h"
#include "renderer/import/raster_name.h"

namespace eyrie::cli {

std::string sourceRecordName(const std::string& imported) {
    return fabric::nameBeside(imported, ".source");
}

absl::Status recordSources(const std::string& imported, const std::vector<std::string>& sources) {
    std::vector<std::string> names;
    std::string text;
    for (const std::string& source : sources) {
        names.push_back(fabric::shownName(import::absoluteName(source)));
        text += names.back() + "\n";
    }
    if (recordedSources(imported) == names)
        return absl::OkStatus();
    return writeText(text, sourceRecordName(imported));
}

std::optional<std::vector<std::string>> recordedSources(const std::string& imported) {
    std::ifstream in(sourceRecordName(imported));
    std::vector<std::string> sources;
    for (std::string line; std::getline(in, line);)
        if (!line.empty())
            sources.push_back(line);
    if (sources.empty())
        return std::nullopt;
    return sources;
}

}  // namespace eyrie::cli
