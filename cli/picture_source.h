// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include <absl/status/statusor.h>

#include "cli/config_options.h"
#include "cli/drawing_options.h"
#include "coordinator/frame/frame_source.h"
#include "fabric/scene.h"

namespace eyrie::cli {

struct PictureSourceOptions {
    /// Processes that draw; 0: draw in this one, or, with a configuration, with as many as it uses.
    int renderers = 0;
    ConfigOptions config;
    DrawingOptions drawing;
    bool quiet = false;         ///< neither progress nor notes of imports
    bool configIsTold = false;  ///< what is found in its file, but for errors, was told before
};

/// Says that a --compound has no effect where `renderers` processes draw at most: one shares a
/// frame with nobody.
void noteIdleCompound(const PictureSourceOptions& options, int renderers);

/// Draws pictures of one scene, for commands that need no viewer. Belongs to the thread that opened
/// it, but where it can be asked for several pictures at once.
class PictureSource {
public:
    /// `path` names what is drawn, as for loadScene. Errors: those of loadScene,
    /// Renderer::openScene and LocalFarm.
    static absl::StatusOr<std::unique_ptr<PictureSource>> open(const std::string& path,
                                                               const PictureSourceOptions& options,
                                                               const std::stop_token& stop);

    virtual ~PictureSource() = default;

    virtual absl::StatusOr<coordinator::RenderedFrame> draw(
        const coordinator::FrameRequest& request) = 0;
    /// As FrameSource::renderLatest.
    virtual absl::StatusOr<coordinator::RenderedFrame> drawLatest(
        const coordinator::FrameSource::ChooseFrame& choose);
    /// As FrameSource::framesAtOnce; where it is more than 1, any thread may draw.
    virtual int framesAtOnce() const { return 1; }
    virtual fabric::SceneInfo sceneInfo() const = 0;
    virtual fabric::Rgba background() const = 0;  ///< of pictures, where nothing is
};

}  // namespace eyrie::cli
