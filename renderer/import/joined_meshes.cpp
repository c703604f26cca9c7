// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/joined_meshes.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <stop_token>
#include <string_view>
#include <utility>
#include <vector>

#include <absl/status/status.h>
#include <fmt/format.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include "fabric/status.h"
#include "renderer/import/reading_process.h"
#include "renderer/import/source_lights.h"
#include "renderer/mesh/eym_format.h"

namespace eyrie::import {
namespace {

/// Adds the materials of `part`; what has none is plain.
absl::Status appendMaterials(TriangleMesh& whole, TriangleMesh& part, const std::string& path) {
    if (whole.materials.empty() && part.materials.empty())
        return absl::OkStatus();
    if (whole.materials.empty())
        whole.materials.emplace_back();
    whole.materialOf.resize(whole.positions.size(), 0);
    part.materialOf.resize(part.positions.size(), 0);
    if (part.materials.empty())
        part.materials.emplace_back();
    std::vector<std::uint16_t> numberOf;
    for (mesh::Material material : part.materials) {
        if (material.hasImage())
            material.image += static_cast<std::int32_t>(whole.images.size());
        const auto known = std::find(whole.materials.begin(), whole.materials.end(), material);
        numberOf.push_back(static_cast<std::uint16_t>(known - whole.materials.begin()));
        if (known == whole.materials.end())
            whole.materials.push_back(material);
    }
    if (whole.materials.size() > mesh::kMaxMaterials)
        return absl::InvalidArgumentError(fmt::format(
            "{}: with it the mesh has more than {} materials; import the files in parts", path,
            mesh::kMaxMaterials));
    for (const std::uint16_t material : part.materialOf)
        whole.materialOf.push_back(numberOf[material]);
    for (mesh::Image& image : part.images) whole.images.push_back(std::move(image));
    return absl::OkStatus();
}

/// Adds `part` to `whole`, which has colours, normals and materials as soon as one of them does.
absl::Status append(TriangleMesh& whole, TriangleMesh part, const std::string& path) {
    const std::size_t first = whole.positions.size();
    if (first + part.positions.size() >= std::numeric_limits<std::uint32_t>::max())
        return absl::InvalidArgumentError(fmt::format(
            "{}: with it the mesh has more than 2^32 vertices; import the files in parts", path));
    const std::size_t count = first + part.positions.size();
    const auto join = [&](auto& to, const auto& from, const auto& otherwise) {
        if (to.empty() && from.empty())
            return;
        to.resize(first, otherwise);
        to.insert(to.end(), from.begin(), from.end());
        to.resize(count, otherwise);
    };
    join(whole.normals, part.normals, glm::vec3(0));
    join(whole.colours, part.colours, kPlainColour);
    join(whole.textureCoordinates, part.textureCoordinates, glm::vec2(0));
    RETURN_IF_ERROR(appendMaterials(whole, part, path));
    whole.positions.insert(whole.positions.end(), part.positions.begin(), part.positions.end());
    for (auto triangle : part.triangles) {
        for (std::uint32_t& corner : triangle) corner += static_cast<std::uint32_t>(first);
        whole.triangles.push_back(triangle);
    }
    whole.roundingMetres = std::max(whole.roundingMetres, part.roundingMetres);
    fabric::append(whole.lights, part.lights);
    whole.droppedFaces += part.droppedFaces;
    for (const std::string& note : part.notes)
        whole.notes.push_back(fmt::format("{}: {}", path, note));
    return absl::OkStatus();
}

template <typename T>
std::uint64_t bytesOf(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

/// What a mesh takes here.
std::uint64_t bytesOf(const TriangleMesh& mesh) {
    std::uint64_t images = 0;
    for (const mesh::Image& image : mesh.images) images += image.blocks.size();
    return images + bytesOf(mesh.positions) + bytesOf(mesh.triangles) + bytesOf(mesh.normals) +
           bytesOf(mesh.colours) + bytesOf(mesh.textureCoordinates) + bytesOf(mesh.materialOf);
}

/// How many may be read at a time: none needs more than the largest may.
std::size_t filesAtOnce(std::span<const std::string> paths, std::uint64_t memoryBytes) {
    const auto cores = static_cast<std::uint64_t>(tbb::this_task_arena::max_concurrency());
    std::uint64_t largest = 0;
    for (const std::string& path : paths) largest = std::max(largest, bytesToRead(path));
    const std::uint64_t room =
        memoryBytes == 0 ? cores : memoryBytes / ReadingLimits::forFile(largest).memoryBytes;
    return std::max<std::size_t>(1, std::min(cores, room));
}

/// Files that are read side by side, and go into one mesh in their order.
class Joining {
public:
    Joining(std::span<const std::string> paths, const ImportControl& control,
            const MeshReading& reading)
        : paths_(paths), control_(control), reading_(reading), shares_(paths.size()) {}

    absl::StatusOr<TriangleMesh> run() &&;

private:
    struct Part {
        std::size_t file = 0;
        absl::StatusOr<TriangleMesh> mesh;
    };

    ImportControl controlOf(std::size_t file);
    void report(std::string_view stage, std::size_t file, double fraction);
    absl::Status checkRoom(const TriangleMesh& part, const std::string& path) const;
    void add(Part& part);

    const std::span<const std::string> paths_;
    const ImportControl& control_;
    const MeshReading& reading_;
    std::stop_source stop_;  ///< of what comes after a file that cannot be read, too
    std::mutex mutex_;       ///< of the reports
    std::vector<double> shares_;
    TriangleMesh whole_;
    absl::Status status_;
};

ImportControl Joining::controlOf(std::size_t file) {
    return {
        [this, file](std::string_view stage, double fraction) { report(stage, file, fraction); },
        stop_.get_token()};
}

void Joining::report(std::string_view stage, std::size_t file, double fraction) {
    const std::lock_guard lock(mutex_);
    shares_[file] = fraction;
    const double sum = std::accumulate(shares_.begin(), shares_.end(), 0.0);
    control_.report(stage, sum / static_cast<double>(shares_.size()));
}

absl::Status Joining::checkRoom(const TriangleMesh& part, const std::string& path) const {
    const std::uint64_t most = reading_.memoryBytes;
    if (most == 0 || bytesOf(whole_) + bytesOf(part) <= most)
        return absl::OkStatus();
    return absl::ResourceExhaustedError(fmt::format(
        "{}: with it the files take more than the {} MiB of memory that the import may use; import "
        "fewer at once, bring all of them to PLY of triangles, which is imported part by part, or "
        "allow more memory",
        path, most >> 20));
}

void Joining::add(Part& part) {
    if (!status_.ok())
        return;
    const std::string& path = paths_[part.file];
    status_ = part.mesh.status();
    if (status_.ok())
        status_ = checkRoom(*part.mesh, path);
    if (status_.ok())
        status_ = append(whole_, *std::move(part.mesh), path);
    if (!status_.ok())
        stop_.request_stop();
}

absl::StatusOr<TriangleMesh> Joining::run() && {
    const std::stop_callback stopsAll(control_.stop, [this] { stop_.request_stop(); });
    std::size_t next = 0;
    using PartPointer = std::shared_ptr<Part>;
    tbb::parallel_pipeline(
        filesAtOnce(paths_, reading_.memoryBytes),
        tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order,
                                            [&](tbb::flow_control& flow) {
                                                if (next == paths_.size() || stop_.stop_requested())
                                                    flow.stop();
                                                return next++;
                                            }) &
            tbb::make_filter<std::size_t, PartPointer>(
                tbb::filter_mode::parallel,
                [&](std::size_t file) {
                    return std::make_shared<Part>(
                        Part{file, readMesh(paths_[file], controlOf(file), reading_)});
                }) &
            tbb::make_filter<PartPointer, void>(tbb::filter_mode::serial_in_order,
                                                [&](const PartPointer& part) { add(*part); }));
    RETURN_IF_ERROR(control_.check());
    RETURN_IF_ERROR(status_);
    limitLights(whole_);
    return std::move(whole_);
}

}  // namespace

absl::StatusOr<TriangleMesh> readMeshes(std::span<const std::string> paths,
                                        const ImportControl& control, const MeshReading& reading) {
    if (paths.size() == 1)
        return readMesh(paths.front(), control, reading);
    return Joining(paths, control, reading).run();
}

std::string nameOf(std::span<const std::string> paths) {
    return paths.size() == 1 ? paths.front()
                             : fmt::format("{} and {} more", paths.front(), paths.size() - 1);
}

}  // namespace eyrie::import
