// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <absl/status/statusor.h>
#include <sys/types.h>

namespace eyrie::cli {

/// This program once more, as a child with its own command line. It writes to the same standard
/// error and gets SIGTERM when the thread that started it ends, however that happens.
class ChildProcess {
public:
    /// `arguments` follow the program's name; `environment` ("NAME=value") adds to this process's,
    /// where it has not set the name itself. Unavailable when the system refuses another process.
    static absl::StatusOr<ChildProcess> start(const std::vector<std::string>& arguments,
                                              const std::vector<std::string>& environment);

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
