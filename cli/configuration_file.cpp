// SPDX-License-Identifier: Apache-2.0
#include "cli/configuration_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "coordinator/config/configuration_message.h"
#include "coordinator/config/eqc_grammar.h"
#include "coordinator/config/eqc_reader.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

/// A byte more than can be read, so that what is too long is seen to be. Of a pipe or a device,
/// which may never end, nothing.
absl::StatusOr<std::string> readText(const std::string& path) {
    std::error_code error;
    if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
        return absl::InvalidArgumentError(
            fmt::format("{}: this is no regular file; a configuration is read from one", path));
    std::ifstream in(path, std::ios::binary);
    std::string text;
    if (in) {
        text.resize(config::kLongestText + 1);
        in.read(text.data(), static_cast<std::streamsize>(text.size()));
        text.resize(static_cast<std::size_t>(in.gcount()));
    }
    if (!in && !in.eof())
        return absl::NotFoundError(
            fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
    return text;
}

}  // namespace

absl::StatusOr<config::Configuration> readConfiguration(const std::string& path,
                                                        config::Findings& findings) {
    ASSIGN_OR_RETURN(const std::string text, readText(path));
    return isJson(path) ? config::readJson(text, findings) : config::readEqc(text, findings);
}

}  // namespace eyrie::cli
