// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/source_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/import/dem_source.h"
#include "renderer/import/joined_meshes.h"
#include "renderer/import/mesh_reader.h"
#include "renderer/import/named_images.h"
#include "renderer/import/ply_reader.h"

namespace eyrie::truth {
namespace {

constexpr std::uint64_t kBytesOfFileByte = 8;
/// A vertex while it is read: position, normal, colour, texture coordinates.
constexpr std::uint64_t kBytesOfReadVertex = 48;
constexpr std::uint64_t kBytesOfReadTriangle = 12;

std::uint64_t posts(const terrain::GridFrame& frame) {
    return static_cast<std::uint64_t>(frame.columns) * static_cast<std::uint64_t>(frame.rows);
}

/// Uniform decimation has every second post of every second row beside it, and a byte for each
/// while it counts what is in view.
std::uint64_t bytesOfTerrain(std::uint64_t count) {
    const std::uint64_t ofLevel = count / 4;
    return TerrainRayCaster::bytesFor(count) + TerrainRayCaster::bytesFor(ofLevel) + ofLevel;
}

absl::StatusOr<std::uint64_t> bytesOfMeshFile(const std::string& path) {
    if (import::isPly(path)) {
        ASSIGN_OR_RETURN(const import::PlySize size, import::measurePly(path));
        return std::max(
            size.fileBytes + size.vertices * kBytesOfReadVertex + size.faces * kBytesOfReadTriangle,
            MeshRayCaster::bytesFor(size.vertices, size.faces));
    }
    ASSIGN_OR_RETURN(std::vector<std::string> files, import::companionsOf(path));
    std::erase_if(files, import::isImageName);  // coded about as they are, and not kept
    files.push_back(path);
    std::uint64_t sum = 0;
    for (const std::string& file : files) {
        std::error_code ignored;
        const std::uintmax_t bytes = std::filesystem::file_size(file, ignored);
        sum += ignored ? 0 : kBytesOfFileByte * bytes;
    }
    return sum;
}

absl::StatusOr<SourceFacts> inspectTerrain(const std::vector<std::string>& paths) {
    ASSIGN_OR_RETURN(const import::DemSource source, import::openDems(paths, {}));
    return SourceFacts{source.hash, bytesOfTerrain(posts(source.posts->frame()))};
}

absl::StatusOr<SourceFacts> inspectMesh(const std::vector<std::string>& paths) {
    SourceFacts facts;
    ASSIGN_OR_RETURN(facts.hash, import::meshSourceHash(paths));
    for (const std::string& path : paths) {
        ASSIGN_OR_RETURN(const std::uint64_t bytes, bytesOfMeshFile(path));
        facts.neededBytes += bytes;
    }
    return facts;
}

/// A strip at a time: of what is read at once the source holds a second copy.
absl::Status readHeights(import::HeightSource& posts, std::vector<float>& heights) {
    constexpr int kStripRows = 256;
    const terrain::GridFrame& frame = posts.frame();
    const int strips = (frame.rows - 1) / kStripRows + 1;
    for (int i = 0; i < strips; ++i) {
        const int row = kStripRows * (posts.isLastRowFirst() ? strips - 1 - i : i);
        const int rows = std::min(kStripRows, frame.rows - row);
        RETURN_IF_ERROR(
            posts.read({0, row, frame.columns, rows},
                       heights.data() + static_cast<std::ptrdiff_t>(row) * frame.columns));
    }
    return absl::OkStatus();
}

absl::StatusOr<SourceSurface> readTerrain(const std::vector<std::string>& paths) {
    ASSIGN_OR_RETURN(const import::DemSource source, import::openDems(paths, {}));
    const terrain::GridFrame& frame = source.posts->frame();
    HeightGrid grid{.columns = frame.columns,
                    .rows = frame.rows,
                    .heights = std::vector<float>(posts(frame)),
                    .origin = frame.origin,
                    .perColumn = frame.perColumn,
                    .perRow = frame.perRow};
    RETURN_IF_ERROR(readHeights(*source.posts, grid.heights));
    if (std::ranges::all_of(grid.heights, [](float height) { return std::isnan(height); }))
        return absl::InvalidArgumentError(fmt::format("{}: has no data at any of its {} x {} posts",
                                                      paths.front(), grid.columns, grid.rows));
    return SourceSurface{std::make_shared<TerrainRayCaster>(std::move(grid)), nullptr, source.hash};
}

/// Of a triangle that is drawn from one side.
Sight sightOfOneSide(const MeshSides& sides) {
    return sides.areTurned ? Sight::Unsure : Sight::SureFromFront;
}

Sight sightOf(const mesh::Material& material, const MeshSides& sides) {
    if (material.isSeeThrough() || (material.flags & import::kAlphaByImage) != 0)
        return Sight::Unsure;
    return material.isOneSided() || (sides.isOneSided && !material.isTwoSided())
               ? sightOfOneSide(sides)
               : Sight::Sure;
}

std::vector<Sight> sightsOf(const import::TriangleMesh& mesh, const MeshSides& sides) {
    if (mesh.materials.empty())
        return sides.isOneSided ? std::vector(mesh.triangles.size(), sightOfOneSide(sides))
                                : std::vector<Sight>();
    std::vector<Sight> sights;
    for (const auto& triangle : mesh.triangles)
        sights.push_back(sightOf(mesh.materials[mesh.materialOf[triangle[0]]], sides));
    return sights;
}

absl::StatusOr<SourceSurface> readMesh(const std::vector<std::string>& paths,
                                       const MeshSides& sides) {
    ASSIGN_OR_RETURN(import::TriangleMesh mesh, import::readMeshes(paths));
    if (mesh.triangles.empty())
        return absl::InvalidArgumentError(fmt::format("{}: has no triangles", paths.front()));
    std::vector<Sight> sights = sightsOf(mesh, sides);
    TriangleMesh triangles{std::move(mesh.positions), std::move(mesh.triangles), std::move(sights)};
    mesh = {};
    ASSIGN_OR_RETURN(const std::uint64_t hash, import::meshSourceHash(paths));
    return SourceSurface{nullptr, std::make_shared<MeshRayCaster>(std::move(triangles)), hash};
}

}  // namespace

absl::StatusOr<SourceFacts> inspectSource(fabric::ObjectKind kind,
                                          const std::vector<std::string>& paths) {
    return kind == fabric::ObjectKind::Mesh ? inspectMesh(paths) : inspectTerrain(paths);
}

absl::StatusOr<SourceSurface> readSource(fabric::ObjectKind kind,
                                         const std::vector<std::string>& paths,
                                         const MeshSides& sides) {
    return kind == fabric::ObjectKind::Mesh ? readMesh(paths, sides) : readTerrain(paths);
}

}  // namespace eyrie::truth
