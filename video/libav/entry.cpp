// SPDX-License-Identifier: Apache-2.0
#include <string_view>
#include <utility>

#include "fabric/version.h"
#include "video/libav/movie.h"
#include "video/libav/stream.h"
#include "video/module.h"

extern "C" {
#include <libavutil/log.h>
}

namespace eyrie::video {
namespace {

class Libav final : public Module {
public:
    absl::StatusOr<std::unique_ptr<StreamEncoder>> makeStream(
        const StreamSettings& settings) const override {
        return video::makeStream(settings);
    }

    absl::StatusOr<std::unique_ptr<Movie>> makeMovie(const MovieSettings& settings,
                                                     MovieSink sink) const override {
        return video::makeMovie(settings, std::move(sink));
    }
};

}  // namespace

extern "C" __attribute__((visibility("default"))) const Module* eyrieVideoModule(
    const char* version, std::size_t versionLength) {
    if (std::string_view(version, versionLength) != fabric::kVersion)
        return nullptr;
    av_log_set_level(AV_LOG_ERROR);
    static const Libav kModule;
    return &kModule;
}

}  // namespace eyrie::video
