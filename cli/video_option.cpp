// SPDX-License-Identifier: Apache-2.0
#include "cli/video_option.h"

#include "fabric/status.h"
#include "video/load.h"

namespace eyrie::cli {

void addVideoOption(CLI::App& command, bool& isAsked) {
    command.add_flag("--h264", isAsked,
                     "Send moving pictures as H.264 over links of less than some 20 Mbit/s, to "
                     "browsers that show it (pages by https, or of this machine); others get JPEG. "
                     "Needs the module for video, which is built where libavcodec-dev and "
                     "libavformat-dev are installed");
}

absl::StatusOr<const video::Module*> videoModule(bool isAsked) {
    if (!isAsked)
        return nullptr;
    auto module = video::load();
    if (!module.ok())
        return fabric::withContext(module.status(), "--h264");
    return module;
}

}  // namespace eyrie::cli
