// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <absl/status/status.h>

/// Where the sources of an import lie: a text file beside it, NAME.source, with an absolute path a
/// line, in the order they were imported in, or an address as anybody may see it
/// (fabric::shownName), since anybody may read the record. Not in the import itself, whose bytes
/// depend on what the sources hold and on nothing else (docs/decisions/0032-measured-errors.md).
namespace eyrie::cli {

/// The name of the record beside an import.
std::string sourceRecordName(const std::string& imported);

/// Writes the record of `imported`, unless it says so already. Errors: those of writeText.
absl::Status recordSources(const std::string& imported, const std::vector<std::string>& sources);

/// What the record says; nothing where there is none, or `imported` is a URL.
std::optional<std::vector<std::string>> recordedSources(const std::string& imported);

}  // namespace eyrie::cli
