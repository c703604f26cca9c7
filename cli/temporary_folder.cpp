// SPDX-License-Identifier: Apache-2.0
#include "cli/temporary_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

namespace eyrie::cli {
namespace {

/// The path of a Unix socket has 107 characters at most.
constexpr std::size_t kMaxParentLength = 60;

}  // namespace

absl::StatusOr<TemporaryFolder> TemporaryFolder::create() {
    std::error_code error;
    std::filesystem::path parent = std::filesystem::temp_directory_path(error);
    if (error || parent.native().size() > kMaxParentLength)
        parent = "/tmp";
    std::string name = (parent / "eyrie-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)  // mode 0700
        return absl::UnavailableError(fmt::format("{}: cannot make a temporary folder here ({})",
                                                  parent.string(), std::strerror(errno)));
    return TemporaryFolder(name);
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty())
        std::filesystem::remove_all(path_, ignored);
}

}  // namespace eyrie::cli
