// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/bench_reports.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "access/printable.h"
#include "coordinator/api/bench_order.h"
#include "fabric/status.h"

namespace eyrie::api {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxBytes = 256 << 20;

/// Whether a bench run of the API leaves a file of that name.
bool isOfReports(const std::string& name) {
    for (const v1::ReportFile file : {v1::REPORT_FILE_SUMMARY, v1::REPORT_FILE_FRAMES,
                                      v1::REPORT_FILE_PAGE, v1::REPORT_FILE_ERRORS})
        if (name == fileNameOf(file))
            return true;
    return name == kSceneFile || (name.starts_with(kFlightFileBegin) && name.ends_with(".json"));
}

absl::Status isNoReport(std::string_view name, const std::string& why) {
    return absl::FailedPreconditionError(
        fmt::format("'{}' is no report, and is not replaced: {}; choose another name, or move "
                    "what is there away",
                    name, why));
}

}  // namespace

std::string_view fileNameOf(v1::ReportFile file) {
    return file == v1::REPORT_FILE_FRAMES   ? "frames.csv"
           : file == v1::REPORT_FILE_PAGE   ? "index.html"
           : file == v1::REPORT_FILE_ERRORS ? "errors.csv"
                                            : "summary.json";
}

absl::Status checkIsReport(const fs::path& path, std::string_view name) {
    std::error_code error;
    if (fs::symlink_status(path, error).type() != fs::file_type::directory)
        return isNoReport(name, "it is no folder");
    std::vector<std::string> files;
    std::vector<std::string> others;
    for (fs::directory_iterator entry(path, error); !error && entry != fs::directory_iterator();
         entry.increment(error)) {
        std::error_code unknown;
        const std::string file = entry->path().filename().string();
        const bool isFile = entry->symlink_status(unknown).type() == fs::file_type::regular;
        (isFile && isOfReports(file) ? files : others).push_back(file);
    }
    if (error)
        return isNoReport(name, fmt::format("it cannot be read ({})", error.message()));
    if (!others.empty())
        return isNoReport(name, fmt::format("it holds '{}', which is of no report",
                                            access::printable(*std::ranges::min_element(others))));
    const std::string_view summary = fileNameOf(v1::REPORT_FILE_SUMMARY);
    if (!files.empty() && std::ranges::find(files, summary) == files.end())
        return isNoReport(name, fmt::format("it holds '{}' and no {}",
                                            *std::ranges::min_element(files), summary));
    return absl::OkStatus();
}

absl::Status checkIsInNoReport(const fs::path& name) {
    for (const fs::path& part : name.parent_path())
        if (part.extension() == kReportEnding)
            return absl::InvalidArgumentError(
                fmt::format("'{}' lies in '{}', and what ends in {} is a report, which is replaced "
                            "whole; choose a name outside of it",
                            name.string(), part.string(), kReportEnding));
    return absl::OkStatus();
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
