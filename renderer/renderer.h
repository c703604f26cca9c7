// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include <absl/status/statusor.h>

#include "fabric/channel_task.h"
#include "fabric/delivery.h"
#include "fabric/frame_data.h"
#include "fabric/scene.h"
#include "fabric/statistics.h"
#include "renderer/tile_decoding.h"

namespace eyrie {

namespace pick {
class Picker;
}

/// How data at URLs are read.
struct RemoteData {
    /// Where what was read is kept; empty: nowhere, and meshes at URLs cannot be opened. Processes
    /// that are given the same limit may share a folder.
    std::filesystem::path cacheFolder;
    std::uint64_t cacheBytes = std::uint64_t{10} << 30;
    /// Threads that read: they mostly wait.
    int loaderThreads = 8;
};

struct RendererOptions {
    /// Index of the EGL device (`eyrie renderer --device`); -1 takes the first that works.
    int device = -1;
    /// Limit on the bytes of geometry and textures kept on the device. The scene's objects keep
    /// within their shares of it at all times: small ones have what all of them takes, large ones
    /// the rest in equal parts (draw/memory_shares.h). Where what a view needs does not fit, the
    /// error rises, and the statistics say so. While another scene is opened, the one before keeps
    /// what it has, and what the other needs to be open comes on top: meshes' textures, half of the
    /// limit at most unless their coarsest levels alone take more, and the coarsest tiles and
    /// nodes.
    std::uint64_t memoryBytes = std::uint64_t{2} << 30;
    /// Limit on the bytes in host memory of terrains' indices, which are there whole, and of pages,
    /// those being loaded included; what the indices leave is shared likewise. A scene's indices
    /// and the tables of its meshes, which are not counted else, take no more together. On top of
    /// it come pick::kRecentBytes and, while another scene is opened, that one's indices.
    std::uint64_t hostMemoryBytes = std::uint64_t{1} << 30;
    /// Threads that read and decode pages.
    int loaderThreads = 2;
    TileDecoding decoding = TileDecoding::Auto;
    RemoteData remote;
};

/// What a renderer holds in memory for its scene, besides what open files need.
struct RendererMemory {
    std::uint64_t deviceBytes = 0;  ///< geometry and textures
    std::uint64_t hostBytes = 0;    ///< terrains' indices; pages, those being loaded included
};

/// Draws channel tasks without a window: the only header of the library that outsiders include.
///
/// Belongs to the thread that created it: create, use and destroy it there. Several of one thread
/// take turns. Knows no network.
class Renderer {
public:
    /// FailedPrecondition when this machine offers no EGL device with OpenGL 4.5, saying what was
    /// tried.
    static absl::StatusOr<std::unique_ptr<Renderer>> create(const RendererOptions& options);

    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    const fabric::DeviceInfo& device() const;

    /// Opens the .eyt and .eym files of `scene`, here or at URLs, in place of the scene before. On
    /// an error the scene before stays open. Errors: InvalidArgument (scene or file), NotFound,
    /// DataLoss, ResourceExhausted (the limits are too small for it), FailedPrecondition (tiles
    /// are to be decoded on a GPU that cannot); of URLs Unavailable and PermissionDenied, too.
    absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene& scene);

    /// Draws one channel. A page of terrain that cannot be read is no error: coarser data stand in
    /// for it, the statistics count it and the log names it. Errors: InvalidArgument (the task or
    /// frame data), FailedPrecondition (no scene open, or data of it are missing since the device
    /// had too little memory), ResourceExhausted (limits, or the device's memory), Internal (OpenGL
    /// met an error), DataLoss (of a mesh), Cancelled: `delivery.stop` came before the picture was
    /// there, within a batch of triangles or at once where it waited for pages. What has come of
    /// those stays; later pictures are what they would have been.
    absl::StatusOr<fabric::ChannelResult> render(const fabric::FrameData& frameData,
                                                 const fabric::ChannelTask& task,
                                                 const fabric::Delivery& delivery = {});

    /// Finds what places of the open scene's pictures show (renderer/pick/picker.h), on any thread
    /// and as long as one likes, whatever becomes of this. Null before a scene is open.
    std::shared_ptr<const pick::Picker> picker() const;

    RendererMemory memory() const;

private:
    class Impl;
    explicit Renderer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace eyrie
