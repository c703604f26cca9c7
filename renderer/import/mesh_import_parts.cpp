// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/mesh_import_parts.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <absl/status/status.h>

#include "fabric/status.h"
#include "renderer/import/joined_meshes.h"
#include "renderer/import/mesh_backs.h"
#include "renderer/import/mesh_part.h"
#include "renderer/import/mesh_sharing.h"
#include "renderer/import/mesh_split.h"
#include "renderer/import/mesh_spool.h"
#include "renderer/import/stopwatch.h"
#include "renderer/mesh/eym_join.h"

namespace eyrie::import {
namespace {

/// What an import holds at most of each triangle, of which there are two a vertex (measured: 44 to
/// 59), and where corners have normals or places in textures of their own, or source positions are
/// kept (71 to 190).
constexpr std::uint64_t kTriangleBytes = 64;
constexpr std::uint64_t kRichTriangleBytes = 200;
/// More of each vertex beyond one of two triangles: loose triangles have two and a half such.
constexpr std::uint64_t kLooseVertexBytes = 96;
/// The program, buffers of rows, and the cache of positions.
constexpr std::uint64_t kFixedBytes = std::uint64_t{160} << 20;
/// More of a part's, which is gathered before it is imported.
constexpr std::uint64_t kGatherBytes = 64;

std::uint64_t bytesPerTriangle(std::uint64_t triangles, std::uint64_t vertices,
                               const MeshImportOptions& options, bool isTextured) {
    const bool isRich = isTextured || options.pack.keepsExact ||
                        options.pack.normals == NormalSource::Crease ||
                        options.pack.normals == NormalSource::File;
    const std::uint64_t looseVertices = vertices - std::min(vertices, triangles / 2);
    return (isRich ? kRichTriangleBytes : kTriangleBytes) +
           looseVertices * kLooseVertexBytes / std::max<std::uint64_t>(triangles, 1);
}

void addLevels(std::vector<mesh::LodLevel>& to, const std::vector<mesh::LodLevel>& from) {
    to.resize(std::max(to.size(), from.size()));
    for (std::size_t i = 0; i < from.size(); ++i) {
        to[i].nodes += from[i].nodes;
        to[i].points += from[i].points;
        to[i].normals.hold(from[i].normals);
        to[i].trianglesBefore += from[i].trianglesBefore;
        to[i].trianglesAfter += from[i].trianglesAfter;
        to[i].largestErrorMetres = std::max(to[i].largestErrorMetres, from[i].largestErrorMetres);
        to[i].largestReachMetres = std::max(to[i].largestReachMetres, from[i].largestReachMetres);
    }
}

/// The nodes of a split, depth first, with what is written of each.
class PartWalk {
public:
    PartWalk(const PartWork& work, MeshImportReport& report, const ImportControl& control)
        : work_(work), report_(report), control_(control), joined_(work.split.nodes.size()) {}

    absl::StatusOr<PartSurface> visit(std::size_t index);
    const std::vector<mesh::JoinedNode>& joined() const { return joined_; }

private:
    absl::StatusOr<WrittenPart> write(std::size_t index);

    const PartWork& work_;
    MeshImportReport& report_;
    const ImportControl& control_;
    std::vector<mesh::JoinedNode> joined_;
    std::uint64_t done_ = 0;  ///< triangles
};

absl::StatusOr<WrittenPart> PartWalk::write(std::size_t index) {
    const SplitNode& node = work_.split.nodes[index];
    if (!node.isPart()) {
        ASSIGN_OR_RETURN(PartSurface left, visit(static_cast<std::size_t>(node.left)));
        ASSIGN_OR_RETURN(PartSurface right, visit(static_cast<std::size_t>(node.right)));
        return writeAbove(work_, node, std::move(left), std::move(right), control_);
    }
    const double total = static_cast<double>(work_.spool.triangleCount);
    const std::uint64_t count = node.end - node.begin;
    const ImportControl partly{
        [&](std::string_view stage, double share) {
            control_.report(
                stage, (static_cast<double>(done_) + share * static_cast<double>(count)) / total);
        },
        control_.stop};
    auto written = writePart(work_, node.firstPart, partly);
    done_ += count;
    return written;
}

absl::StatusOr<PartSurface> PartWalk::visit(std::size_t index) {
    RETURN_IF_ERROR(control_.check());
    ASSIGN_OR_RETURN(WrittenPart written, write(index));
    const SplitNode& node = work_.split.nodes[index];
    joined_[index] = {node.left, node.right, written.offset};
    report_.nodes += written.nodes;
    report_.pointNodes += written.pointNodes;
    report_.vertices += written.vertices;
    report_.coarsestErrorMetres = written.errorMetres;  // in the end that of the root
    report_.counts.normalsComputed = report_.counts.normalsComputed || written.computedNormals;
    addLevels(report_.levels, written.levels);
    return std::move(written.surface);
}

/// That of all source positions which triangles use.
absl::StatusOr<std::optional<mesh::ExactForm>> exactFormOf(const MeshSpool& spool,
                                                           const PackOptions& options) {
    std::optional<mesh::ExactForm> form;
    if (!options.keepsExact)
        return form;
    form = mesh::ExactForm::Float32;
    std::uint64_t vertex = 0;
    RETURN_IF_ERROR(
        spool.positions.forBlocks(0, spool.vertexCount, [&](std::span<const fabric::Vec3> block) {
            for (const fabric::Vec3& position : block)
                if (spool.isUsed[vertex++])
                    form = std::max(*form, mesh::exactFormOf(std::span(&position, 1)));
            return absl::OkStatus();
        }));
    return form;
}

}  // namespace

std::uint64_t importBytes(std::uint64_t triangles, std::uint64_t vertices,
                          std::uint64_t sourceBytes, const MeshImportOptions& options,
                          bool isTextured) {
    return sourceBytes + triangles * bytesPerTriangle(triangles, vertices, options, isTextured) +
           vertices;
}

std::uint64_t trianglesAtOnce(std::uint64_t memoryBytes, std::uint64_t triangles,
                              std::uint64_t vertices, const MeshImportOptions& options) {
    const std::uint64_t fixed = kFixedBytes + triangles / 8 + vertices / 4;
    return memoryBytes <= fixed
               ? 0
               : (memoryBytes - fixed) /
                     (bytesPerTriangle(triangles, vertices, options, false) + kGatherBytes);
}

absl::StatusOr<MeshImportReport> importInParts(std::span<const std::string> paths,
                                               mesh::OutputFile& out, std::uint64_t atOnce,
                                               const MeshImportOptions& options,
                                               const ImportControl& control,
                                               std::uint64_t sourceHash) {
    MeshImportReport report;
    Stopwatch watch;
    const std::string& path = out.path();
    atOnce =
        std::max<std::uint64_t>({atOnce, options.leafTriangles, mesh::LodOptions().nodeTriangles});
    ASSIGN_OR_RETURN(MeshSpool spool, spoolMeshes(paths, path, control));
    report.droppedFaces = spool.droppedFaces;
    report.notes = std::move(spool.notes);
    report.seconds.read = watch.lap();

    RETURN_IF_ERROR(fabric::withContext(
        placeOnLattice(spool, options.pack.latticeBits, atOnce, path, report.counts, control),
        nameOf(paths)));
    ASSIGN_OR_RETURN(const std::optional<std::vector<bool>> isBehind,
                     findBacks(spool, atOnce, path, control));
    report.seconds.pack = watch.lap();

    ASSIGN_OR_RETURN(const MeshSplit split, splitMesh(spool, atOnce, path, control));
    ASSIGN_OR_RETURN(const MeshSharing sharing, findSharing(split, atOnce, path, control));
    report.seconds.tree = watch.lap();

    control.report("levels", 0);
    ASSIGN_OR_RETURN(mesh::OutputFile parts, mesh::OutputFile::createUnnamed(path));
    ASSIGN_OR_RETURN(const std::optional<mesh::ExactForm> exactForm,
                     exactFormOf(spool, options.pack));
    const PartWork work{spool, split, sharing, isBehind, options, sourceHash, exactForm, parts};
    PartWalk walk(work, report, control);
    RETURN_IF_ERROR(walk.visit(0).status());
    control.report("levels", 1);
    report.seconds.levels = watch.lap();

    control.report("writing", 0);
    RETURN_IF_ERROR(mesh::joinEym(parts, walk.joined(), report.vertices, out, control.stop));
    report.triangles = spool.triangleCount;
    const std::uint64_t left = report.counts.isolatedVertices + report.vertices;
    report.counts.weldedVertices = spool.vertexCount > left ? spool.vertexCount - left : 0;
    report.stepMetres = spool.lattice.stepMetres;
    report.errorMetres = spool.lattice.errorMetres();
    report.seconds.write = watch.lap();
    return report;
}

}  // namespace eyrie::import
