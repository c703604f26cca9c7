// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/resident_memory.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

namespace eyrie::cli::bench {
namespace {

/// This process and its children; without them where the kernel does not list them.
std::vector<int> processes() {
    std::vector<int> ids{getpid()};
    std::error_code ignored;
    for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task", ignored)) {
        std::ifstream children(thread.path() / "children");
        for (int id = 0; children >> id;) ids.push_back(id);
    }
    return ids;
}

/// What is left of a control group's limit; the largest number where it has none.
std::uint64_t leftInControlGroup() {
    std::uint64_t limit = 0;
    std::uint64_t used = 0;
    if (std::ifstream("/sys/fs/cgroup/memory.max") >> limit &&
        std::ifstream("/sys/fs/cgroup/memory.current") >> used)
        return limit > used ? limit - used : 0;
    return std::numeric_limits<std::uint64_t>::max();
}

}  // namespace

std::uint64_t peakResidentBytes() {
    std::uint64_t sum = 0;
    for (const int id : processes()) {
        std::ifstream status(fmt::format("/proc/{}/status", id));
        for (std::string word; status >> word;) {
            std::uint64_t kibibytes = 0;
            if (word == "VmHWM:" && status >> kibibytes)
                sum += kibibytes << 10;
        }
    }
    return sum;
}

std::uint64_t availableBytes() {
    std::ifstream meminfo("/proc/meminfo");
    for (std::string word; meminfo >> word;) {
        std::uint64_t kibibytes = 0;
        if (word == "MemAvailable:" && meminfo >> kibibytes)
            return std::min(kibibytes << 10, leftInControlGroup());
    }
    return leftInControlGroup();
}

void resetPeakResidentBytes() {
    malloc_trim(0);
    for (const int id : processes()) std::ofstream(fmt::format("/proc/{}/clear_refs", id)) << "5";
}

}  // namespace eyrie::cli::bench
