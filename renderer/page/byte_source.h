// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <absl/status/statusor.h>

namespace eyrie::page {

/// An open file, wherever it lies. Any thread may read at any time.
class ByteSource {
public:
    virtual ~ByteSource() = default;

    /// Of the file when it was opened.
    virtual std::uint64_t sizeBytes() const = 0;

    /// Fills `into` from `offset` on, in a bounded time and without a cache. Errors: DataLoss (the
    /// file ends before), Unavailable (trying again may help), and of remote files NotFound,
    /// PermissionDenied and InvalidArgument (the server cannot read ranges). Messages name the
    /// file.
    virtual absl::Status read(std::uint64_t offset, std::span<std::byte> into) const = 0;
};

/// A regular file of this machine. Errors: NotFound, InvalidArgument.
absl::StatusOr<std::unique_ptr<ByteSource>> openLocalFile(const std::string& path);

/// Whatever GDAL's virtual file systems reach (isRemote). Reads go to the server each time: nothing
/// GDAL remembers of the file is used.
///
/// A server that says nothing is given up after 5 seconds without a connection or 5 without a byte,
/// any request after 30; GDAL's configuration (GDAL_HTTP_CONNECTTIMEOUT, GDAL_HTTP_LOW_SPEED_TIME
/// and _LIMIT, GDAL_HTTP_TIMEOUT, from the environment) changes that. A read is one request for
/// each MiB, and after a failure at most one more, which asks why. Errors: those of read().
absl::StatusOr<std::unique_ptr<ByteSource>> openRemoteFile(const std::string& url);

/// A remote file that cannot be reached now and had `sizeBytes`: it is opened by the first read
/// that can.
std::unique_ptr<ByteSource> awaitRemoteFile(const std::string& url, std::uint64_t sizeBytes);

}  // namespace eyrie::page
