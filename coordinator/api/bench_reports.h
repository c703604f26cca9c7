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
