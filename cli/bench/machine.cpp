// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/machine.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string>
#include <string_view>
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

bool isPlain(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("-_./,:=+%@").find(c) != std::string_view::npos;
}

std::string quotedForShell(const std::string& word) {
    if (!word.empty() && std::ranges::all_of(word, isPlain))
        return word;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
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

std::string commandLine() {
    std::ifstream file("/proc/self/cmdline", std::ios::binary);
    std::string line;
    std::string word;
    if (std::getline(file, word, '\0'))
        line = "eyrie";
    while (std::getline(file, word, '\0')) line += fmt::format(" {}", quotedForShell(word));
    return line;
}

}  // namespace eyrie::cli::bench
