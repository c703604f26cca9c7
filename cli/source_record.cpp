// SPDX-License-Identifier: Apache-2.0
#include "cli/source_record.h"

#include <fstream>

#include "cli/image_files.h"
#include "fabric/name_beside.h"
#include "renderer/import/raster_name.h"

namespace eyrie::cli {

std::string sourceRecordName(const std::string& imported) {
    return fabric::nameBeside(imported, ".source");
}

absl::Status recordSources(const std::string& imported, const std::vector<std::string>& sources) {
    std::vector<std::string> absolute;
    std::string text;
    for (const std::string& source : sources) {
        absolute.push_back(import::absoluteName(source));
        text += absolute.back() + "\n";
    }
    if (recordedSources(imported) == absolute)
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
