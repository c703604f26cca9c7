// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/resident_memory.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>
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

/// How a version of control groups calls what it has.
struct ControlGroupFiles {
    const char* limit;
    const char* used;
    const char* statistics;
    const char* cached;  ///< there: of files, and given back when memory is wanted
};
constexpr std::array kControlGroups = {
    ControlGroupFiles{"memory.max", "memory.current", "memory.stat", "inactive_file"},
    ControlGroupFiles{"memory/memory.limit_in_bytes", "memory/memory.usage_in_bytes",
                      "memory/memory.stat", "total_inactive_file"}};

constexpr const char* kControlGroupFolder = "/sys/fs/cgroup/";

/// 0 where there is no such line.
std::uint64_t lineOf(const std::string& path, std::string_view name) {
    std::ifstream file(path);
    std::uint64_t value = 0;
    for (std::string word; file >> word >> value;)
        if (word == name)
            return value;
    return 0;
}

}  // namespace

std::uint64_t leftInControlGroup(const std::string& folder) {
    for (const ControlGroupFiles& files : kControlGroups) {
        std::uint64_t limit = 0;
        std::uint64_t used = 0;
        if (!(std::ifstream(folder + files.limit) >> limit &&
              std::ifstream(folder + files.used) >> used))
            continue;
        used -= std::min(used, lineOf(folder + files.statistics, files.cached));
        return limit > used ? limit - used : 0;
    }
    return std::numeric_limits<std::uint64_t>::max();
}

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
            return std::min(kibibytes << 10, leftInControlGroup(kControlGroupFolder));
    }
    return leftInControlGroup(kControlGroupFolder);
}

void resetPeakResidentBytes() {
    malloc_trim(0);
    for (const int id : processes()) std::ofstream(fmt::format("/proc/{}/clear_refs", id)) << "5";
}

}  // namespace eyrie::cli::bench
