// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/static_files.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::http {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxBytes = std::uintmax_t{64} << 20;
constexpr std::size_t kMaxFiles = 4096;

std::string contentType(const fs::path& path) {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 13> kTypes{{
        {".css", "text/css; charset=utf-8"},
        {".html", "text/html; charset=utf-8"},
        {".ico", "image/x-icon"},
        {".jpg", "image/jpeg"},
        {".js", "text/javascript; charset=utf-8"},
        {".json", "application/json"},
        {".map", "application/json"},
        {".png", "image/png"},
        {".svg", "image/svg+xml"},
        {".txt", "text/plain; charset=utf-8"},
        {".wasm", "application/wasm"},
        {".webmanifest", "application/manifest+json"},
        {".woff2", "font/woff2"},
    }};
    const std::string extension = path.extension().string();
    for (const auto& [known, type] : kTypes)
        if (known == extension)
            return std::string(type);
    return "application/octet-stream";
}

absl::StatusOr<std::string> readFile(const fs::path& path, std::uintmax_t size) {
    std::string content(size, '\0');
    std::ifstream file(path, std::ios::binary);
    if (!file.read(content.data(), static_cast<std::streamsize>(size)))
        return absl::UnavailableError(fmt::format("cannot read {}", path.string()));
    return content;
}

}  // namespace

absl::StatusOr<StaticFiles> StaticFiles::read(const fs::path& folder) {
    StaticFiles result;
    std::uintmax_t total = 0;
    std::error_code error;
    fs::recursive_directory_iterator entries(folder, error);
    for (; !error && entries != fs::recursive_directory_iterator(); entries.increment(error)) {
        const fs::path& path = entries->path();
        std::error_code ignored;
        if (entries->is_symlink(ignored) || !entries->is_regular_file(ignored))
            continue;
        const std::uintmax_t size = entries->file_size(ignored);
        total += ignored ? 0 : size;
        if (ignored || total > kMaxBytes || result.files_.size() >= kMaxFiles)
            return absl::ResourceExhaustedError(
                fmt::format("{}: the web folder holds more than {} bytes or {} files; is it the "
                            "built UI?",
                            folder.string(), kMaxBytes, kMaxFiles));
        ASSIGN_OR_RETURN(std::string content, readFile(path, size));
        const std::string name =
            fmt::format("/{}", path.lexically_relative(folder).generic_string());
        result.files_[name] = {contentType(path), name.starts_with("/assets/"),
                               std::make_shared<const std::string>(std::move(content))};
    }
    return result;
}

const StaticFile* StaticFiles::find(std::string_view path) const {
    const auto found = files_.find(path == "/" ? std::string_view("/index.html") : path);
    return found == files_.end() ? nullptr : &found->second;
}

}  // namespace eyrie::http
