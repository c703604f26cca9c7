// SPDX-License-Identifier: Apache-2.0
#include "cli/cache_options.h"

#include <cstdlib>

#include "cli/values.h"
#include "fabric/status.h"

namespace eyrie::cli {

void addCacheOptions(CLI::App& command, CacheOptions& options) {
    command
        .add_option("--cache", options.folder,
                    "Where imports, and data from URLs, are kept "
                    "[$XDG_CACHE_HOME/eyrie, or ~/.cache/eyrie]")
        ->type_name("FOLDER");
    command
        .add_option("--cache-size", options.size,
                    "Limit of what is kept of data from URLs; what was used last stays")
        ->type_name("BYTES[K|M|G|T]")
        ->capture_default_str();
}

absl::StatusOr<std::filesystem::path> cacheFolder(const std::string& named) {
    if (!named.empty())
        return std::filesystem::path(named);
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return value == nullptr ? std::string() : std::string(value);
    };
    if (const std::string cache = variable("XDG_CACHE_HOME"); !cache.empty())
        return std::filesystem::path(cache) / "eyrie";
    if (const std::string home = variable("HOME"); !home.empty())
        return std::filesystem::path(home) / ".cache" / "eyrie";
    return absl::FailedPreconditionError(
        "neither XDG_CACHE_HOME nor HOME is set, so there is no place for imports; name one with "
        "--cache FOLDER");
}

absl::StatusOr<RemoteData> remoteDataOf(const CacheOptions& options) {
    RemoteData remote;
    ASSIGN_OR_RETURN(remote.cacheBytes, parseBytes(options.size, "--cache-size"));
    if (const auto folder = cacheFolder(options.folder); folder.ok())
        remote.cacheFolder = *folder / "remote";
    return remote;
}

}  // namespace eyrie::cli
