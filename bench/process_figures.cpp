// SPDX-License-Identifier: Apache-2.0
#include "bench/process_figures.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include <fmt/format.h>

namespace eyrie::bench {

std::optional<ProcessFigures> figuresOf(pid_t process, double seconds) {
    const std::filesystem::path folder = fmt::format("/proc/{}", process);
    std::ifstream status(folder / "status");
    ProcessFigures figures{.seconds = seconds};
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmRSS:"))
            figures.residentMebibytes = std::atof(line.c_str() + 6) / 1024;
        else if (line.starts_with("Threads:"))
            figures.threads = std::atoi(line.c_str() + 8);
    }
    std::error_code gone;
    for (std::filesystem::directory_iterator entry(folder / "fd", gone), end; !gone && entry != end;
         entry.increment(gone)) {
        std::error_code closed;  // meanwhile
        const auto file = std::filesystem::read_symlink(entry->path(), closed).string();
        ++(file.starts_with("/memfd:") ? figures.memoryFiles : figures.descriptors);
    }
    if (figures.threads == 0 || gone)
        return std::nullopt;
    return figures;
}

int growthOf(int ProcessFigures::*of, std::span<const ProcessFigures> samples) {
    if (samples.size() < 3)
        return 0;
    const std::size_t third = samples.size() / 3;
    const auto first = std::ranges::max_element(samples.first(third), {}, of);
    const auto last = std::ranges::min_element(samples.last(third), {}, of);
    return std::max(0, (*last).*of - (*first).*of);
}

double residentSlope(std::span<const ProcessFigures> samples) {
    if (samples.size() < 2)
        return 0;
    double meanTime = 0;
    double meanSize = 0;
    for (const ProcessFigures& sample : samples) {
        meanTime += sample.seconds / static_cast<double>(samples.size());
        meanSize += sample.residentMebibytes / static_cast<double>(samples.size());
    }
    double covariance = 0;
    double variance = 0;
    for (const ProcessFigures& sample : samples) {
        covariance += (sample.seconds - meanTime) * (sample.residentMebibytes - meanSize);
        variance += (sample.seconds - meanTime) * (sample.seconds - meanTime);
    }
    return variance == 0 ? 0 : covariance / variance * 3600;
}

}  // namespace eyrie::bench
