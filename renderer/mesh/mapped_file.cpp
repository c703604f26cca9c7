// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/mapped_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <absl/status/status.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace eyrie::mesh {
namespace {

absl::Status systemError(const std::string& path, const char* action, int error) {
    const std::string message = fmt::format("{}: cannot {}: {}", path, action, strerror(error));
    if (error == ENOENT || error == ENOTDIR)
        return absl::NotFoundError(message);
    if (error == EACCES || error == EPERM)
        return absl::PermissionDeniedError(message);
    return absl::UnavailableError(message);
}

/// Closes on every way out; a mapping outlives its descriptor.
class Descriptor {
public:
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor() {
        if (fd_ >= 0)
            ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return fd_; }

private:
    int fd_;
};

}  // namespace

absl::StatusOr<MappedFile> MappedFile::open(const std::string& path) {
    // O_NONBLOCK: opening a pipe that nobody writes to would wait for ever.
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.get() < 0)
        return systemError(path, "open it", errno);
    struct stat info {};
    if (::fstat(file.get(), &info) != 0)
        return systemError(path, "read its size", errno);
    if (!S_ISREG(info.st_mode))
        return absl::InvalidArgumentError(
            fmt::format("{}: is a folder or device, expected a file; name a file", path));
    const auto size = static_cast<std::size_t>(info.st_size);
    if (size == 0)
        return MappedFile(nullptr, 0);
    void* data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.get(), 0);
    if (data == MAP_FAILED)
        return systemError(path, "map it", errno);
    return MappedFile(data, size);
}

void MappedFile::forget(std::size_t end) const {
    const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    if (const std::size_t whole = std::min(end, size_) / page * page; whole > 0)
        ::madvise(data_, whole, MADV_DONTNEED);
}

MappedFile::~MappedFile() {
    if (data_ != nullptr)
        ::munmap(data_, size_);
}

}  // namespace eyrie::mesh
