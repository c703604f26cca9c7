// SPDX-License-Identifier: Apache-2.0
#include "cli/several_sources.h"

#include <cstdint>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

namespace eyrie::cli {

std::string titleOf(const std::vector<std::string>& sources) {
    return sources.size() == 1 ? sources.front()
                               : fmt::format("{} and {} more", sources.front(), sources.size() - 1);
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
