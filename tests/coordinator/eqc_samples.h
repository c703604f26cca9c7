// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/resolved.h"

/// Equalizer's own example files.
namespace eyrie::config {

inline std::string contents(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    EXPECT_TRUE(in) << path << " is missing";
    return {std::istreambuf_iterator<char>(in), {}};
}

struct Read {
    explicit Read(const std::string& text)
        : configuration(readEqc(text, findings)), resolved(resolve(configuration, findings)) {}

    Findings findings;
    Configuration configuration;
    ResolvedConfiguration resolved;
};

inline constexpr const char* kSamples = EYRIE_SOURCE_DIR "/../shared/data/eqc";

inline Read sample(const std::string& name) {
    return Read(contents(std::filesystem::path(kSamples) / name));
}

/// By name.
inline std::vector<std::string> samples() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(kSamples))
        if (entry.path().extension() == ".eqc")
            names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

}  // namespace eyrie::config
