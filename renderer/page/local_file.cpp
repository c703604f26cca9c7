// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "renderer/page/byte_source.h"

namespace eyrie::page {
namespace {

class LocalFile final : public ByteSource {
public:
    LocalFile(std::string path, int fd) : path_(std::move(path)), fd_(fd) {}
    ~LocalFile() override { close(fd_); }
    LocalFile(const LocalFile&) = delete;
    LocalFile& operator=(const LocalFile&) = delete;

    absl::Status readSize() {
        struct stat info {};
        if (fstat(fd_, &info) != 0 || !S_ISREG(info.st_mode))
            return absl::InvalidArgumentError(fmt::format("{}: is not a regular file", path_));
        sizeBytes_ = static_cast<std::uint64_t>(info.st_size);
        return absl::OkStatus();
    }

    std::uint64_t sizeBytes() const override { return sizeBytes_; }

    absl::Status read(std::uint64_t offset, std::span<std::byte> into) const override {
        while (!into.empty()) {
            const ssize_t got = pread(fd_, into.data(), into.size(), static_cast<off_t>(offset));
            if (got < 0 && errno == EINTR)
                continue;
            if (got < 0)
                return absl::UnavailableError(
                    fmt::format("{}: read failed: {}", path_, std::strerror(errno)));
            if (got == 0)
                return absl::DataLossError(fmt::format(
                    "{}: the file ends before byte {}; import or copy it again", path_, offset));
            into = into.subspan(static_cast<std::size_t>(got));
            offset += static_cast<std::uint64_t>(got);
        }
        return absl::OkStatus();
    }

private:
    const std::string path_;
    const int fd_;
    std::uint64_t sizeBytes_ = 0;
};

}  // namespace

absl::StatusOr<std::unique_ptr<ByteSource>> openLocalFile(const std::string& path) {
    // O_NONBLOCK: opening a pipe that nobody writes to would wait for ever.
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0)
        return errno == ENOENT ? absl::NotFoundError(fmt::format("{}: no such file", path))
                               : absl::InvalidArgumentError(fmt::format(
                                     "{}: cannot be opened: {}", path, std::strerror(errno)));
    auto file = std::make_unique<LocalFile>(path, fd);
    if (absl::Status status = file->readSize(); !status.ok())
        return status;
    return file;
}

}  // namespace eyrie::page
