// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/bench_reports.h"

#include <filesystem>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "coordinator/api/bench_order.h"
#include "fabric/status.h"

namespace eyrie::api {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxBytes = 256 << 20;

}  // namespace

std::string_view fileNameOf(v1::ReportFile file) {
    return file == v1::REPORT_FILE_FRAMES   ? "frames.csv"
           : file == v1::REPORT_FILE_PAGE   ? "index.html"
           : file == v1::REPORT_FILE_ERRORS ? "errors.csv"
                                            : "summary.json";
}

absl::StatusOr<FoundReport> findReport(const access::DataFolder& folder, const std::string& name,
                                       v1::ReportFile file) {
    if (!v1::ReportFile_IsValid(file))
        return absl::InvalidArgumentError(fmt::format(
            "file is {}; it must be one that this version knows", static_cast<int>(file)));
    // No other file of the data folder can be had.
    if (fs::path(name).extension() != kReportEnding)
        return absl::InvalidArgumentError(
            fmt::format("name is '{}'; a report's ends in {}", name.substr(0, 64), kReportEnding));
    const absl::StatusOr<fs::path> path =
        folder.existing(fmt::format("{}/{}", name, fileNameOf(file)));
    if (!path.ok())
        return fabric::withContext(path.status(), "name");
    std::error_code error;
    if (!fs::is_regular_file(*path, error))
        return absl::NotFoundError(fmt::format("there is no report '{}' with a file {}",
                                               name.substr(0, 64), fileNameOf(file)));
    const std::uintmax_t bytes = fs::file_size(*path, error);
    if (error)
        return absl::UnavailableError("the file cannot be read");
    if (bytes > kMaxBytes)
        return absl::ResourceExhaustedError("the file is larger than 256 MiB; copy it instead");
    return FoundReport{*path, static_cast<std::int64_t>(bytes)};
}

absl::StatusOr<std::string> read(const FoundReport& found) {
    std::ifstream stream(found.path, std::ios::binary);
    std::string content(static_cast<std::size_t>(found.bytes), '\0');
    stream.read(content.data(), found.bytes);
    if (!stream)
        return absl::UnavailableError("the file cannot be read");
    return content;
}

}  // namespace eyrie::api
