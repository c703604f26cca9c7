// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/file_lock.h"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace eyrie::api {
namespace {

std::string lastError() { return std::generic_category().message(errno); }

}  // namespace

absl::StatusOr<FileLock> FileLock::take(const std::filesystem::path& path) {
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file < 0)
        return absl::UnavailableError(lastError());
    FileLock lock(file);
    if (::flock(file, LOCK_EX | LOCK_NB) == 0)
        return lock;
    if (errno == EWOULDBLOCK)
        return absl::FailedPreconditionError("another process has it");
    if (errno == ENOLCK || errno == EOPNOTSUPP || errno == ENOSYS)
        return absl::UnimplementedError(lastError());
    return absl::UnavailableError(lastError());
}

FileLock::~FileLock() {
    if (file_ >= 0)
        ::close(file_);
}

}  // namespace eyrie::api
