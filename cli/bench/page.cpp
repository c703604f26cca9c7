// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/page.h"

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "fabric/status.h"
#include "renderer/mesh/output_file.h"

namespace eyrie::cli::bench {
namespace {

constexpr std::string_view kDataPlace = "REPORT_DATA";
constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// "</script>" and "<!--" in a file's name must not change what the script is.
std::string forScript(std::string json) {
    for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos; at += 6)
        json.replace(at, 1, "\\u003c");
    return json;
}

}  // namespace

std::string withData(std::string_view page, std::string json) {
    std::string result(page);
    result.replace(result.find(kDataPlace), kDataPlace.size(), forScript(std::move(json)));
    return result;
}

absl::Status makeFolder(const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    return error ? fabric::writeError(folder, "cannot make the folder", error.value())
                 : absl::OkStatus();
}

absl::Status checkFolder(const std::string& folder, std::span<const std::string_view> names) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path whole = fs::absolute(folder, error);
    fs::path nearest = whole;
    while (!fs::exists(nearest, error) && nearest != nearest.parent_path())
        nearest = nearest.parent_path();
    if (!fs::is_directory(nearest, error))
        return absl::InvalidArgumentError(
            fmt::format("{}: cannot make the folder: {} is no folder; name another one", folder,
                        nearest.string()));
    if (::access(nearest.c_str(), W_OK | X_OK) != 0)
        return fabric::writeError(folder, "cannot write into the folder", errno);
    absl::Status status = makeFolder(folder);
    for (const std::string_view name : names)
        if (status.ok())
            status = mesh::OutputFile::check((fs::path(folder) / name).string());
    for (fs::path made = whole; made != nearest; made = made.parent_path())
        ::rmdir(made.c_str());  // no file, nor a link
    return status;
}

std::string base64(std::string_view bytes) {
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t length = bytes.size() - i < 3 ? bytes.size() - i : 3;
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < length ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= length ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

}  // namespace eyrie::cli::bench
