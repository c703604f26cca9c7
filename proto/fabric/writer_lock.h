// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace eyrie::fabric {

/// What came of asking for the lock by which others see that the writer of a file lives.
enum class WriterLock {
    Taken,     ///< held for as long as the file is open
    NoLocks,   ///< the file system has none: it is on whoever starts two writers of one file
    Anothers,  ///< another writer holds it
    Gone,      ///< what was opened has since been renamed or removed
};

/// Asks for the lock of the file that was opened as `fd` under the name `path`. Does not wait.
WriterLock takeWriterLock(const std::string& path, int fd);

inline bool mayWrite(WriterLock lock) {
    return lock == WriterLock::Taken || lock == WriterLock::NoLocks;
}

}  // namespace eyrie::fabric
