// SPDX-License-Identifier: Apache-2.0
#include "renderer/page/disk_cache.h"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fabric/log.h"
#include "fabric/status.h"
#include "renderer/page/cache_ledger.h"

namespace eyrie::page {
namespace {

namespace fs = std::filesystem;

std::string textOf(const absl::Status& status) {
    return {status.message().data(), status.message().size()};
}

bool readAll(int file, std::span<std::byte> into) {
    while (!into.empty()) {
        const ssize_t got = ::read(file, into.data(), into.size());
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        into = into.subspan(static_cast<std::size_t>(got));
    }
    return true;
}

absl::Status writeFile(const fs::path& path, std::span<const std::byte> bytes) {
    const Descriptor file(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (file.get() < 0)
        return fabric::writeError(path.string(), "cannot create it", errno);
    while (!bytes.empty()) {
        const ssize_t put = ::write(file.get(), bytes.data(), bytes.size());
        if (put < 0 && errno == EINTR)
            continue;
        if (put < 0)
            return fabric::writeError(path.string(), "cannot write it", errno);
        bytes = bytes.subspan(static_cast<std::size_t>(put));
    }
    return absl::OkStatus();
}

absl::Status moveTo(const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::create_directories(to.parent_path(), error);
    fs::rename(from, to, error);
    return error ? fabric::writeError(to.string(), "cannot put it there", error.value())
                 : absl::OkStatus();
}

}  // namespace

DiskCache::DiskCache(fs::path folder, std::uint64_t limitBytes)
    : folder_(std::move(folder)), limitBytes_(limitBytes) {}

void DiskCache::warnOnce(const std::string& why) {
    if (!hasWarned_.exchange(true))
        spdlog::warn("{}; remote data are drawn without being kept on this disk", why);
}

bool DiskCache::find(const CacheKey& key, std::span<std::byte> into) const {
    const Descriptor file(open(pathOf(key).c_str(), O_RDONLY | O_CLOEXEC));
    struct stat info {};
    if (file.get() < 0 || fstat(file.get(), &info) != 0 ||
        static_cast<std::uint64_t>(info.st_size) != into.size() || !readAll(file.get(), into))
        return false;
    futimens(file.get(), nullptr);  // now; what is used last goes last
    return true;
}

std::uint64_t DiskCache::sizeOf(const CacheKey& key) const {
    std::error_code error;
    const std::uint64_t bytes = fs::file_size(pathOf(key), error);
    return error ? 0 : bytes;
}

void DiskCache::store(const CacheKey& key, std::span<const std::byte> bytes) {
    absl::StatusOr<CacheLedger> ledger = CacheLedger::lock(folder_);
    if (!ledger.ok())
        return warnOnce(textOf(ledger.status()));
    if (!hasCounted_.exchange(true))
        ledger->count();
    ledger->remove(pathOf(key));
    if (!ledger->makeRoom(bytes.size(), limitBytes_))
        return;
    const fs::path partial = partialPath(folder_);
    absl::Status status = writeFile(partial, bytes);
    if (status.ok())
        status = moveTo(partial, pathOf(key));
    if (status.ok())
        return ledger->add(bytes.size());
    std::error_code ignored;
    fs::remove(partial, ignored);
    warnOnce(textOf(status));
}

void DiskCache::drop(const CacheKey& key) {
    if (absl::StatusOr<CacheLedger> ledger = CacheLedger::lock(folder_); ledger.ok())
        ledger->remove(pathOf(key));
}

void DiskCache::dropGroup(const std::string& group) {
    absl::StatusOr<CacheLedger> ledger = CacheLedger::lock(folder_);
    if (!ledger.ok())
        return;
    std::error_code ignored;
    fs::remove_all(folder_ / group, ignored);
    ledger->count();
}

}  // namespace eyrie::page
