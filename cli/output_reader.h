// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <string>
#include <utility>

#include <absl/status/statusor.h>

namespace eyrie::cli {

/// Who reads the pipe that something is to be written to. Opening one that nobody reads waits
/// until somebody does, and no signal ends that: this waits before, and can be called off. It keeps
/// the pipe open, so that its reader does not see it end before it is opened once more.
class OutputReader {
public:
    /// At once where `path` is no pipe. Errors: Cancelled (`stop`). What else is wrong with the
    /// pipe, who opens it is told.
    static absl::StatusOr<OutputReader> await(const std::string& path, const std::stop_token& stop);

    OutputReader(OutputReader&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    OutputReader& operator=(OutputReader&& other) noexcept {
        std::swap(fd_, other.fd_);
        return *this;
    }
    ~OutputReader();

private:
    explicit OutputReader(int fd) : fd_(fd) {}

    int fd_;  ///< -1: it is no pipe
};

}  // namespace eyrie::cli
