// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/output_file.h"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

#include <absl/status/status.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fabric/name_beside.h"
#include "fabric/partial_file.h"
#include "fabric/replaceable.h"
#include "fabric/status.h"

namespace eyrie::mesh {
namespace {

/// How soon a stop is noticed.
constexpr int kPollMilliseconds = 20;

bool isSame(const struct stat& a, const struct stat& b) {
    return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// The process's standard output or errors, where `target` is one of them; -1 otherwise.
int ownOutput(const struct stat& target) {
    for (const int fd : {STDOUT_FILENO, STDERR_FILENO}) {
        struct stat own {};
        if (::fstat(fd, &own) == 0 && isSame(own, target))
            return fd;
    }
    return -1;
}

/// What is written in its place: a file that took it would be in the way of all who use it.
std::optional<struct stat> inItsPlace(const std::string& path) {
    struct stat target {};
    if (::stat(path.c_str(), &target) != 0 || S_ISDIR(target.st_mode))
        return std::nullopt;
    if (S_ISREG(target.st_mode) && ownOutput(target) < 0)
        return std::nullopt;
    return target;
}

}  // namespace

absl::StatusOr<OutputFile> OutputFile::create(const std::string& path, std::stop_token stop) {
    if (const auto target = inItsPlace(path)) {
        const int own = ownOutput(*target);
        const int fd = own >= 0 ? ::fcntl(own, F_DUPFD_CLOEXEC, 0)
                                : ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
        if (fd < 0)
            return fabric::writeError(path, "cannot open it", errno);
        OutputFile file(path, {}, fd);
        file.isPipe_ = S_ISFIFO(target->st_mode);
        file.stop_ = std::move(stop);
        return file;
    }
    RETURN_IF_ERROR(fabric::checkReplaceable(path));
    ASSIGN_OR_RETURN(fabric::PartialFile partial, fabric::createPartial(path));
    return OutputFile(path, std::move(partial.path), partial.fd);
}

absl::Status OutputFile::check(const std::string& path) {
    if (!inItsPlace(path))
        return create(path).status();
    if (::access(path.c_str(), W_OK) != 0)
        return fabric::writeError(path, "cannot open it", errno);
    return absl::OkStatus();
}

absl::StatusOr<OutputFile> OutputFile::createUnnamed(const std::string& path) {
    std::string name = fabric::nameBeside(path, ".scratch-XXXXXX");
    const int fd = ::mkostemp(name.data(), O_CLOEXEC);
    if (fd < 0)
        return fabric::writeError(path, "cannot create a scratch file beside it", errno);
    ::unlink(name.c_str());
    return OutputFile(path, {}, fd, true);
}

OutputFile::~OutputFile() {
    if (fd_ < 0)
        return;
    if (!partialPath_.empty())
        ::unlink(partialPath_.c_str());
    ::close(fd_);
}

/// Until a pipe takes PIPE_BUF bytes without waiting. Stop signals are blocked, so that nothing
/// would end a write that waits.
absl::Status OutputFile::awaitRoom() const {
    pollfd room{fd_, POLLOUT, 0};
    while (::poll(&room, 1, kPollMilliseconds) <= 0)
        if (stop_.stop_requested())
            return absl::CancelledError(
                fmt::format("{}: stopped while nobody read on from this pipe", path_));
    return absl::OkStatus();
}

absl::Status OutputFile::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        if (isPipe_)
            RETURN_IF_ERROR(awaitRoom());
        const std::size_t atOnce =
            isPipe_ ? std::min<std::size_t>(PIPE_BUF, bytes.size()) : bytes.size();
        const ssize_t written = ::write(fd_, bytes.data(), atOnce);
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
        if (written < 0 && errno == ESPIPE)
            return absl::InvalidArgumentError(fmt::format(
                "{}: is a pipe, and this is not written from front to back; name a file", path_));
        if (written < 0)
            return fabric::writeError(
                path_, isUnnamed_ ? "cannot write a scratch file beside it" : "cannot write it",
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
    if (partialPath_.empty()) {
        ::close(std::exchange(fd_, -1));
        return absl::OkStatus();
    }
    if (::fsync(fd_) != 0)
        return fabric::writeError(path_, "cannot flush it to the disk", errno);
    if (::rename(partialPath_.c_str(), path_.c_str()) != 0)
        return fabric::writeError(path_, "cannot put it in place", errno);
    ::close(std::exchange(fd_, -1));
    return absl::OkStatus();
}

}  // namespace eyrie::mesh
