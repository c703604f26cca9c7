// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <absl/status/statusor.h>
#include <sys/types.h>

namespace eyrie::cli {

/// This program once more, as a child with its own command line. It writes to the same standard
/// error, unless that is set otherwise, and gets SIGTERM when the thread that started it ends,
/// however that happens.
class ChildProcess {
public:
    /// What is otherwise than in this process.
    struct Setting {
        std::filesystem::path folder = {};  ///< that it works in; empty: this one's
        int output = -1;                    ///< file descriptors in place of its standard output
        int errors = -1;                    ///< and error; -1: this one's
        std::uint64_t memoryBytes = 0;      ///< of its own, that it may have; 0: no limit
        int niceness = 0;                   ///< added to this one's: it gives way to others
        std::vector<std::string> without = {};  ///< variables of this process's environment
    };

    /// `arguments` follow the program's name; `environment` ("NAME=value") adds to this process's,
    /// where it has not set the name itself. Unavailable when the system refuses another process.
    static absl::StatusOr<ChildProcess> start(const std::vector<std::string>& arguments,
                                              const std::vector<std::string>& environment,
                                              const Setting& setting);
    static absl::StatusOr<ChildProcess> start(const std::vector<std::string>& arguments,
                                              const std::vector<std::string>& environment) {
        return start(arguments, environment, {});
    }

    ChildProcess(ChildProcess&& other) noexcept : pid_(std::exchange(other.pid_, -1)) {}
    ChildProcess& operator=(ChildProcess&& other) noexcept {
        std::swap(pid_, other.pid_);
        return *this;
    }
    /// Stops a child that still runs.
    ~ChildProcess();

    /// How it ended, once it has: "exit status 1" or "signal 9".
    struct End {
        bool crashed = false;  ///< ended by a signal
        int code = 0;          ///< exit status or signal
        std::string text() const;
    };
    std::optional<End> poll();

    /// SIGTERM; returns at once.
    void terminate();
    /// SIGTERM, then SIGKILL if it takes longer than `grace`.
    void stop(std::chrono::milliseconds grace);

    pid_t pid() const { return pid_; }

private:
    explicit ChildProcess(pid_t pid) : pid_(pid) {}

    pid_t pid_;
};

}  // namespace eyrie::cli
