// SPDX-License-Identifier: Apache-2.0
#include "bench/simulator/text.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

namespace eyrie::simulator {

absl::StatusOr<std::string> textOf(const std::string& path) {
    if (std::error_code error; std::filesystem::is_directory(path, error))
        return absl::InvalidArgumentError(fmt::format("{}: this is a folder, not a file", path));
    std::ifstream in(path, std::ios::binary);
    if (!in)
        return absl::NotFoundError(fmt::format("{} cannot be read", path));
    return std::string(std::istreambuf_iterator<char>(in), {});
}

}  // namespace eyrie::simulator
