// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/file_hash.h"

#include <array>
#include <cstddef>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string_view>
#include <system_error>
#include <vector>

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include "fabric/status.h"
#include "renderer/import/raster_file.h"
#include "renderer/import/whole_file.h"
#include "renderer/page/remote_name.h"

namespace eyrie::import {
namespace {

constexpr std::string_view kNamed = "hash-";

/// Which file, and which version of it: no change leaves ctime as it was.
struct FileState {
    std::uint64_t inode = 0;
    std::uint64_t bytes = 0;
    std::array<std::int64_t, 2> changed{};   ///< ctime: seconds, nanoseconds
    std::array<std::int64_t, 2> modified{};  ///< mtime

    bool operator==(const FileState&) const = default;
};

struct Note {
    std::array<char, 8> magic = {'E', 'Y', 'R', 'I', 'E', 'H', 'S', 'H'};
    FileState file;
    std::uint64_t hash = 0;
    std::uint64_t checksum = 0;
};
static_assert(sizeof(Note) == 72, "no padding");

std::uint64_t checksumOf(const Note& note) { return XXH64(&note, offsetof(Note, checksum), 0); }

/// None of what is no file on a disk, or so small that reading it is as quick as a note.
std::optional<FileState> stateOf(const std::string& path) {
    constexpr std::uint64_t kFewBytes = 16 << 20;
    struct stat status {};
    if (stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode) ||
        static_cast<std::uint64_t>(status.st_size) < kFewBytes)
        return std::nullopt;
    return FileState{status.st_ino,
                     static_cast<std::uint64_t>(status.st_size),
                     {status.st_ctim.tv_sec, status.st_ctim.tv_nsec},
                     {status.st_mtim.tv_sec, status.st_mtim.tv_nsec}};
}

/// Whether a change from now on has another time than the last one: the clock that files have their
/// times from moves on every few milliseconds only.
bool showsChanges(const FileState& file) {
    timespec now{};
    clock_gettime(CLOCK_REALTIME_COARSE, &now);
    return std::array<std::int64_t, 2>{now.tv_sec, now.tv_nsec} > file.changed;
}

std::string pathOf(const FileState& file, const std::string& folder) {
    return fmt::format("{}/{}{:016x}", folder, kNamed, XXH64(&file, sizeof file, 0));
}

std::optional<std::uint64_t> noted(const FileState& state, const std::string& folder) {
    std::ifstream file(pathOf(state, folder), std::ios::binary);
    Note note;
    const Note expected;
    if (!file.read(reinterpret_cast<char*>(&note), sizeof note) || note.magic != expected.magic ||
        note.checksum != checksumOf(note) || note.file != state)
        return std::nullopt;
    return note.hash;
}

absl::Status leave(const FileState& file, const std::string& folder, std::uint64_t hash) {
    Note note{.file = file, .hash = hash};
    note.checksum = checksumOf(note);
    ASSIGN_OR_RETURN(WholeFile out, WholeFile::create(pathOf(file, folder)));
    RETURN_IF_ERROR(out.append(std::as_bytes(std::span(&note, 1))));
    return out.commit();
}

/// Of fewer bytes than the file has: GDAL says of no read whether it failed or the file ended.
absl::Status cutShort(const std::string& path, std::uint64_t got, std::uint64_t all) {
    return absl::Status(
        page::isRemote(path) ? absl::StatusCode::kUnavailable : absl::StatusCode::kDataLoss,
        fmt::format("{}: {} of its {} bytes came; {}", path, got, all, whyUnreadable(path)));
}

absl::StatusOr<std::uint64_t> hashOfBytes(const std::string& path, const std::stop_token& stop) {
    const std::unique_ptr<VSILFILE, Releaser<VSIFCloseL>> file(VSIFOpenL(path.c_str(), "rb"));
    if (!file) {
        RETURN_IF_ERROR(checkOpenFiles(path));
        return absl::NotFoundError(fmt::format("{}: no such file, or not readable", path));
    }
    VSIFSeekL(file.get(), 0, SEEK_END);
    const std::uint64_t all = VSIFTellL(file.get());
    VSIFSeekL(file.get(), 0, SEEK_SET);
    const std::unique_ptr<XXH64_state_t, Releaser<XXH64_freeState>> state(XXH64_createState());
    XXH64_reset(state.get(), 0);
    std::vector<char> buffer(std::size_t{1} << 20);
    std::uint64_t bytes = 0;
    while (const std::size_t got = VSIFReadL(buffer.data(), 1, buffer.size(), file.get())) {
        if (stop.stop_requested())
            return absl::CancelledError("import cancelled");
        XXH64_update(state.get(), buffer.data(), got);
        bytes += got;
    }
    if (bytes < all)
        return cutShort(path, bytes, all);
    return XXH64_digest(state.get());
}

}  // namespace

absl::StatusOr<std::uint64_t> fileHash(const std::string& path, const std::string& folder,
                                       const std::stop_token& stop) {
    const std::optional<FileState> before = folder.empty() ? std::nullopt : stateOf(path);
    if (before)
        if (const std::optional<std::uint64_t> hash = noted(*before, folder))
            return *hash;
    const bool shows = before && showsChanges(*before);
    ASSIGN_OR_RETURN(const std::uint64_t hash, hashOfBytes(path, stop));
    // Not of a file that was written meanwhile. Who cannot note it has it all the same.
    if (shows && stateOf(path) == before)
        leave(*before, folder, hash).IgnoreError();
    return hash;
}

void noteHash(const std::string& path, const std::string& folder, const std::stop_token& stop) {
    if (stateOf(path))
        fileHash(path, folder, stop)
            .IgnoreError();  // what is wrong with it is found when it is opened
}

void removeNotedHashes(const std::string& folder) {
    namespace fs = std::filesystem;
    std::vector<fs::path> notes;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error))
        if (entry->path().filename().string().starts_with(kNamed))
            notes.push_back(entry->path());
    for (const fs::path& note : notes) fs::remove(note, error);
}

}  // namespace eyrie::import
