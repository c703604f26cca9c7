// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/output_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <absl/status/status.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "fabric/status.h"

namespace eyrie::mesh {

absl::StatusOr<OutputFile> OutputFile::create(const std::string& path) {
    std::string partial = fmt::format("{}.partial-{}", path, ::getpid());
    const int fd = ::open(partial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0)
        return fabric::writeError(path, "cannot create it", errno);
    return OutputFile(path, std::move(partial), fd);
}

absl::StatusOr<OutputFile> OutputFile::createUnnamed(const std::string& path) {
    std::string name = path + ".scratch-XXXXXX";
    const int fd = ::mkostemp(name.data(), O_CLOEXEC);
    if (fd < 0)
        return fabric::writeError(path, "cannot create a scratch file beside it", errno);
    ::unlink(name.c_str());
    return OutputFile(path, {}, fd);
}

OutputFile::~OutputFile() {
    if (fd_ < 0)
        return;
    ::close(fd_);
    if (!partialPath_.empty())
        ::unlink(partialPath_.c_str());
}

absl::Status OutputFile::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            return fabric::writeError(path_, "cannot write it", errno);
        size_ += static_cast<std::uint64_t>(written);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return absl::OkStatus();
}

absl::Status OutputFile::writeAt(std::uint64_t offset, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written =
            ::pwrite(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            return fabric::writeError(
                path_,
                partialPath_.empty() ? "cannot write a scratch file beside it" : "cannot write it",
                errno);
        offset += static_cast<std::uint64_t>(written);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return absl::OkStatus();
}

absl::Status OutputFile::readAt(std::uint64_t offset, std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t got = ::pread(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return absl::UnavailableError(fmt::format(
                "{}: cannot read the scratch file beside it: {}", path_, std::strerror(errno)));
        if (got == 0) {
            std::fill(bytes.begin(), bytes.end(), std::byte{0});
            return absl::OkStatus();
        }
        offset += static_cast<std::uint64_t>(got);
        bytes = bytes.subspan(static_cast<std::size_t>(got));
    }
    return absl::OkStatus();
}

absl::Status OutputFile::padTo(std::uint64_t alignment) {
    const std::vector<std::byte> zeros((alignment - size_ % alignment) % alignment);
    return write(zeros);
}

absl::Status OutputFile::commit() {
    if (::fsync(fd_) != 0)
        return fabric::writeError(path_, "cannot flush it to the disk", errno);
    if (::rename(partialPath_.c_str(), path_.c_str()) != 0)
        return fabric::writeError(path_, "cannot put it in place", errno);
    ::close(std::exchange(fd_, -1));
    return absl::OkStatus();
}

}  // namespace eyrie::mesh
