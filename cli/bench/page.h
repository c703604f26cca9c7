// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <absl/status/status.h>

/// Pages that hold their data and need no other file.
namespace eyrie::cli::bench {

/// `page` with `json` in the place it keeps for data; nothing in `json` can end the script around.
std::string withData(std::string_view page, std::string json);

/// Where it goes. Errors: those of fabric::writeError.
absl::Status makeFolder(const std::string& folder);

/// Whether makeFolder(folder) and the writing of `names` in it would do, before the work; what it
/// makes for that is gone again. Errors: those of fabric::writeError and mesh::OutputFile::check;
/// InvalidArgument (there is something else of that name).
absl::Status checkFolder(const std::string& folder, std::span<const std::string_view> names);

/// RFC 4648, section 4.
std::string base64(std::string_view bytes);

}  // namespace eyrie::cli::bench
