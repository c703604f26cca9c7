// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/companion_folder.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

namespace eyrie::import {
namespace {

namespace fs = std::filesystem;

/// Without links or ".."; empty: anywhere.
fs::path& kept() {
    static fs::path folder;
    return folder;
}

}  // namespace

absl::Status keepCompanionsBelow(const std::string& folder) {
    std::error_code error;
    kept() = folder.empty() ? fs::path() : fs::canonical(folder, error);
    if (!error)
        return absl::OkStatus();
    return absl::NotFoundError(fmt::format("{}: {}", folder, error.message()));
}

bool mayBeCompanion(const std::string& path) {
    const fs::path& folder = kept();
    if (folder.empty())
        return true;
    std::error_code error;
    const fs::path real = fs::canonical(path, error);
    return !error && std::ranges::mismatch(folder, real).in1 == folder.end();
}

}  // namespace eyrie::import
