// SPDX-License-Identifier: Apache-2.0
#include "fabric/partial_file.h"

#include <cerrno>
#include <cstdint>
#include <random>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "fabric/name_beside.h"
#include "fabric/status.h"
#include "fabric/writer_lock.h"

namespace eyrie::fabric {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = ".partial-";
constexpr std::size_t kDigits = 16;

std::string endingOf(std::uint64_t number) {
    return fmt::format("{}{:0{}x}", kMark, number, kDigits);
}

/// What the name of a partial file has before its mark: its file's name, unless that is too long.
/// Empty where it is none.
std::string_view beginningOf(std::string_view name) {
    const std::size_t mark = name.rfind(kMark);
    if (mark == std::string_view::npos)
        return {};
    const std::string_view digits = name.substr(mark + kMark.size());
    if (digits.size() != kDigits ||
        digits.find_first_not_of("0123456789abcdef") != std::string_view::npos)
        return {};
    return name.substr(0, mark);
}

void removeIfAbandoned(const fs::path& partial) {
    const int fd = open(partial.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
    if (fd < 0)
        return;
    if (takeWriterLock(partial.string(), fd) == WriterLock::Taken)
        unlink(partial.c_str());
    close(fd);
}

/// `beginning`: of which names; empty: of any.
void removeAbandonedIn(const fs::path& folder, std::string_view beginning) {
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        const std::string_view own = beginningOf(name);
        if (!own.empty() && (beginning.empty() || own == beginning))
            removeIfAbandoned(entry->path());
    }
}

}  // namespace

/// Between its making and its lock another writer may take a file for abandoned and remove it: then
/// one of another name is made.
absl::StatusOr<PartialFile> createPartial(const std::string& path) {
    constexpr int kTries = 16;
    removeAbandoned(path);
    std::random_device random;
    for (int i = 0; i < kTries; ++i) {
        const std::uint64_t number = std::uint64_t{random()} << 32 | random();
        std::string partial = nameBeside(path, endingOf(number));
        const int fd = open(partial.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd < 0)
            return writeError(path, "cannot create it", errno);
        // Where a file system has no locks, nobody can take it for abandoned either.
        if (mayWrite(takeWriterLock(partial, fd)))
            return PartialFile{std::move(partial), fd};
        unlink(partial.c_str());
        close(fd);
    }
    return absl::UnavailableError(fmt::format(
        "{}: other processes take its partial files for abandoned; run the same command "
        "again",
        path));
}

void removeAbandoned(const std::string& path) {
    const fs::path whole = fs::absolute(path);
    const std::string any = nameBeside(whole.filename().string(), endingOf(0));
    removeAbandonedIn(whole.parent_path(), beginningOf(any));
}

void removeAllAbandoned(const fs::path& folder) { removeAbandonedIn(folder, {}); }

}  // namespace eyrie::fabric
