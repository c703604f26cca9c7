// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

namespace eyrie::api {

/// How a program ended.
struct ProgramEnd {
    bool crashed = false;  ///< by a signal
    int code = 0;          ///< exit status (0 done, 1 failed, 2 wrong input) or signal
    std::string output = {};
};

/// `eyrie` with `arguments` in a process of its own, in `folder`, from its start to its end;
/// blocks. `heard` is called on the same thread with each line of its standard error. After `stop`
/// it ends soon, one way or the other. Unavailable when there can be no process.
using RunProgram = std::function<absl::StatusOr<ProgramEnd>(
    const std::vector<std::string>& arguments, const std::filesystem::path& folder,
    const std::function<void(std::string_view line)>& heard, const std::stop_token& stop)>;

/// What the API may have done by other processes: readers of files are code that files can break.
struct Programs {
    RunProgram run = {};            ///< null: none are run
    std::size_t importsAtOnce = 0;  ///< 0: there are no imports
    /// `eyrie import --memory`, `eyrie bench --reference-memory`.
    std::uint64_t importMemoryBytes = 512 << 20;
};

/// The last of what a program said, for people: what it failed with.
class LastWords {
public:
    void hear(std::string_view line);

    /// OK, or how it failed: InvalidArgument (its input is wrong), Internal (it crashed), Unknown.
    absl::Status statusOf(const ProgramEnd& end) const;

private:
    std::string line_;
};

}  // namespace eyrie::api
