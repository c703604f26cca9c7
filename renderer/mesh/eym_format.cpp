// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/eym_format.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <numeric>
#include <utility>

#include <absl/status/status.h>
#include <fmt/format.h>
#include <xxhash.h>

#include "fabric/status.h"
#include "renderer/mesh/codec/page_codec.h"
#include "renderer/mesh/eym_check.h"
#include "renderer/mesh/mapped_file.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

fabric::LightCone coneOf(const Cone& cone) {
    return {fabric::Vec3(cone.axis[0], cone.axis[1], cone.axis[2]), double{cone.innerDegrees},
            double{cone.outerDegrees}};
}

}  // namespace

std::uint64_t headerChecksum(const EymHeader& header) {
    EymHeader zeroed = header;
    zeroed.checksum = 0;
    return contentHash(std::as_bytes(std::span(&zeroed, 1)));
}

std::uint64_t contentHash(std::span<const std::byte> bytes) {
    return XXH64(bytes.data(), bytes.size(), 0);
}

absl::StatusOr<std::uint64_t> contentHash(const std::string& path) {
    constexpr std::size_t kAtOnce = std::size_t{16} << 20;
    ASSIGN_OR_RETURN(const MappedFile file, MappedFile::open(path));
    const std::span<const std::byte> bytes = file.bytes();
    const std::unique_ptr<XXH64_state_t, decltype(&XXH64_freeState)> state(XXH64_createState(),
                                                                           &XXH64_freeState);
    XXH64_reset(state.get(), 0);
    for (std::size_t at = 0; at < bytes.size(); at += kAtOnce) {
        const auto part = bytes.subspan(at, std::min(kAtOnce, bytes.size() - at));
        XXH64_update(state.get(), part.data(), part.size());
        file.forget(at + part.size());
    }
    return XXH64_digest(state.get());
}

absl::StatusOr<EymFile> EymFile::open(const std::string& path, const page::SourceOptions& options,
                                      std::uint64_t mostMemoryBytes) {
    ASSIGN_OR_RETURN(std::unique_ptr<page::PageSource> source,
                     page::PageSource::open(path, sizeof(EymHeader), options));
    EymFile file(std::move(source));
    try {
        RETURN_IF_ERROR(file.readTables(mostMemoryBytes));
    } catch (const std::bad_alloc&) {
        return absl::ResourceExhaustedError(
            fmt::format("{}: its tables take {} bytes of memory, which cannot be had", path,
                        file.tableMemoryBytes()));
    }
    return file;
}

std::uint64_t EymFile::tableMemoryBytes() const {
    const std::uint64_t firstRanges = header_.materialCount == 0 ? 0 : header_.nodeCount + 1ULL;
    return endOfTables(header_) - sizeof(EymHeader) + firstRanges * sizeof(std::uint32_t);
}

absl::Status EymFile::readTables(std::uint64_t mostMemoryBytes) {
    RETURN_IF_ERROR(
        fabric::withContext(checkHeader(source_->head(), source_->sizeBytes()), path()));
    std::memcpy(&header_, source_->head().data(), sizeof header_);
    lattice_ = {{header_.originMetres[0], header_.originMetres[1], header_.originMetres[2]},
                header_.stepMetres};
    if (tableMemoryBytes() > mostMemoryBytes)
        return absl::ResourceExhaustedError(
            fmt::format("{}: its tables take {} bytes of memory, {} are left", path(),
                        tableMemoryBytes(), mostMemoryBytes));
    nodes_.resize(header_.nodeCount);
    const auto bytes = std::as_writable_bytes(std::span(nodes_));
    RETURN_IF_ERROR(source_->read({sizeof(EymHeader), bytes.size(), header_.nodesChecksum}, bytes,
                                  "the node table"));
    const absl::StatusOr<int> levels = checkNodes(header_, nodes_);
    if (!levels.ok())
        return fabric::withContext(levels.status(), path());
    levels_ = *levels;
    if (header_.lidCount > 0)
        RETURN_IF_ERROR(readLids());
    if (header_.materialCount > 0)
        RETURN_IF_ERROR(readMaterials());
    RETURN_IF_ERROR(readPointRanges());
    return header_.lightCount > 0 ? readLights() : absl::OkStatus();
}

absl::Status EymFile::readLids() {
    lids_.resize(header_.lidCount);
    const auto bytes = std::as_writable_bytes(std::span(lids_));
    RETURN_IF_ERROR(source_->read({endOfNodes(header_), bytes.size(), header_.lidsChecksum}, bytes,
                                  "the lids"));
    return fabric::withContext(checkLids(lids_), path());
}

absl::Status EymFile::readMaterials() {
    std::vector<std::byte> bytes(materialTableBytes(header_));
    RETURN_IF_ERROR(source_->read({endOfLids(header_), bytes.size(), header_.materialsChecksum},
                                  bytes, "the tables of materials"));
    const std::byte* at = bytes.data();
    const auto take = [&at](auto& table, std::size_t count) {
        table.resize(count);
        const auto to = std::as_writable_bytes(std::span(table));
        std::copy_n(at, to.size(), to.begin());
        at += to.size();
    };
    take(materials_, header_.materialCount);
    take(images_, header_.imageCount);
    take(ranges_, header_.rangeCount);
    RETURN_IF_ERROR(fabric::withContext(
        checkMaterials(header_, nodes_, {materials_, images_, ranges_}), path()));
    firstRange_.resize(nodes_.size() + 1);
    for (const MaterialRange& range : ranges_) ++firstRange_[range.node + 1];
    std::partial_sum(firstRange_.begin(), firstRange_.end(), firstRange_.begin());
    return absl::OkStatus();
}

absl::Status EymFile::readPointRanges() {
    pointRanges_.resize(header_.pointRangeCount);
    const auto bytes = std::as_writable_bytes(std::span(pointRanges_));
    if (!bytes.empty())
        RETURN_IF_ERROR(
            source_->read({endOfMaterials(header_), bytes.size(), header_.pointRangesChecksum},
                          bytes, "the point ranges"));
    return fabric::withContext(checkPointRanges(nodes_, pointRanges_), path());
}

absl::Status EymFile::readLights() {
    std::vector<Light> lights(header_.lightCount);
    std::vector<Cone> cones(coneCount(header_));
    std::vector<std::byte> bytes(lights.size() * sizeof(Light) + cones.size() * sizeof(Cone));
    RETURN_IF_ERROR(source_->read({endOfPointRanges(header_), bytes.size(), header_.lightsChecksum},
                                  bytes, "the lights"));
    const auto first = std::as_writable_bytes(std::span(lights));
    std::ranges::copy(std::span(bytes).first(first.size()), first.begin());
    std::ranges::copy(std::span(bytes).subspan(first.size()),
                      std::as_writable_bytes(std::span(cones)).begin());
    RETURN_IF_ERROR(fabric::withContext(checkLights(lights), path()));
    RETURN_IF_ERROR(fabric::withContext(checkCones(lights, cones), path()));
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Light& light = lights[i];
        const fabric::Vec3 place(light.place[0], light.place[1], light.place[2]);
        const fabric::Vec3 colour(light.colour[0], light.colour[1], light.colour[2]);
        if (light.isDistant())
            lights_.distant.push_back({place, colour});
        else
            lights_.points.push_back({place, colour, light.reachMetres});
        if (!cones.empty() && cones[i].isSpot())
            lights_.points.back().cone = coneOf(cones[i]);
    }
    return absl::OkStatus();
}

std::span<const PointRange> EymFile::pointRanges(std::uint32_t node) const {
    return {std::ranges::lower_bound(pointRanges_, node, {}, &PointRange::node),
            std::ranges::upper_bound(pointRanges_, node, {}, &PointRange::node)};
}

std::vector<fabric::Box> EymFile::lids() const {
    std::vector<fabric::Box> boxes;
    for (const Lid& lid : lids_)
        boxes.push_back({lattice_.metres(lid.boxMin), lattice_.metres(lid.boxMax)});
    return boxes;
}

absl::StatusOr<std::vector<std::byte>> EymFile::imageBlocks(std::uint32_t image) const {
    const ImageRecord& record = images_[image];
    std::vector<std::byte> blocks(record.bytes);
    RETURN_IF_ERROR(source_->read({record.offset, record.bytes, record.checksum}, blocks,
                                  fmt::format("image {}", image)));
    return blocks;
}

fabric::Box EymFile::bounds(std::uint32_t node) const {
    return {lattice_.metres(nodes_[node].boxMin), lattice_.metres(nodes_[node].boxMax)};
}

absl::Status EymFile::inNode(std::uint32_t node, const absl::Status& status) const {
    return fabric::withContext(status, fmt::format("{}: node {}", path(), node));
}

/// The block of a node, decoded but not looked into.
absl::StatusOr<NodeGeometry> EymFile::readBlock(std::uint32_t index) const {
    const Node& node = nodes_[index];
    const NodeShape shape = this->shape(index);
    if (!node.hasGeometry())
        return NodeGeometry{};
    auto block = std::make_shared<std::vector<std::uint64_t>>(blockBytes(shape) / 8);
    const auto blockSpan = std::as_writable_bytes(std::span(*block));
    const page::Block page{node.pageOffset, node.pageBytes, node.pageChecksum};
    const std::string what = fmt::format("node {}", index);
    if (isCoded()) {
        std::vector<std::byte> bytes(node.pageBytes);
        RETURN_IF_ERROR(source_->read(page, bytes, what));
        RETURN_IF_ERROR(inNode(index, decodePage(bytes, NodeArrays(shape, *block))));
    } else {
        RETURN_IF_ERROR(source_->read(page, blockSpan, what));
    }
    return geometryIn(blockSpan, shape, block);
}

absl::StatusOr<NodeGeometry> EymFile::geometry(std::uint32_t index) const {
    ASSIGN_OR_RETURN(NodeGeometry geometry, readBlock(index));
    const Node& node = nodes_[index];
    if (node.hasGeometry() && contentHash(geometry.block) != node.blockChecksum)
        return inNode(index, absl::DataLossError("the checksum of its vertices and indices does "
                                                 "not match; import the mesh again"));
    const auto largest = std::max_element(geometry.indices.begin(), geometry.indices.end());
    if (largest != geometry.indices.end() && *largest >= node.vertexCount)
        return inNode(index, absl::DataLossError(fmt::format(
                                 "found index {}, expected less than its {} vertices; import the "
                                 "mesh again",
                                 *largest, node.vertexCount)));
    return geometry;
}

absl::StatusOr<std::vector<fabric::Vec3>> EymFile::exactPositions(std::uint32_t index) const {
    const Node& node = nodes_[index];
    ASSIGN_OR_RETURN(const NodeGeometry geometry, this->geometry(index));
    std::vector<std::byte> bytes(node.exactBytes);
    RETURN_IF_ERROR(source_->read({node.exactOffset, node.exactBytes, node.exactChecksum}, bytes,
                                  fmt::format("source positions of node {}", index)));
    auto exact = decodeExact(
        bytes, geometry.positions, lattice_,
        (header_.flags & kExactIsFloat64) != 0 ? ExactForm::Float64 : ExactForm::Float32);
    if (!exact.ok())
        return inNode(index, exact.status());
    return exact;
}

}  // namespace eyrie::mesh
