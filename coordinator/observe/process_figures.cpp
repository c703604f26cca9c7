// SPDX-License-Identifier: Apache-2.0
#include "coordinator/observe/process_figures.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

namespace eyrie::observe {
namespace {

std::uint64_t entriesOf(const char* folder) {
    std::error_code error;
    const std::filesystem::directory_iterator entries(folder, error);
    return error ? 0 : static_cast<std::uint64_t>(std::distance(begin(entries), end(entries)));
}

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

}  // namespace

ProcessFigures processFigures() {
    ProcessFigures figures;
    rusage usage{};
    if (getrusage(RUSAGE_SELF, &usage) == 0)
        figures.cpuSeconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    std::uint64_t virtualPages = 0;
    std::uint64_t residentPages = 0;
    if (std::ifstream("/proc/self/statm") >> virtualPages >> residentPages) {
        const auto pageBytes = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
        figures.virtualBytes = virtualPages * pageBytes;
        figures.residentBytes = residentPages * pageBytes;
    }
    figures.openFiles = entriesOf("/proc/self/fd");
    figures.threads = entriesOf("/proc/self/task");
    return figures;
}

}  // namespace eyrie::observe
