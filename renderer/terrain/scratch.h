// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <unordered_map>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

namespace eyrie::terrain {

/// Pieces of bytes that are kept in memory while they fit in a budget, and in a file beyond: the
/// least recently used go to the file first. What fits never touches the disk.
///
/// Any thread may read and write any piece. A failure of the disk is kept: reads then give zeros,
/// and status() says what happened; whoever fills or uses a scratch looks there before going on.
/// What was never written reads as zeros, too. In the file each piece has a checksum behind it:
/// that there is something else than what was written, or that the file is shorter, is a failure,
/// DataLoss. Zeros over a piece and its checksum, as of a hole punched into the file, are not told
/// from what was never written.
class Scratch {
public:
    using Piece = std::shared_ptr<const std::byte[]>;

    /// The file `path` is made when the first piece leaves memory.
    Scratch(std::string path, std::uint64_t budgetBytes);
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    /// Leaves the file where it is.
    ~Scratch();

    /// Room for pieces of `bytes` each, as the place of the first one; the others follow, each
    /// stride(bytes) farther. The same calls give the same places.
    std::uint64_t reserve(std::size_t bytes, std::uint64_t pieces = 1);
    static constexpr std::uint64_t stride(std::size_t bytes) {
        return bytes + sizeof(std::uint64_t);
    }
    /// Goes on with the file of an earlier scratch, whose last flush said that it has `bytes`.
    /// False where it does not: it is of no use, and not read. Before any piece is read or written.
    bool takeUp(std::uint64_t bytes);
    /// All that was reserved fits in memory.
    bool fitsInMemory() const { return reserved_ <= budget_; }
    /// Adds to the budget. While no other thread reads or writes.
    void grow(std::uint64_t bytes) { budget_ += bytes; }

    /// Memory for a piece to be written. Goes back to the system page by page when nobody holds it:
    /// a heap would keep what pieces of different sizes leave between them.
    static std::shared_ptr<std::byte[]> newPiece(std::size_t bytes);

    Piece read(std::uint64_t place, std::size_t bytes);
    void write(std::uint64_t place, Piece data, std::size_t bytes);
    /// Writes zeros, which take room neither in memory nor, where it has never held anything else,
    /// in the file.
    void clear(std::uint64_t place, std::size_t bytes);
    /// Leaves out of memory, and of what is still to be stored, a piece that nobody reads again.
    void forget(std::uint64_t place);
    /// Brings every piece to the disk, not only the ones that did not fit. Meanwhile other threads
    /// may read and write others, but write none again that was written before. Returns how many
    /// bytes the file has on the disk.
    absl::StatusOr<std::uint64_t> flush();
    absl::Status status() const;

    const std::string& path() const { return path_; }

private:
    struct Entry {
        std::uint64_t place;
        Piece data;
        std::size_t bytes;
        bool isDirty;
    };
    struct Shard {
        std::mutex mutex;
        std::list<Entry> byUse;  ///< most recent first
        std::unordered_map<std::uint64_t, std::list<Entry>::iterator> byPlace;
        std::uint64_t bytes = 0;
    };
    static constexpr std::size_t kShards = 16;

    Shard& shardOf(std::uint64_t place) { return shards_[place * 0x9e3779b97f4a7c15 >> 60]; }
    void drop(Shard& shard, std::uint64_t place);
    void storeDirty(Shard& shard);
    void keep(Shard& shard, Entry entry);
    void store(std::uint64_t place, const Piece& data, std::size_t bytes);
    void storeBytes(std::uint64_t place, std::span<const std::byte> bytes);
    void load(std::uint64_t place, std::span<std::byte> out);
    void loadBytes(std::uint64_t place, std::span<std::byte> out);
    int file(int flags = 0);
    void fail(const char* what);
    void fail(absl::Status status);

    const std::string path_;
    std::uint64_t budget_;
    std::uint64_t reserved_ = 0;
    std::array<Shard, kShards> shards_;
    mutable std::mutex fileMutex_;  ///< guards opening, and status_
    std::atomic<int> fd_ = -1;
    std::atomic<std::uint64_t> stored_ = 0;  ///< bytes that the file has at least
    std::atomic<bool> hasFailed_ = false;
    absl::Status status_;
};

}  // namespace eyrie::terrain
