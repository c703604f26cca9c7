// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <absl/status/statusor.h>

#include "fabric/channel_task.h"
#include "fabric/frame_data.h"
#include "fabric/scene.h"
#include "fabric/statistics.h"

namespace eyrie {

struct RendererOptions {
    /// Index of the EGL device (`eyrie renderer --device`); -1 takes the first that works.
    int device = -1;
    /// Limit on the bytes of geometry and textures kept on the device, least recently drawn out
    /// first. What one frame draws may exceed it for that frame.
    std::uint64_t memoryBytes = std::uint64_t{2} << 30;
};

/// Draws channel tasks without a window: the only header of the library that outsiders include.
///
/// Belongs to the thread that created it: create, use and destroy it there. Knows no network.
class Renderer {
public:
    /// FailedPrecondition when this machine offers no EGL device with OpenGL 4.5, saying what was
    /// tried.
    static absl::StatusOr<std::unique_ptr<Renderer>> create(const RendererOptions& options);

    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    const fabric::DeviceInfo& device() const;

    /// Opens the .eyt and .eym files of `scene` in place of the scene before. On an error the scene
    /// before stays open. Errors: InvalidArgument (scene or file), NotFound, DataLoss.
    absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene& scene);

    /// Draws one channel. Errors: InvalidArgument (the task or frame data), FailedPrecondition (no
    /// scene open), ResourceExhausted, DataLoss (a page is corrupt).
    absl::StatusOr<fabric::ChannelResult> render(const fabric::FrameData& frameData,
                                                 const fabric::ChannelTask& task);

private:
    class Impl;
    explicit Renderer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace eyrie
