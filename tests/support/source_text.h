// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

namespace eyrie::test {

/// Of a file of this source tree, by its path there: "deploy/compose.yaml".
inline std::string sourceText(const std::string& path) {
    std::ifstream file(EYRIE_SOURCE_DIR "/" + path);
    EXPECT_TRUE(file) << path << " is missing";
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace eyrie::test
