// SPDX-License-Identifier: Apache-2.0
#include "cli/own_places.h"

#include <filesystem>
#include <map>
#include <system_error>

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::cli {
namespace {

namespace fs = std::filesystem;

/// Where a file of this name is put: a link there is replaced, not followed.
fs::path placeOf(const std::string& path) {
    std::error_code error;
    const fs::path place = fs::absolute(path, error);
    return fs::weakly_canonical(place.parent_path(), error) / place.filename();
}

/// Neither a device nor a pipe.
bool hasPlace(const std::string& path) {
    std::error_code error;
    return !path.empty() && (!fs::exists(path, error) || fs::is_regular_file(path, error));
}

}  // namespace

absl::Status checkOwnPlaces(std::span<const NamedFile> written, std::span<const NamedFile> read) {
    std::map<fs::path, std::string> taken;  // by whom
    for (const NamedFile& file : read) {
        if (!hasPlace(file.path))
            continue;
        std::error_code error;
        taken.emplace(placeOf(file.path), file.option);
        taken.emplace(fs::weakly_canonical(file.path, error), file.option);
    }
    for (const NamedFile& file : written) {
        if (!hasPlace(file.path))
            continue;
        const auto [other, isOwn] = taken.emplace(placeOf(file.path), file.option);
        if (!isOwn)
            return absl::InvalidArgumentError(
                fmt::format("{} is '{}', the same file as {}; give it a name of its own",
                            file.option, file.path, other->second));
    }
    return absl::OkStatus();
}

}  // namespace eyrie::cli
