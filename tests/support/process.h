// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

namespace eyrie::test {

/// How a process ended: by itself with a status, or by a signal (then `status` is -1).
struct Exit {
    int status = -1;
    int signal = 0;

    bool operator==(const Exit&) const = default;
};
std::ostream& operator<<(std::ostream& stream, const Exit& exit);

/// A child process with its output captured. It and what it started in its process group are
/// killed when the object goes, and it is killed when the test dies.
class Process {
public:
    using Milliseconds = std::chrono::milliseconds;

    /// Starts command[0], a path, with standard input empty. `environment` has NAME=value entries
    /// that are added to this process's own. A program that cannot be started exits with 127.
    explicit Process(const std::vector<std::string>& command,
                     const std::vector<std::string>& environment = {});
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    pid_t id() const { return id_; }

    /// How it ended, or nothing when it has not within `limit`.
    std::optional<Exit> waitFor(Milliseconds limit);
    /// Waits until it ended or `text` was written to standard output; true for the latter.
    bool waitForOutput(std::string_view text, Milliseconds limit);
    void send(int signal) const;

    /// What was written so far.
    std::string output() const;
    std::string errors() const;

private:
    pid_t id_ = -1;
    int output_ = -1;  ///< memory files: a child can never block on them
    int errors_ = -1;
    std::optional<Exit> exit_;
};

/// What a command did that was run to its end.
struct Outcome {
    Exit exit;  ///< status -1 and signal 0: it did not end within the limit and was killed
    std::string output;
    std::string errors;
};

Outcome run(const std::vector<std::string>& command, Process::Milliseconds limit,
            const std::vector<std::string>& environment = {});

/// Processes alive now (zombies left out) whose parent is `parent`.
std::vector<pid_t> childrenOf(pid_t parent);

/// Arguments separated by spaces; empty when there is no such process.
std::string commandLineOf(pid_t process);

/// False for zombies.
bool isAlive(pid_t process);

/// Asks `condition` again and again until it is true; false when it was not within `limit`.
template <typename Condition>
bool eventually(Process::Milliseconds limit, Condition condition);

void pauseBriefly();

template <typename Condition>
bool eventually(Process::Milliseconds limit, Condition condition) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (!condition()) {
        if (std::chrono::steady_clock::now() >= end)
            return false;
        pauseBriefly();
    }
    return true;
}

}  // namespace eyrie::test
