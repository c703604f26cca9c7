// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include <absl/status/statusor.h>

namespace eyrie::mesh {

/// A file's bytes, mapped for reading. Replace a mapped file by renaming another over it, as
/// OutputFile does: the mapping then keeps the old bytes. Any thread may read.
class MappedFile {
public:
    /// Errors: NotFound, PermissionDenied, InvalidArgument (a folder, a pipe), Unavailable.
    static absl::StatusOr<MappedFile> open(const std::string& path);

    MappedFile(MappedFile&& other) noexcept
        : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
    MappedFile& operator=(MappedFile&& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        return *this;
    }
    ~MappedFile();

    std::span<const std::byte> bytes() const {
        return {static_cast<const std::byte*>(data_), size_};
    }

    /// What lies before `end` need not stay in memory: should it be read again, the system fetches
    /// it again.
    void forget(std::size_t end) const;

private:
    MappedFile(void* data, std::size_t size) : data_(data), size_(size) {}

    void* data_;
    std::size_t size_;
};

}  // namespace eyrie::mesh
