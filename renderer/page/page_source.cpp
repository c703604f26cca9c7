// SPDX-License-Identifier: Apache-2.0
#include "renderer/page/page_source.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>
#include <xxhash.h>

#include "fabric/log.h"
#include "fabric/status.h"
#include "renderer/page/remote_name.h"

namespace eyrie::page {
namespace {

std::string hexHash(std::span<const std::byte> bytes) {
    const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

/// Where the size and the head of the version of `url` seen last are kept: a group of its own, so
/// that it outlives what is dropped of a version.
CacheKey headKey(const std::string& url) {
    return {"head", hexHash(std::as_bytes(std::span(url)))};
}

std::string groupOf(const std::string& url, std::uint64_t size, std::span<const std::byte> head) {
    std::vector<std::byte> all(head.begin(), head.end());
    const std::string name = fmt::format("{} {}", size, url);
    const auto bytes = std::as_bytes(std::span(name));
    all.insert(all.end(), bytes.begin(), bytes.end());
    return hexHash(all);
}

CacheKey partKey(const std::string& group, const Block& block) {
    return {group, fmt::format("{}-{}", block.offset, block.bytes)};
}

struct Head {
    std::uint64_t size = 0;
    std::vector<std::byte> bytes;
};

void storeHead(DiskCache& cache, const std::string& url, const Head& head) {
    std::vector<std::byte> kept(sizeof head.size);
    std::memcpy(kept.data(), &head.size, sizeof head.size);
    kept.insert(kept.end(), head.bytes.begin(), head.bytes.end());
    std::vector<std::byte> before(kept.size());
    if (!cache.find(headKey(url), before) || before != kept)
        cache.store(headKey(url), kept);
}

std::optional<Head> keptHead(const DiskCache& cache, const std::string& url, std::size_t most) {
    std::vector<std::byte> kept(cache.sizeOf(headKey(url)));
    Head head;
    if (kept.size() < sizeof head.size || kept.size() > sizeof head.size + most ||
        !cache.find(headKey(url), kept))
        return std::nullopt;
    std::memcpy(&head.size, kept.data(), sizeof head.size);
    head.bytes.assign(kept.begin() + sizeof head.size, kept.end());
    return head;
}

absl::StatusOr<std::vector<std::byte>> readHead(const ByteSource& file, std::size_t most) {
    std::vector<std::byte> head(
        static_cast<std::size_t>(std::min<std::uint64_t>(most, file.sizeBytes())));
    RETURN_IF_ERROR(file.read(0, head));
    return head;
}

bool isIntact(std::span<const std::byte> bytes, const Block& block) {
    return XXH64(bytes.data(), bytes.size(), 0) == block.checksum;
}

}  // namespace

SourceOptions sourceOptions(const std::filesystem::path& folder, std::uint64_t limitBytes) {
    return {folder.empty() ? nullptr : std::make_shared<DiskCache>(folder, limitBytes)};
}

PageSource::PageSource(std::string name, std::unique_ptr<ByteSource> bytes,
                       std::vector<std::byte> head, std::shared_ptr<DiskCache> cache)
    : name_(std::move(name)),
      bytes_(std::move(bytes)),
      head_(std::move(head)),
      cache_(std::move(cache)),
      group_(groupOf(name_, bytes_->sizeBytes(), head_)) {}

absl::StatusOr<std::unique_ptr<PageSource>> PageSource::open(const std::string& path,
                                                             std::size_t headBytes,
                                                             const SourceOptions& options) {
    RETURN_IF_ERROR(checkScheme(path));
    if (isVirtual(path))
        return openRemote(path, headBytes, options);
    ASSIGN_OR_RETURN(std::unique_ptr<ByteSource> file, openLocalFile(path));
    ASSIGN_OR_RETURN(std::vector<std::byte> head, readHead(*file, headBytes));
    return std::unique_ptr<PageSource>(
        new PageSource(path, std::move(file), std::move(head), nullptr));
}

absl::StatusOr<std::unique_ptr<PageSource>> PageSource::openRemote(const std::string& url,
                                                                   std::size_t headBytes,
                                                                   const SourceOptions& options) {
    absl::StatusOr<std::unique_ptr<ByteSource>> file = openRemoteFile(url);
    absl::Status status = file.status();
    if (file.ok()) {
        absl::StatusOr<std::vector<std::byte>> head = readHead(**file, headBytes);
        if (head.ok()) {
            if (options.cache)
                storeHead(*options.cache, url, {(*file)->sizeBytes(), *head});
            return std::unique_ptr<PageSource>(
                new PageSource(url, *std::move(file), *std::move(head), options.cache));
        }
        status = head.status();
    }
    std::optional<Head> kept;
    if (absl::IsUnavailable(status) && options.cache)
        kept = keptHead(*options.cache, url, headBytes);
    if (!kept)
        return status;
    spdlog::warn("{}; meanwhile what is kept of it on this disk is used",
                 std::string_view(status.message().data(), status.message().size()));
    return std::unique_ptr<PageSource>(new PageSource(url, awaitRemoteFile(url, kept->size),
                                                      std::move(kept->bytes), options.cache));
}

absl::Status PageSource::read(const Block& block, std::span<std::byte> into,
                              const std::string& what) const {
    if (cache_ && cache_->find(partKey(group_, block), into)) {
        if (isIntact(into, block))
            return absl::OkStatus();
        cache_->drop(partKey(group_, block));
    }
    if (const absl::Status status = bytes_->read(block.offset, into); !status.ok())
        return naming(what, status);
    if (isIntact(into, block)) {
        if (cache_)
            cache_->store(partKey(group_, block), into);
        return absl::OkStatus();
    }
    RETURN_IF_ERROR(checkHead());
    return absl::DataLossError(
        fmt::format("{}: {}: its checksum is wrong; import or copy the file again", name_, what));
}

/// `status` of a ByteSource, whose message begins with the file's name, with `what` after that.
absl::Status PageSource::naming(const std::string& what, const absl::Status& status) const {
    const std::string_view message(status.message().data(), status.message().size());
    return absl::Status(status.code(),
                        fmt::format("{}: {}{}", name_, what, message.substr(name_.size())));
}

/// Whether a remote file still is the one that was opened; if not, what is kept of it goes.
absl::Status PageSource::checkHead() const {
    if (!isRemote(name_))
        return absl::OkStatus();
    std::vector<std::byte> head(head_.size());
    RETURN_IF_ERROR(bytes_->read(0, head));
    if (head == head_)
        return absl::OkStatus();
    forget();
    return absl::DataLossError(fmt::format(
        "{}: has changed on the server since it was opened; open the scene again", name_));
}

void PageSource::forget() const {
    if (!cache_)
        return;
    cache_->drop(headKey(name_));
    cache_->dropGroup(group_);
}

}  // namespace eyrie::page
