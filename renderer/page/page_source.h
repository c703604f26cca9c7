// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/page/byte_source.h"
#include "renderer/page/disk_cache.h"

namespace eyrie::page {

/// Part of a file, and the XXH64 of its bytes.
struct Block {
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;
    std::uint64_t checksum = 0;
};

/// How remote files are read. The default reads everything from the server each time.
struct SourceOptions {
    std::shared_ptr<DiskCache> cache;  ///< of remote files only
};

/// With a cache in `folder`; without one where `folder` is empty.
SourceOptions sourceOptions(const std::filesystem::path& folder, std::uint64_t limitBytes);

/// Reads a data file by parts that have checksums, wherever the file lies: a path of this machine,
/// or an address (remote_name.h), whose parts are kept in a cache. Any thread may read at any time.
///
/// The first bytes of a file, its header, tell one version of it from another. They are asked of
/// the server when the file is opened; parts are then looked for among those that were kept of a
/// file of this name, size and header. Without a server, what was kept serves.
class PageSource {
public:
    /// Reads the first `headBytes` of the file, or all of it where it is shorter. Errors: those of
    /// ByteSource::read.
    static absl::StatusOr<std::unique_ptr<PageSource>> open(const std::string& path,
                                                            std::size_t headBytes,
                                                            const SourceOptions& options);

    const std::string& name() const { return name_; }
    std::uint64_t sizeBytes() const { return bytes_->sizeBytes(); }
    std::span<const std::byte> head() const { return head_; }

    /// Fills `into`, of block.bytes; `what` names the part in messages. Errors: those of
    /// ByteSource::read; DataLoss (its checksum is wrong, or the file has changed on the server).
    absl::Status read(const Block& block, std::span<std::byte> into, const std::string& what) const;

private:
    PageSource(std::string name, std::unique_ptr<ByteSource> bytes, std::vector<std::byte> head,
               std::shared_ptr<DiskCache> cache);

    static absl::StatusOr<std::unique_ptr<PageSource>> openRemote(const std::string& url,
                                                                  std::size_t headBytes,
                                                                  const SourceOptions& options);
    absl::Status naming(const std::string& what, const absl::Status& status) const;
    absl::Status checkHead() const;
    void forget() const;

    const std::string name_;
    const std::unique_ptr<ByteSource> bytes_;
    const std::vector<std::byte> head_;
    const std::shared_ptr<DiskCache> cache_;  ///< null: none
    const std::string group_;
};

}  // namespace eyrie::page
