// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include <absl/status/statusor.h>

namespace eyrie::page {

/// What belongs together and goes together (one version of one remote file), and a part of it. Both
/// are file names.
struct CacheKey {
    std::string group;
    std::string part;
};

/// Parts of remote files in a folder, up to a limit in bytes, least recently used out first.
///
/// Any number of processes may share a folder if they give it the same limit: who writes holds a
/// lock on a file in it, which has the sum of all sizes, so the limit holds for all together and at
/// all times. A part is written beside its place and renamed, so that it is there whole or not at
/// all, even if a process is killed. Parts are as they were stored or damaged: readers check them.
/// Any thread may call anything. No failure of the disk is an error: what cannot be stored or read
/// is not there, and the log says so once.
class DiskCache {
public:
    /// Creates `folder` when something is first stored.
    DiskCache(std::filesystem::path folder, std::uint64_t limitBytes);

    /// Whether the part is there and as long as `into`, which it then fills. Counts as use.
    bool find(const CacheKey& key, std::span<std::byte> into) const;
    /// Size of the part, 0 when it is not there.
    std::uint64_t sizeOf(const CacheKey& key) const;

    /// Replaces what was there. Nothing is stored that is larger than the limit.
    void store(const CacheKey& key, std::span<const std::byte> bytes);

    void drop(const CacheKey& key);
    void dropGroup(const std::string& group);

    std::uint64_t limitBytes() const { return limitBytes_; }

private:
    std::filesystem::path pathOf(const CacheKey& key) const {
        return folder_ / key.group / key.part;
    }
    void warnOnce(const std::string& why);

    const std::filesystem::path folder_;
    const std::uint64_t limitBytes_;
    std::atomic<bool> hasCounted_{false};  ///< the sum in the lock file has been checked
    std::atomic<bool> hasWarned_{false};
};

}  // namespace eyrie::page
