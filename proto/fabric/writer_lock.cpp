// SPDX-License-Identifier: Apache-2.0
#include "fabric/writer_lock.h"

#include <cerrno>

#include <sys/file.h>
#include <sys/stat.h>

namespace eyrie::fabric {
namespace {

bool isNameOf(const std::string& path, int fd) {
    struct stat named {};
    struct stat opened {};
    return stat(path.c_str(), &named) == 0 && fstat(fd, &opened) == 0 &&
           named.st_dev == opened.st_dev && named.st_ino == opened.st_ino;
}

}  // namespace

WriterLock takeWriterLock(const std::string& path, int fd) {
    const bool isTaken = flock(fd, LOCK_EX | LOCK_NB) == 0;
    if (!isTaken && errno != ENOLCK && errno != EOPNOTSUPP && errno != ENOSYS)
        return WriterLock::Anothers;
    // Only now: until it had the lock, who held it may have been done with the file.
    if (!isNameOf(path, fd))
        return WriterLock::Gone;
    return isTaken ? WriterLock::Taken : WriterLock::NoLocks;
}

}  // namespace eyrie::fabric
