// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace eyrie::test {

struct Peak {
    int status = -1;         ///< that the program ended with; -1: by no exit
    std::int64_t bytes = 0;  ///< resident at most, in it or in one of those that it started
};

/// Runs a program to its end. With sanitizers, which take memory of their own, the figure says
/// nothing of the program.
inline Peak peakOf(const std::vector<std::string>& command) {
    const pid_t child = fork();
    if (child == 0) {
        std::vector<char*> words;
        for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
        words.push_back(nullptr);
        execv(words[0], words.data());
        _exit(127);
    }
    int status = 0;
    rusage usage{};
    if (wait4(child, &status, 0, &usage) != child || !WIFEXITED(status))
        return {};
    return {WEXITSTATUS(status), std::int64_t{usage.ru_maxrss} * 1024};
}

}  // namespace eyrie::test
