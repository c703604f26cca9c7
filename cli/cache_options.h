// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>

#include "renderer/renderer.h"

namespace eyrie::cli {

/// The options of every command that opens data: where files are kept from run to run.
struct CacheOptions {
    std::string folder;  ///< empty: the default
    std::string size = "10G";
};

void addCacheOptions(CLI::App& command, CacheOptions& options);

/// What --cache names, or $XDG_CACHE_HOME/eyrie, or ~/.cache/eyrie. FailedPrecondition when there
/// is none of them.
absl::StatusOr<std::filesystem::path> cacheFolder(const std::string& named);

/// Where renderers keep what they read from URLs: a folder in the cache. Without a place for a
/// cache they keep nothing. InvalidArgument: --cache-size.
absl::StatusOr<RemoteData> remoteDataOf(const CacheOptions& options);

}  // namespace eyrie::cli
