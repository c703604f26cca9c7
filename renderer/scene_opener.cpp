// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene_opener.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "fabric/scene_reach.h"
#include "fabric/status.h"
#include "renderer/draw/memory_shares.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/page/remote_name.h"
#include "renderer/pick/picker.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie {
namespace {

/// How high the terrains among `objects` reach; null where there are none.
std::shared_ptr<const std::vector<fabric::GroundGrid>> groundOf(
    const std::vector<draw::OpenObject>& objects) {
    const auto terrains = std::count_if(objects.begin(), objects.end(), [](const auto& open) {
        return open.object.kind == fabric::ObjectKind::Terrain;
    });
    if (terrains == 0 || terrains > fabric::kMaxGroundCells)
        return nullptr;
    auto ground = std::make_shared<std::vector<fabric::GroundGrid>>();
    for (std::size_t i = 0; i < objects.size(); ++i)
        if (auto grid =
                objects[i].drawable->ground(fabric::kMaxGroundCells / static_cast<int>(terrains))) {
            grid->object = static_cast<std::int32_t>(i);
            ground->push_back(*std::move(grid));
        }
    return ground;
}

draw::TextureFormat textureFormatOf(const fabric::DeviceInfo& device) {
    return GLEW_EXT_texture_compression_s3tc && !device.software ? draw::TextureFormat::Bc1
                                                                 : draw::TextureFormat::Rgba8;
}

}  // namespace

SceneOpener::SceneOpener(const RendererOptions& options, const fabric::DeviceInfo& device)
    : options_(options),
      textureFormat_(textureFormatOf(device)),
      decoding_(options.decoding),
      loader_({.threads = options.loaderThreads}),
      sources_(page::sourceOptions(options.remote.cacheFolder, options.remote.cacheBytes)) {}

void SceneOpener::reloadChanged(std::chrono::steady_clock::time_point now) {
    terrainPrograms_.reloadChanged(now);
    meshPrograms_.reloadChanged(now);
    pointPrograms_.reloadChanged(now);
}

page::Loader& SceneOpener::loaderFor(const fabric::SceneObject& object) {
    if (!page::isRemote(object.path))
        return loader_;
    if (!remoteLoader_)
        remoteLoader_.emplace(page::LoaderOptions{.threads = options_.remote.loaderThreads});
    return *remoteLoader_;
}

/// Its index, or its tables.
std::uint64_t SceneOpener::alwaysInMemory(const File& file) {
    if (const auto* terrain = std::get_if<TerrainFile>(&file))
        return (*terrain)->indexMemoryBytes();
    return std::get<MeshFile>(file)->tableMemoryBytes();
}

std::uint64_t SceneOpener::indexBytesOf(const std::vector<File>& files) {
    std::uint64_t bytes = 0;
    for (const File& file : files)
        if (const auto* terrain = std::get_if<TerrainFile>(&file))
            bytes += (*terrain)->indexMemoryBytes();
    return bytes;
}

/// Of `limit` bytes its index or tables may take. What does not fit is told before all is read.
absl::StatusOr<SceneOpener::File> SceneOpener::openFile(const fabric::SceneObject& object,
                                                        std::uint64_t limit) const {
    if (object.kind == fabric::ObjectKind::Terrain)
        return terrain::EytFile::open(object.path, sources_, limit);
    ASSIGN_OR_RETURN(mesh::EymFile file, mesh::EymFile::open(object.path, sources_, limit));
    return std::make_shared<const mesh::EymFile>(std::move(file));
}

absl::StatusOr<std::vector<SceneOpener::File>> SceneOpener::openFiles(
    const fabric::Scene& scene) const {
    std::vector<File> files;
    std::uint64_t left = options_.hostMemoryBytes;
    for (const fabric::SceneObject& object : scene.objects) {
        absl::StatusOr<File> file = openFile(object, left);
        if (absl::IsResourceExhausted(file.status()))
            return absl::ResourceExhaustedError(fmt::format(
                "{}; the indices of the scene's files may take {} bytes of host memory: raise the "
                "limit (--host-memory), or open fewer or smaller files",
                std::string(file.status().message()), options_.hostMemoryBytes));
        RETURN_IF_ERROR(file.status());
        left -= alwaysInMemory(*file);
        files.push_back(*std::move(file));
    }
    return files;
}

/// By what the files can ever use: the same wherever textures are kept in the same format.
std::vector<draw::MemoryUse> SceneOpener::sharesOf(const std::vector<File>& files,
                                                   std::uint64_t hostBytes) const {
    std::vector<std::uint64_t> onDevice;
    std::vector<std::uint64_t> onHost;
    for (const File& file : files) {
        const draw::MemoryUse most = std::visit(
            [this](const auto& opened) { return draw::greatestUse(*opened, textureFormat_); },
            file);
        onDevice.push_back(most.deviceBytes);
        onHost.push_back(most.hostBytes);
    }
    onDevice = draw::memoryShares(options_.memoryBytes, onDevice);
    onHost = draw::memoryShares(hostBytes, onHost);
    std::vector<draw::MemoryUse> shares;
    for (std::size_t i = 0; i < files.size(); ++i) shares.push_back({onDevice[i], onHost[i]});
    return shares;
}

absl::StatusOr<std::unique_ptr<draw::Drawable>> SceneOpener::openObject(
    const fabric::SceneObject& object, const File& file, const draw::MemoryUse& share) {
    if (const auto* terrain = std::get_if<TerrainFile>(&file))
        return draw::openTerrain(object, *terrain, terrainPrograms_, loaderFor(object),
                                 {share.deviceBytes, share.hostBytes}, textureFormat_, decoding_);
    return draw::openMesh(object, std::get<MeshFile>(file), meshPrograms_, pointPrograms_,
                          loaderFor(object), {share.deviceBytes, share.hostBytes}, textureFormat_);
}

absl::StatusOr<OpenScene> SceneOpener::open(const fabric::Scene& scene) {
    RETURN_IF_ERROR(fabric::validate(scene));
    ASSIGN_OR_RETURN(const std::vector<File> files, openFiles(scene));
    OpenScene open{.scene = scene, .indexBytes = indexBytesOf(files)};
    const std::vector<draw::MemoryUse> shares =
        sharesOf(files, options_.hostMemoryBytes - open.indexBytes);
    std::vector<std::unique_ptr<const pick::Surface>> surfaces;
    fabric::SceneInfo& info = open.info;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const fabric::SceneObject& object = scene.objects[i];
        ASSIGN_OR_RETURN(auto drawable, openObject(object, files[i], shares[i]));
        info.objects.push_back({fabric::transformed(drawable->bounds(), object.worldFromObject),
                                drawable->triangles()});
        RETURN_IF_ERROR(fabric::checkReach(object, info.objects.back().bounds));
        info.bounds.grow(info.objects.back().bounds);
        info.triangles += info.objects.back().triangles;
        info.files.push_back(drawable->file());
        info.bytes += info.files.back().bytes;
        surfaces.push_back(drawable->surface(object));
        open.objects.push_back({object, std::move(drawable)});
    }
    info.ground = groundOf(open.objects);
    open.picker = std::make_shared<const pick::Picker>(std::move(surfaces));
    return open;
}

}  // namespace eyrie
