// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/mesh_import.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <absl/status/status.h>
#include <fmt/format.h>
#include <oneapi/tbb/parallel_invoke.h>

#include "fabric/status.h"
#include "renderer/import/joined_meshes.h"
#include "renderer/import/mesh_import_parts.h"
#include "renderer/import/mesh_reader.h"
#include "renderer/import/ply_reader.h"
#include "renderer/import/stopwatch.h"
#include "renderer/mesh/back_faces.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/mesh/eym_writer.h"
#include "renderer/mesh/kd_tree.h"
#include "renderer/mesh/output_file.h"
#include "renderer/page/remote_name.h"

namespace eyrie::import {
namespace {

absl::Status checkPaths(const std::vector<std::string>& sourcePaths, const std::string& outPath) {
    if (sourcePaths.empty())
        return absl::InvalidArgumentError("no source is named; name a mesh file");
    std::error_code ignored;
    for (const std::string& sourcePath : sourcePaths) {
        if (!page::isPlainPath(sourcePath))
            return absl::InvalidArgumentError(fmt::format(
                "{}: a mesh is read from a file of this machine; download or unpack this one",
                sourcePath));
        if (std::filesystem::equivalent(sourcePath, outPath, ignored))
            return absl::InvalidArgumentError(
                fmt::format("{}: is source and output at once; name another output file", outPath));
    }
    return absl::OkStatus();
}

absl::Status checkOptions(const MeshImportOptions& options) {
    if (options.leafTriangles < 1 || options.leafTriangles > mesh::kMaxLeafVertices)
        return absl::InvalidArgumentError(fmt::format("leafTriangles: found {}, expected 1 to {}",
                                                      options.leafTriangles,
                                                      mesh::kMaxLeafVertices));
    if (options.pack.latticeBits < mesh::kMinLatticeBits ||
        options.pack.latticeBits > mesh::kLatticeBits)
        return absl::InvalidArgumentError(fmt::format("latticeBits: found {}, expected {} to {}",
                                                      options.pack.latticeBits,
                                                      mesh::kMinLatticeBits, mesh::kLatticeBits));
    if (!(options.pack.creaseDegrees >= 0 && options.pack.creaseDegrees <= 180))
        return absl::InvalidArgumentError(
            fmt::format("creaseDegrees: found {}, expected 0 to 180", options.pack.creaseDegrees));
    return absl::OkStatus();
}

/// Why nothing of a mesh is left may be what reading it has noted, as that its corners are rounded.
absl::Status withNotes(const absl::Status& status, const std::vector<std::string>& notes) {
    std::string message(status.message().data(), status.message().size());
    for (const std::string& note : notes) message += "; " + note;
    return {status.code(), message};
}

absl::StatusOr<MeshImportReport> build(TriangleMesh source, mesh::OutputFile& out,
                                       const MeshImportOptions& options,
                                       const ImportControl& control, std::uint64_t sourceHash) {
    MeshImportReport report;
    Stopwatch watch;
    report.droppedFaces = source.droppedFaces;
    report.notes = std::move(source.notes);
    const absl::StatusOr<mesh::PackedMesh> made =
        packMesh(std::move(source), report.counts, options.pack, control);
    if (!made.ok())
        return absl::IsInvalidArgument(made.status()) ? withNotes(made.status(), report.notes)
                                                      : made.status();
    const mesh::PackedMesh& packed = *made;
    report.seconds.pack = watch.lap();

    control.report("tree", 0);
    ASSIGN_OR_RETURN(const mesh::KdTree tree,
                     mesh::buildKdTree(packed.positions, packed.triangles, {options.leafTriangles},
                                       control.stop));
    control.report("tree", 1);
    report.seconds.tree = watch.lap();

    control.report("levels", 0);
    // The two have stretches that keep one core only.
    absl::StatusOr<mesh::LodTree> lod;
    mesh::Backs backs;
    oneapi::tbb::parallel_invoke(
        [&] {
            lod = mesh::buildLodTree(
                packed, tree, {.leafTriangles = options.leafTriangles},
                [&control](double share) { control.report("levels", share); }, control.stop);
        },
        [&] { backs = mesh::findBacks(packed, tree); });
    RETURN_IF_ERROR(lod.status());
    control.report("levels", 1);
    report.seconds.levels = watch.lap();
    report.levels = lod->levels;

    control.report("writing", 0);
    RETURN_IF_ERROR(mesh::writeEym(packed, tree, *lod, backs,
                                   {.isCoded = !options.isRaw,
                                    .sourceHash = sourceHash,
                                    .turnedTriangles = report.counts.orient.turnedTriangles},
                                   out, control.stop));
    report.seconds.write = watch.lap();
    report.triangles = packed.triangles.size();
    report.vertices = packed.positions.size();
    report.nodes = tree.nodes.size();
    report.pointNodes = lod->pointNodes();
    report.stepMetres = packed.lattice.stepMetres;
    report.errorMetres = packed.errorMetres();
    report.coarsestErrorMetres = lod->errorMetres.front();
    return report;
}

/// Puts the file in place.
absl::StatusOr<MeshImportReport> finish(absl::StatusOr<MeshImportReport> report,
                                        mesh::OutputFile& out, Stopwatch watch,
                                        const ImportControl& control) {
    RETURN_IF_ERROR(report.status());
    RETURN_IF_ERROR(control.check());
    RETURN_IF_ERROR(out.commit());
    control.report("writing", 1);
    report->bytes = out.size();
    report->seconds.write += watch.lap();
    report->seconds.total = watch.total();
    return report;
}

/// Runs `work`, turning what the standard library throws for want of memory into a status.
template <typename Work>
absl::StatusOr<MeshImportReport> withinMemory(const std::string& name, const Work& work) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
    } catch (const std::length_error&) {
    }
    return absl::ResourceExhaustedError(
        fmt::format("{}: memory ran out during the import; free memory or split the mesh", name));
}

std::uint64_t bytesOf(const std::vector<std::string>& paths) {
    std::uint64_t sum = 0;
    for (const std::string& path : paths) {
        std::error_code ignored;
        const std::uintmax_t bytes = std::filesystem::file_size(path, ignored);
        sum += ignored ? 0 : bytes;
    }
    return sum;
}

absl::Status exceedsMemory(const std::string& name, std::uint64_t needed,
                           const MeshImportOptions& options, const std::string& remedy) {
    return absl::ResourceExhaustedError(fmt::format(
        "{}: importing it takes about {} MiB of memory, of which it may use {}; {}allow more "
        "memory",
        name, (needed >> 20) + 1, options.memoryBytes >> 20,
        remedy.empty() ? remedy : remedy + ", or "));
}

/// Of PLY files, as their headers have it.
absl::StatusOr<PlySize> measureAll(const std::vector<std::string>& paths) {
    PlySize all;
    for (const std::string& path : paths) {
        ASSIGN_OR_RETURN(const PlySize size, measurePly(path));
        all.vertices += size.vertices;
        all.faces += size.faces;
        all.fileBytes += size.fileBytes;
        all.splitVertices += size.splitVertices;
        all.isTextured = all.isTextured || size.isTextured;
    }
    return all;
}

/// How many triangles of PLY files to import at once; nothing where all of them fit the memory.
absl::StatusOr<std::optional<std::uint64_t>> partsOf(const std::vector<std::string>& paths,
                                                     const MeshImportOptions& options) {
    const bool mayBeParted = std::all_of(paths.begin(), paths.end(), isPly);
    if (options.memoryBytes == 0 || !mayBeParted)
        return std::nullopt;
    ASSIGN_OR_RETURN(const PlySize size, measureAll(paths));
    const std::uint64_t needed =
        importBytes(size.faces, size.splitVertices, size.fileBytes, options, size.isTextured);
    if (needed + kProgramBytes <= options.memoryBytes)
        return std::nullopt;
    const std::uint64_t atOnce =
        trianglesAtOnce(options.memoryBytes, size.faces, size.vertices, options);
    // Where parts are no way to less, or lose something, the program itself does not count.
    const bool mustBeWhole = options.pack.orients || size.isTextured || atOnce == 0;
    if (needed <= options.memoryBytes && mustBeWhole)
        return std::nullopt;
    if (options.pack.orients)
        return exceedsMemory(nameOf(paths), needed, options,
                             "turning faces takes all of a mesh at once: leave that out");
    if (atOnce == 0)
        return exceedsMemory(nameOf(paths), needed, options, "split the mesh");
    return atOnce;
}

/// What else than more memory makes a mesh of so many triangles fit; nothing for a PLY of triangles
/// with textures, of which parts have none.
std::string remedyFor(const std::vector<std::string>& paths, std::uint64_t triangles) {
    if (!std::all_of(paths.begin(), paths.end(), isPly))
        return "convert it to PLY, which is imported part by part";
    const absl::StatusOr<PlySize> size = measureAll(paths);
    if (size.ok() && size->isTextured && triangles <= size->faces)
        return "";
    return "triangulate it before export, so that it is imported part by part";
}

absl::StatusOr<MeshImportReport> importWhole(const std::vector<std::string>& paths,
                                             mesh::OutputFile& out, MeshImportOptions options,
                                             const ImportControl& control) {
    const std::uint64_t bytes = bytesOf(paths);
    if (options.memoryBytes != 0 && bytes > options.memoryBytes)
        return exceedsMemory(nameOf(paths), bytes, options, remedyFor(paths, 0));
    const bool isByFormat = options.pack.normals == NormalSource::ByFormat;
    Stopwatch watch;
    ASSIGN_OR_RETURN(TriangleMesh source,
                     readMeshes(paths, control, {isByFormat, options.memoryBytes}));
    if (isByFormat)
        options.pack.normals = source.normals.empty() ? NormalSource::Smooth : NormalSource::File;
    ASSIGN_OR_RETURN(const std::uint64_t hash, meshSourceHash(paths));
    std::uint64_t needed = importBytes(source.triangles.size(), source.positions.size(), 0, options,
                                       !source.textureCoordinates.empty());
    for (const mesh::Image& image : source.images) needed += image.blocks.size();
    if (options.memoryBytes != 0 && needed > options.memoryBytes)
        return exceedsMemory(nameOf(paths), needed, options,
                             remedyFor(paths, source.triangles.size()));
    const double readSeconds = watch.lap();
    auto report = build(std::move(source), out, options, control, hash);
    if (!report.ok())
        return fabric::withContext(report.status(), nameOf(paths));
    report->seconds.read = readSeconds;
    return report;
}

absl::StatusOr<MeshImportReport> importFiles(const std::vector<std::string>& paths,
                                             mesh::OutputFile& out,
                                             const MeshImportOptions& options,
                                             const ImportControl& control) {
    ASSIGN_OR_RETURN(const std::optional<std::uint64_t> atOnce, partsOf(paths, options));
    if (!atOnce)
        return importWhole(paths, out, options, control);
    ASSIGN_OR_RETURN(const std::uint64_t hash, meshSourceHash(paths));
    return importInParts(paths, out, *atOnce, options, control, hash);
}

}  // namespace

absl::StatusOr<MeshImportReport> importMesh(const std::vector<std::string>& sourcePaths,
                                            const std::string& outPath,
                                            const MeshImportOptions& options,
                                            const ImportControl& control) {
    RETURN_IF_ERROR(checkPaths(sourcePaths, outPath));
    RETURN_IF_ERROR(checkOptions(options));
    const Stopwatch watch;
    ASSIGN_OR_RETURN(mesh::OutputFile out, mesh::OutputFile::create(outPath, control.stop));
    auto report =
        finish(withinMemory(nameOf(sourcePaths),
                            [&] { return importFiles(sourcePaths, out, options, control); }),
               out, watch, control);
    if (report.ok())
        report->sourceBytes = bytesOf(sourcePaths);
    return report;
}

absl::StatusOr<MeshImportReport> importMesh(TriangleMesh source, const std::string& outPath,
                                            const MeshImportOptions& options,
                                            const ImportControl& control,
                                            std::uint64_t sourceHash) {
    RETURN_IF_ERROR(checkOptions(options));
    const Stopwatch watch;
    ASSIGN_OR_RETURN(mesh::OutputFile out, mesh::OutputFile::create(outPath, control.stop));
    return finish(
        withinMemory(outPath,
                     [&] { return build(std::move(source), out, options, control, sourceHash); }),
        out, watch, control);
}

}  // namespace eyrie::import
