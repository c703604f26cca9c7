// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/resident_memory.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
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

void resetPeakResidentBytes() {
    for (const int id : processes()) std::ofstream(fmt::format("/proc/{}/clear_refs", id)) << "5";
}

}  // namespace eyrie::cli::bench
