// SPDX-License-Identifier: Apache-2.0
#include "fabric/status.h"

#include <cerrno>
#include <cstring>
#include <string>

#include <fmt/format.h>

namespace eyrie::fabric {

absl::Status withContext(const absl::Status& status, std::string_view context) {
    if (status.ok())
        return status;
    const auto message = status.message();
    return {status.code(),
            fmt::format("{}: {}", context, std::string_view(message.data(), message.size()))};
}

absl::Status writeError(std::string_view path, std::string_view what, int error) {
    const std::string message = fmt::format("{}: {}: {}", path, what, std::strerror(error));
    switch (error) {
        case ENOENT:
        case ENOTDIR:
            return absl::NotFoundError(message + "; create the folder first");
        case EISDIR:
            return absl::InvalidArgumentError(message + "; name a file, not a folder");
        case ENAMETOOLONG:
        case ELOOP:
            return absl::InvalidArgumentError(message + "; name another one");
        case EACCES:
        case EPERM:
        case EROFS:
            return absl::PermissionDeniedError(message);
        case ENOSPC:
        case EDQUOT:
            return absl::ResourceExhaustedError(
                message + "; free some space on that disk, then run the same command again");
        case EFBIG:
            return absl::ResourceExhaustedError(
                message + "; allow larger files (ulimit -f), or write to a disk that has them");
        default:
            return absl::UnavailableError(message);
    }
}

}  // namespace eyrie::fabric
