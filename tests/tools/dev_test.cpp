// SPDX-License-Identifier: Apache-2.0
// ./dev, by what it would have CMake do.
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>

#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using testing::HasSubstr;

/// Whether there are tests, and which, stays in CMake's cache, of the demo as well.
TEST(Dev, SaysEachTimeWhetherTestsAreBuilt) {
    const test::TemporaryFolder programs;
    const auto stub = [&](const char* name, const char* text) {
        std::filesystem::permissions(programs.write(name, std::string("#!/bin/sh\n") + text + "\n"),
                                     std::filesystem::perms::owner_all);
    };
    stub("cmake", "echo \"cmake $*\"");
    stub("dpkg-query", "echo installed");
    stub("node", "echo 20");
    stub("npm", "");
    const char* path = std::getenv("PATH");
    ASSERT_NE(path, nullptr);
    const auto saidBy = [&](const std::vector<std::string>& arguments) {
        std::vector<std::string> command = {EYRIE_SOURCE_DIR "/dev"};
        command.insert(command.end(), arguments.begin(), arguments.end());
        return test::run(command, std::chrono::seconds(60),
                         {"PATH=" + programs.path().string() + ":" + path})
            .output;
    };
    EXPECT_THAT(
        saidBy({"build"}),
        HasSubstr("cmake --preset release -DEYRIE_BUILD_TESTS=ON -DEYRIE_BUILD_UNIT_TESTS=ON"));
    EXPECT_THAT(
        saidBy({"build", "debug"}),
        HasSubstr("cmake --preset debug -DEYRIE_BUILD_TESTS=ON -DEYRIE_BUILD_UNIT_TESTS=ON"));
    EXPECT_THAT(saidBy({"program"}), HasSubstr("cmake --preset release -DEYRIE_BUILD_TESTS=OFF"));
}

}  // namespace
}  // namespace eyrie
