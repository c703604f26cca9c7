// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>

#include <absl/status/statusor.h>

#include "access/tokens.h"

namespace eyrie::access {

/// The tokens of a file that may change: who is given or taken a token is so from then on, and
/// nothing has to start again. A file that cannot be used, as while it is being written, changes
/// nothing, and the log says why. All functions may be called from any thread.
class TokenFile {
public:
    /// Errors: those of Tokens::read.
    static absl::StatusOr<std::shared_ptr<TokenFile>> open(const std::filesystem::path& file);

    /// Looks at the file each time (a microsecond), and reads it when it has changed. Looking now
    /// and then would be cheaper by nothing that counts, and have two processes of one file refuse
    /// each other for as long.
    std::shared_ptr<const Tokens> current();

private:
    /// What tells one state of the file from another: which file it is, its size and times.
    using Stamp = std::array<std::int64_t, 6>;

    explicit TokenFile(std::filesystem::path file) : file_(std::move(file)) {}
    absl::Status load();
    Stamp stamp() const;

    const std::filesystem::path file_;
    std::mutex mutex_;  ///< guards what follows
    std::shared_ptr<const Tokens> tokens_;
    Stamp loaded_{};
};

}  // namespace eyrie::access
