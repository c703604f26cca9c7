// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/process.h"

/// The program under test, as its users run it. EYRIE_BINARY comes from eyrie_test().
namespace eyrie::test {

inline std::vector<std::string> eyrieCommand(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), EYRIE_BINARY);
    return arguments;
}

/// Runs `eyrie ARGUMENTS...` to its end.
inline Outcome eyrie(const std::vector<std::string>& arguments,
                     const std::vector<std::string>& environment = {},
                     Process::Milliseconds limit = std::chrono::seconds(60)) {
    return run(eyrieCommand(arguments), limit, environment);
}

/// ASSERT_TRUE(succeeded({...})): runs it and shows what it said when it fails.
inline testing::AssertionResult succeeded(const std::vector<std::string>& arguments) {
    const Outcome outcome = eyrie(arguments);
    if (outcome.exit == Exit{0, 0})
        return testing::AssertionSuccess();
    std::string line = "eyrie";
    for (const std::string& argument : arguments) line += " " + argument;
    return testing::AssertionFailure() << line << ": " << outcome.exit << "\n"
                                       << outcome.output << outcome.errors;
}

/// Names of the entries of a folder.
inline std::set<std::string> namesIn(const std::filesystem::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.insert(entry.path().filename().string());
    return names;
}

}  // namespace eyrie::test
