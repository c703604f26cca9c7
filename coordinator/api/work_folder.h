// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <absl/status/statusor.h>

#include "coordinator/api/operations.h"
#include "coordinator/api/programs.h"

/// What operations that run programs have in common.
namespace eyrie::api {

/// A hidden folder that goes with this object, and all that is in it, unless it is left.
class WorkFolder {
public:
    /// Beside what is being made, so that it can be moved into its place; `purpose` is in its name.
    /// Unavailable: nothing can be written there.
    static absl::StatusOr<WorkFolder> in(const std::filesystem::path& parent,
                                         std::string_view purpose);
    WorkFolder(WorkFolder&& other) noexcept
        : path_(std::exchange(other.path_, {})), goes_(other.goes_) {}
    ~WorkFolder();
    WorkFolder& operator=(WorkFolder&&) = delete;

    const std::filesystem::path& path() const { return path_; }

    /// It stays, with what is in it.
    void leave() { goes_ = false; }

private:
    explicit WorkFolder(std::filesystem::path path) : path_(std::move(path)) {}
    std::filesystem::path path_;
    bool goes_ = true;
};

/// `text` in the caller's terms: with `name` wherever it has `path`.
std::string named(std::string text, std::string_view path, std::string_view name);

/// What `run` of `arguments` in `folder` writes to its standard output, telling what the program's
/// `--progress-json` says. Errors: those of `run` and LastWords::statusOf; Cancelled after `stop`.
absl::StatusOr<std::string> runToItsEnd(const std::vector<std::string>& arguments,
                                        const std::filesystem::path& folder, const RunProgram& run,
                                        const Operations::Progress& progress,
                                        const std::stop_token& stop);

}  // namespace eyrie::api
