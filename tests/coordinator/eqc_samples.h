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

/// Equalizer's own example files, and made ones.
namespace eyrie::config {

inline std::string contents(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    EXPECT_TRUE(in) << path << " is missing";
    return {std::istreambuf_iterator<char>(in), {}};
}

/// A configuration with one channel of 640 x 480, one view, and these compounds.
inline std::string withCompounds(const std::string& compounds) {
    return "config { appNode { pipe { window { viewport [ 0 0 640 480 ]"
           " channel { name \"a\" } channel { name \"b\" } } } }"
           " observer {} layout { view { observer 0 } }"
           " canvas { layout 0 wall {} segment { channel \"a\" } } " +
           compounds + " }";
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

inline std::string firstError(const std::string& text) {
    const Read read(text);
    for (const Finding& finding : read.findings.all())
        if (finding.kind == Finding::Kind::Error)
            return std::to_string(finding.place.line) + ":" + std::to_string(finding.place.column) +
                   " " + finding.message;
    return "none";
}

}  // namespace eyrie::config
