// SPDX-License-Identifier: Apache-2.0
#include "cli/text_file.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "renderer/page/remote_name.h"

namespace eyrie::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxTextBytes = 64 << 20;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace

absl::StatusOr<std::string> readText(const std::string& path) {
    if (!page::isPlainPath(path))
        return absl::InvalidArgumentError(fmt::format(
            "{}: a scene or camera file has to be on this machine; only the data that a scene "
            "names may lie at URLs",
            path));
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found)
        return absl::NotFoundError(fmt::format("{}: no such file", path));
    if (fs::is_directory(status))
        return absl::InvalidArgumentError(fmt::format("{}: this is a folder, not a file", path));
    std::ifstream in(path, std::ios::binary);
    std::string text;
    std::array<char, 1 << 16> piece;
    while (in && text.size() <= kMaxTextBytes) {
        in.read(piece.data(), piece.size());
        text.append(piece.data(), static_cast<std::size_t>(in.gcount()));
    }
    if (text.size() > kMaxTextBytes)  // a device may have no end
        return absl::InvalidArgumentError(
            fmt::format("{}: larger than 64 MiB, so it is no scene, flight or camera file", path));
    if (!in.eof())
        return absl::InvalidArgumentError(fmt::format("{}: cannot be read", path));
    if (text.starts_with(kByteOrderMark))
        text.erase(0, kByteOrderMark.size());
    return text;
}

}  // namespace eyrie::cli
