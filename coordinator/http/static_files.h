// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include <absl/status/statusor.h>

namespace eyrie::http {

struct StaticFile {
    std::string contentType;
    /// Names that the build derives from the content never change their meaning.
    bool isImmutable = false;
    std::shared_ptr<const std::string> content;
};

/// A folder's files, read once. Requests are looked up by their exact path, so nothing outside the
/// folder can be named, whatever the path says.
class StaticFiles {
public:
    /// Reads the regular files below `folder`; links are left out. An absent folder has no files.
    /// Errors: ResourceExhausted (more than 64 MiB or 4096 files), Unavailable (a file cannot be
    /// read).
    static absl::StatusOr<StaticFiles> read(const std::filesystem::path& folder);

    /// The file at `path`, which starts with '/' ("/" is index.html); nullptr when there is none.
    const StaticFile* find(std::string_view path) const;

private:
    std::map<std::string, StaticFile, std::less<>> files_;
};

}  // namespace eyrie::http
