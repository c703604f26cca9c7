// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/scene.h"
#include "renderer/draw/decode_choice.h"
#include "renderer/draw/mesh_draw.h"
#include "renderer/draw/open_object.h"
#include "renderer/draw/terrain_draw.h"
#include "renderer/page/loader.h"
#include "renderer/page/page_source.h"
#include "renderer/renderer.h"

namespace eyrie {

/// A scene whose objects can be drawn and picked.
struct OpenScene {
    fabric::Scene scene;
    fabric::SceneInfo info = {};
    std::vector<draw::OpenObject> objects = {};
    std::uint64_t indexBytes = 0;  ///< of its terrains, in memory for as long as they are open
    std::shared_ptr<const pick::Picker> picker = {};
};

/// Opens scenes, and has what all objects share: the programs that draw them, the threads that
/// read their pages, how pages are decoded. Outlives the scenes. GL thread.
class SceneOpener {
public:
    /// `device` is that of the current context.
    SceneOpener(const RendererOptions& options, const fabric::DeviceInfo& device);

    /// Errors: those of Renderer::openScene.
    absl::StatusOr<OpenScene> open(const fabric::Scene& scene);

    /// Programs whose sources have been edited, for people tuning shaders.
    void reloadChanged(std::chrono::steady_clock::time_point now);

private:
    using TerrainFile = std::shared_ptr<const terrain::EytFile>;
    using MeshFile = std::shared_ptr<const mesh::EymFile>;
    using File = std::variant<TerrainFile, MeshFile>;  ///< of an object, open

    static std::uint64_t alwaysInMemory(const File& file);
    static std::uint64_t indexBytesOf(const std::vector<File>& files);
    page::Loader& loaderFor(const fabric::SceneObject& object);
    absl::StatusOr<File> openFile(const fabric::SceneObject& object, std::uint64_t limit) const;
    absl::StatusOr<std::vector<File>> openFiles(const fabric::Scene& scene) const;
    std::vector<draw::MemoryUse> sharesOf(const std::vector<File>& files,
                                          std::uint64_t hostBytes) const;
    absl::StatusOr<std::unique_ptr<draw::Drawable>> openObject(const fabric::SceneObject& object,
                                                               const File& file,
                                                               const draw::MemoryUse& share);

    RendererOptions options_;
    draw::TextureFormat textureFormat_;
    draw::TerrainPrograms terrainPrograms_;
    draw::MeshPrograms meshPrograms_;
    draw::PointPrograms pointPrograms_;
    draw::DecodeChoice decoding_;
    page::Loader loader_;
    /// Of its own threads, so that a server that stalls does not hold up local files. Made for the
    /// first scene that needs it.
    std::optional<page::Loader> remoteLoader_;
    page::SourceOptions sources_;
};

}  // namespace eyrie
