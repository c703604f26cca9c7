// SPDX-License-Identifier: Apache-2.0
#include "access/data_folder.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "access/printable.h"
#include "fabric/status.h"

namespace eyrie::access {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPartBytes = 255;

absl::Status invalid(std::string_view name, std::string_view why) {
    return absl::InvalidArgumentError(
        fmt::format("data name '{}' {}; name a file below the data folder, such as survey/dem.eyt",
                    printable(name), why));
}

absl::Status checkPart(std::string_view part, std::string_view name) {
    if (part.empty())
        return invalid(name, "has an empty part: it begins or ends with '/', or has two in a row");
    if (part == "." || part == "..")
        return invalid(name, "has a part '.' or '..'");
    if (part.size() > kMaxPartBytes)
        return invalid(name, fmt::format("has a part of more than {} bytes", kMaxPartBytes));
    return absl::OkStatus();
}

/// What the system says of a path that a client named, without telling where the folder is.
absl::Status cannotReach(std::string_view name, const std::error_code& error) {
    const std::string text = fmt::format("data '{}': {}", printable(name), error.message());
    if (error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory)
        return absl::NotFoundError(text);
    if (error == std::errc::permission_denied || error == std::errc::too_many_symbolic_link_levels)
        return absl::PermissionDeniedError(text);
    return absl::UnavailableError(text);
}

bool isBelow(const fs::path& path, const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
           folder.end();
}

}  // namespace

absl::Status checkDataName(std::string_view name) {
    if (name.empty())
        return invalid(name, "is empty");
    if (name.size() > DataFolder::kMaxNameBytes)
        return invalid(name.substr(0, 64),
                       fmt::format("… has more than {} bytes", DataFolder::kMaxNameBytes));
    for (const char c : name)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '\\' || c == ':')
            return invalid(name, "has a control character, a backslash or a colon");
    if (!isUtf8(name))
        return invalid(name, "is not UTF-8");
    for (std::size_t begin = 0; begin <= name.size();) {
        const std::size_t end = std::min(name.find('/', begin), name.size());
        RETURN_IF_ERROR(checkPart(name.substr(begin, end - begin), name));
        begin = end + 1;
    }
    return absl::OkStatus();
}

absl::StatusOr<DataFolder> DataFolder::open(const fs::path& folder) {
    std::error_code error;
    fs::path path = fs::canonical(folder, error);
    if (!error && !fs::is_directory(path, error))
        return absl::InvalidArgumentError(
            fmt::format("data folder {}: not a folder", folder.string()));
    if (!error)
        fs::directory_iterator(path, error);
    if (error == std::errc::no_such_file_or_directory)
        return absl::NotFoundError(
            fmt::format("data folder {}: there is no such folder", folder.string()));
    if (error)
        return absl::PermissionDeniedError(
            fmt::format("data folder {}: {}", folder.string(), error.message()));
    return DataFolder(std::move(path));
}

absl::Status DataFolder::check() const {
    std::error_code error;
    fs::directory_iterator(path_, error);
    if (!error)
        return absl::OkStatus();
    return absl::UnavailableError(
        fmt::format("the data folder cannot be read: {}; see that it is mounted and where it was",
                    error.message()));
}

absl::StatusOr<fs::path> DataFolder::resolve(const fs::path& path, std::string_view name) const {
    std::error_code error;
    fs::path real = fs::canonical(path, error);
    if (error) {
        RETURN_IF_ERROR(check());  // else a folder that has gone would look empty
        return cannotReach(name, error);
    }
    if (!isBelow(real, path_))
        return absl::PermissionDeniedError(
            fmt::format("data '{}' leads out of the data folder", printable(name)));
    return real;
}

absl::StatusOr<fs::path> DataFolder::existing(std::string_view name) const {
    RETURN_IF_ERROR(checkDataName(name));
    return resolve(path_ / fs::path(name), name);
}

absl::StatusOr<fs::path> DataFolder::place(std::string_view name) const {
    RETURN_IF_ERROR(checkDataName(name));
    const fs::path path = path_ / fs::path(name);
    // What is wrong is then wrong with the folder, not with what is to be put there.
    const std::string_view folderName = name.substr(0, name.rfind('/'));
    ASSIGN_OR_RETURN(const fs::path folder, resolve(path.parent_path(), folderName));
    std::error_code error;
    if (!fs::is_directory(folder, error))
        return cannotReach(folderName,
                           error ? error : std::make_error_code(std::errc::not_a_directory));
    fs::path file = folder / path.filename();
    const fs::file_status now = fs::symlink_status(file, error);
    if (now.type() == fs::file_type::not_found || now.type() == fs::file_type::regular)
        return file;
    if (now.type() == fs::file_type::none)
        return cannotReach(name, error);
    return absl::FailedPreconditionError(
        fmt::format("data '{}': something that is no file is in its place", printable(name)));
}

}  // namespace eyrie::access
