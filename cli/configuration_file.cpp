// SPDX-License-Identifier: Apache-2.0
#include "cli/configuration_file.h"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "cli/text_file.h"
#include "coordinator/config/configuration_message.h"
#include "coordinator/config/eqc_grammar.h"
#include "coordinator/config/eqc_reader.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

/// A named pipe may wait for ever for somebody to write; scripts name configurations by files.
absl::Status checkRegular(const std::string& path) {
    std::error_code error;
    if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
        return absl::InvalidArgumentError(
            fmt::format("{}: this is no regular file; a configuration is read from one", path));
    return absl::OkStatus();
}

}  // namespace

absl::StatusOr<config::Configuration> readConfiguration(const std::string& path,
                                                        config::Findings& findings) {
    RETURN_IF_ERROR(checkRegular(path));
    ASSIGN_OR_RETURN(const std::string text, readText(path));
    return isJson(path) ? config::readJson(text, findings) : config::readEqc(text, findings);
}

}  // namespace eyrie::cli
