// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/eym_format.h"

#include <algorithm>

#include <absl/status/status.h>
#include <fmt/format.h>
#include <xxhash.h>

#include "fabric/status.h"
#include "renderer/mesh/eym_check.h"
#include "renderer/page/remote_name.h"

namespace eyrie::mesh {
namespace {

template <typename T>
std::uint64_t hash(std::span<const T> values, std::uint64_t seed) {
    return XXH64(values.data(), values.size_bytes(), seed);
}

}  // namespace

std::uint64_t tableChecksum(const EymHeader& header, std::span<const Node> nodes) {
    EymHeader zeroed = header;
    zeroed.checksum = 0;
    return hash(nodes, XXH64(&zeroed, sizeof zeroed, 0));
}

std::uint64_t geometryChecksum(const NodeGeometry& geometry) {
    const std::uint64_t vertices =
        hash(geometry.colours, hash(geometry.normals, hash(geometry.positions, 0)));
    return hash(geometry.indices, vertices);
}

absl::StatusOr<std::uint64_t> contentHash(const std::string& path) {
    ASSIGN_OR_RETURN(const MappedFile file, MappedFile::open(path));
    return contentHash(file.bytes());
}

std::uint64_t contentHash(std::span<const std::byte> bytes) { return hash(bytes, 0); }

absl::StatusOr<EymFile> EymFile::open(const std::string& path, const page::SourceOptions& options,
                                      const page::PageSource::Progress& progress) {
    if (page::isRemote(path))
        return openCopied(path, options, progress);
    ASSIGN_OR_RETURN(MappedFile mapped, MappedFile::open(path));
    return openMapped(path, std::move(mapped));
}

absl::StatusOr<EymFile> EymFile::openCopied(const std::string& url,
                                            const page::SourceOptions& options,
                                            const page::PageSource::Progress& progress) {
    ASSIGN_OR_RETURN(const std::unique_ptr<page::PageSource> source,
                     page::PageSource::open(url, sizeof(EymHeader), options));
    RETURN_IF_ERROR(fabric::withContext(checkHeader(source->head(), source->sizeBytes()), url));
    absl::StatusOr<EymFile> file = absl::DataLossError(url);
    for (int attempt = 0; attempt < 2 && absl::IsDataLoss(file.status()); ++attempt) {
        if (attempt > 0)  // the copy may be damaged, and the file sound
            source->forget();
        ASSIGN_OR_RETURN(const std::string copy, source->wholeFile(progress));
        ASSIGN_OR_RETURN(MappedFile mapped, MappedFile::open(copy));
        file = openMapped(url, std::move(mapped));
    }
    return file;
}

absl::StatusOr<EymFile> EymFile::openMapped(const std::string& path, MappedFile mapped) {
    RETURN_IF_ERROR(fabric::withContext(checkHeader(mapped.bytes(), mapped.bytes().size()), path));
    EymFile file(path, std::move(mapped));
    const EymHeader& header = file.header();
    file.lattice_ = {{header.originMetres[0], header.originMetres[1], header.originMetres[2]},
                     header.stepMetres};
    file.nodes_ = file.section<Node>(header.nodesOffset, 0, header.nodeCount);
    if (tableChecksum(header, file.nodes_) != header.checksum)
        return absl::DataLossError(fmt::format(
            "{}: the checksum of header and node table does not match; import the mesh again",
            path));
    auto levels = checkNodes(header, file.nodes_);
    if (!levels.ok())
        return fabric::withContext(levels.status(), path);
    file.levels_ = *levels;
    file.verified_ = std::make_unique<std::atomic<bool>[]>(header.nodeCount);
    return file;
}

template <typename T>
std::span<const T> EymFile::section(std::uint64_t offset, std::uint64_t first,
                                    std::uint64_t count) const {
    const std::byte* start = file_.bytes().data() + offset + first * sizeof(T);
    return {reinterpret_cast<const T*>(start), count};
}

fabric::Box EymFile::bounds(std::uint32_t node) const {
    return {lattice_.metres(nodes_[node].boxMin), lattice_.metres(nodes_[node].boxMax)};
}

absl::StatusOr<NodeGeometry> EymFile::geometry(std::uint32_t index) const {
    const Node& node = nodes_[index];
    const EymHeader& h = header();
    NodeGeometry geometry;
    geometry.positions =
        section<std::uint64_t>(h.positionsOffset, node.firstVertex, node.vertexCount);
    geometry.normals = section<std::uint32_t>(h.normalsOffset, node.firstVertex, node.vertexCount);
    if (hasColours())
        geometry.colours =
            section<std::uint32_t>(h.coloursOffset, node.firstVertex, node.vertexCount);
    geometry.indices = section<std::uint16_t>(h.indicesOffset, node.firstIndex, node.indexCount);
    if (verified_[index].load(std::memory_order_relaxed))
        return geometry;
    if (geometryChecksum(geometry) != node.checksum)
        return absl::DataLossError(fmt::format(
            "{}: node {}: the checksum of its vertices and indices does not match; import the mesh "
            "again",
            path_, index));
    const auto largest = std::max_element(geometry.indices.begin(), geometry.indices.end());
    if (largest != geometry.indices.end() && *largest >= node.vertexCount)
        return absl::DataLossError(
            fmt::format("{}: node {}: found index {}, expected less than its {} vertices; import "
                        "the mesh again",
                        path_, index, *largest, node.vertexCount));
    verified_[index].store(true, std::memory_order_relaxed);
    return geometry;
}

}  // namespace eyrie::mesh
