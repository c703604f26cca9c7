// SPDX-License-Identifier: Apache-2.0
#include "cli/load_scene.h"

#include <cstdio>
#include <vector>

#include <fmt/format.h>

#include "cli/data_cache.h"
#include "cli/log.h"
#include "cli/progress_bar.h"
#include "fabric/status.h"

namespace eyrie::cli {

absl::StatusOr<NamedScene> loadScene(std::span<const std::string> paths,
                                     const CacheOptions& options, bool isQuiet,
                                     const std::stop_token& stop) {
    if (paths.empty())
        return NamedScene{};
    ASSIGN_OR_RETURN(const auto folder, cacheFolder(options.folder));
    ASSIGN_OR_RETURN(const RemoteData remote, remoteDataOf(options));
    DataCache cache(folder, ProgressBar::styleFor(isQuiet), stop,
                    page::sourceOptions(remote.cacheFolder, remote.cacheBytes));
    std::vector<std::string> notes;
    ASSIGN_OR_RETURN(NamedScene named, assembleScene(paths, cache, notes));
    if (!isQuiet)
        for (const std::string& note : notes) tell(note);
    return named;
}

}  // namespace eyrie::cli
