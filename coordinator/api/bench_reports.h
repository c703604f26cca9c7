// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "access/data_folder.h"
#include "eyrie/v1/coordinator_service.pb.h"

namespace eyrie::api {

/// What `eyrie bench` calls it: "summary.json".
std::string_view fileNameOf(v1::ReportFile file);

/// FailedPrecondition, naming `name` and what is in the way, unless what lies at `path` is a folder
/// of nothing, or of nothing but what a bench run of the API writes, its summary among that: what
/// replaces it removes no other file.
absl::Status checkIsReport(const std::filesystem::path& path, std::string_view name);

/// InvalidArgument where the file or folder `name` would lie in a report, and go with it.
absl::Status checkIsInNoReport(const std::filesystem::path& name);

/// A report's file that may be read.
struct FoundReport {
    std::filesystem::path path;
    std::int64_t bytes = 0;
};

/// That file of the report of that name. Errors: InvalidArgument (the name is none of a
/// report, or there is no such file), NotFound, PermissionDenied, ResourceExhausted (too large).
absl::StatusOr<FoundReport> findReport(const access::DataFolder& folder, const std::string& name,
                                       v1::ReportFile file);

/// Its content. Errors: Unavailable.
absl::StatusOr<std::string> read(const FoundReport& found);

}  // namespace eyrie::api
