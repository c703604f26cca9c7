// SPDX-License-Identifier: Apache-2.0
#include "renderer/page/cache_ledger.h"

#include <algorithm>
#include <cerrno>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "fabric/status.h"

namespace eyrie::page {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLock = "lock";
constexpr std::string_view kPartial = "partial";

struct Part {
    fs::path path;
    std::uint64_t bytes;
    fs::file_time_type used;
};

/// Of all groups.
struct Parts {
    std::vector<Part> parts;
    std::uint64_t bytes = 0;
};

void addGroup(const fs::path& group, Parts& parts) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(group, error)) {
        const std::uint64_t bytes = entry.file_size(error);
        if (error)
            continue;
        const fs::file_time_type used = entry.last_write_time(error);
        if (error)
            continue;
        parts.parts.push_back({entry.path(), bytes, used});
        parts.bytes += bytes;
    }
}

/// The ledger is locked, so a part that is being written is one whose writer was killed.
Parts partsIn(const fs::path& folder) {
    Parts parts;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename().string();
        if (entry.is_directory(error))
            addGroup(entry.path(), parts);
        else if (name == kPartial)
            fs::remove(entry.path(), error);
    }
    return parts;
}

}  // namespace

Descriptor::~Descriptor() {
    if (fd_ >= 0)
        close(fd_);
}

absl::StatusOr<CacheLedger> CacheLedger::lock(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    const std::string path = (folder / kLock).string();
    Descriptor file(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
    if (file.get() < 0)
        return fabric::writeError(path, "cannot open it", errno);
    while (flock(file.get(), LOCK_EX) != 0)
        if (errno != EINTR)
            return fabric::writeError(path, "cannot lock it", errno);
    return CacheLedger(folder, std::move(file));
}

CacheLedger::CacheLedger(fs::path folder, Descriptor file)
    : folder_(std::move(folder)), file_(std::move(file)) {
    if (pread(file_.get(), &total_, sizeof total_, 0) != sizeof total_)
        count();
}

void CacheLedger::count() {
    total_ = partsIn(folder_).bytes;
    write();
}

bool CacheLedger::makeRoom(std::uint64_t bytes, std::uint64_t limitBytes) {
    if (bytes > limitBytes)
        return false;
    if (total_ <= limitBytes - bytes)
        return true;
    Parts there = partsIn(folder_);
    total_ = there.bytes;
    std::sort(there.parts.begin(), there.parts.end(),
              [](const Part& a, const Part& b) { return a.used < b.used; });
    // Somewhat more than must go, so that not every part stored costs a look at all of them.
    const std::uint64_t goal = (limitBytes - bytes) / 8 * 7;
    for (const Part& part : there.parts) {
        if (total_ <= goal)
            break;
        std::error_code error;
        if (fs::remove(part.path, error)) {
            total_ -= part.bytes;
            fs::remove(part.path.parent_path(), error);  // when it was the last of its group
        }
    }
    write();
    return total_ <= limitBytes - bytes;
}

void CacheLedger::add(std::uint64_t bytes) {
    total_ += bytes;
    write();
}

void CacheLedger::remove(const fs::path& part) {
    std::error_code error;
    const std::uint64_t bytes = fs::file_size(part, error);
    if (error || !fs::remove(part, error))
        return;
    total_ -= std::min(total_, bytes);
    write();
}

/// If the disk is too full even for this, the next process counts anew.
void CacheLedger::write() const {
    if (pwrite(file_.get(), &total_, sizeof total_, 0) != sizeof total_)
        std::ignore = ftruncate(file_.get(), 0);
}

fs::path partialPath(const fs::path& folder) { return folder / kPartial; }

}  // namespace eyrie::page
