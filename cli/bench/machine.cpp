// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/machine.h"

#include <fstream>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "fabric/version.h"

namespace eyrie::cli::bench {
namespace {

/// The first "model name" of /proc/cpuinfo.
std::string processorName() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (const std::size_t colon = line.find(": ");
            line.starts_with("model name") && colon != std::string::npos)
            return line.substr(colon + 2);
    return "unknown";
}

std::uint64_t memoryBytes() {
    return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
           static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::string systemName() {
    utsname name{};
    return uname(&name) == 0 ? fmt::format("{} {} {}", name.sysname, name.release, name.machine)
                             : "unknown";
}

}  // namespace

JsonObject machineJson(const fabric::DeviceInfo& device) {
    JsonObject json;
    json.text("processor", processorName())
        .count("cores", std::thread::hardware_concurrency())
        .count("memoryBytes", memoryBytes())
        .text("system", systemName())
        .text("vendor", device.vendor)
        .text("device", device.renderer)
        .text("driver", device.driver)
        .text("platform", device.platform)
        .flag("software", device.software)
        .text("eyrie", fabric::kVersion);
    return json;
}

}  // namespace eyrie::cli::bench
