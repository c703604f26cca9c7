// SPDX-License-Identifier: Apache-2.0
#include "cli/several_sources.h"

#include <cstdint>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "fabric/shown_name.h"

namespace eyrie::cli {

std::string titleOf(const std::vector<std::string>& sources) {
    const std::string first = fabric::shownName(sources.front());
    return sources.size() == 1 ? first : fmt::format("{} and {} more", first, sources.size() - 1);
}

double megabytesOf(const std::vector<std::string>& sources) {
    double megabytes = 0;
    for (const std::string& source : sources) {
        std::error_code none;
        const std::uintmax_t bytes = std::filesystem::file_size(source, none);
        megabytes += none ? 0 : static_cast<double>(bytes) / 1e6;
    }
    return megabytes;
}

}  // namespace eyrie::cli
