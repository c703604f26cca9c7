// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/whole_file.h"

#include <cerrno>
#include <cstdio>
#include <utility>

#include <unistd.h>

#include "fabric/partial_file.h"
#include "fabric/status.h"

namespace eyrie::import {

WholeFile::WholeFile(std::string path, std::string partialPath, int fd)
    : path_(std::move(path)), partialPath_(std::move(partialPath)), fd_(fd) {}

WholeFile::WholeFile(WholeFile&& other) noexcept
    : path_(std::move(other.path_)),
      partialPath_(std::move(other.partialPath_)),
      fd_(std::exchange(other.fd_, -1)),
      size_(other.size_) {}

WholeFile::~WholeFile() {
    if (fd_ < 0)
        return;
    unlink(partialPath_.c_str());
    close(fd_);
}

absl::StatusOr<WholeFile> WholeFile::create(const std::string& path) {
    ASSIGN_OR_RETURN(fabric::PartialFile partial, fabric::createPartial(path));
    return WholeFile(path, std::move(partial.path), partial.fd);
}

absl::Status WholeFile::append(std::span<const std::byte> bytes) {
    RETURN_IF_ERROR(writeAt(size_, bytes));
    size_ += bytes.size();
    return absl::OkStatus();
}

absl::Status WholeFile::writeAt(std::uint64_t offset, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t done = pwrite(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (done < 0 && errno == EINTR)
            continue;
        if (done < 0)
            return fabric::writeError(path_, "cannot be written", errno);
        bytes = bytes.subspan(static_cast<std::size_t>(done));
        offset += static_cast<std::uint64_t>(done);
    }
    return absl::OkStatus();
}

absl::Status WholeFile::commit() {
    if (fsync(fd_) != 0)
        return fabric::writeError(path_, "cannot be flushed to disk", errno);
    if (std::rename(partialPath_.c_str(), path_.c_str()) != 0)
        return fabric::writeError(path_, "cannot be renamed from its partial file", errno);
    close(std::exchange(fd_, -1));
    return absl::OkStatus();
}

}  // namespace eyrie::import
