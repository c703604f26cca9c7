// SPDX-License-Identifier: Apache-2.0
// libFuzzer target of .eym files, whose pages and tables are untrusted once their checksums are
// right:
//
//   cmake --preset fuzz && cmake --build --preset fuzz --target eym_fuzzer
//   build/fuzz/fuzz/eym_fuzzer -max_len=4096 -max_total_time=600
//
// An input's first byte picks a real page of a node, and each four bytes after it put the fourth at
// the offset that the first three name: so inputs reach the decoder past its checks of lengths and
// of symbol shares. 254 takes the rest of the input for a page of source positions, and 255 for a
// file's header and nodes, with the checksum that then is right.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "renderer/mesh/codec/exact_codec.h"
#include "renderer/mesh/codec/page_codec.h"
#include "renderer/mesh/eym_check.h"
#include "renderer/mesh/node_geometry.h"
#include "tests/renderer/mesh/sample_meshes.h"

namespace {

using namespace eyrie;

struct Sample {
    mesh::NodeShape shape;
    std::vector<std::byte> page;
};

Sample sampleOf(const mesh::PackedMesh& soup, bool isOfPoints = false) {
    const std::array<std::span<const mesh::Triangle>, 1> whole{soup.triangles};
    mesh::PackedNode node = mesh::gatherNode(soup, whole);
    if (isOfPoints)
        node.indices.clear();
    return {{static_cast<std::uint32_t>(node.positions.size()),
             static_cast<std::uint32_t>(node.indices.size()), !node.colours.empty(),
             !node.textureCoordinates.empty()},
            mesh::encodePage({node.positions,
                              node.normals,
                              node.colours,
                              node.textureCoordinates,
                              node.indices,
                              {},
                              nullptr})};
}

std::vector<Sample> realPages() {
    std::vector<Sample> samples;
    for (const bool hasColours : {false, true})
        for (const std::uint32_t extent : {2U, 3000U, 1U << mesh::kLatticeBits}) {
            const mesh::PackedMesh soup = test::randomSoup(120, 70, extent, extent, hasColours);
            samples.push_back(sampleOf(soup));
        }
    samples.push_back(sampleOf(test::texturedSoup(120, 1)));
    samples.push_back(sampleOf(test::randomSoup(120, 70, 3000, 1, true), true));
    return samples;
}

void decodePage(const std::uint8_t* data, std::size_t size) {
    static const std::vector<Sample> kSamples = realPages();
    Sample sample = kSamples[data[0] % kSamples.size()];
    for (std::size_t k = 1; k + 4 <= size; k += 4) {
        const std::size_t offset =
            data[k] | std::size_t{data[k + 1]} << 8 | std::size_t{data[k + 2]} << 16;
        sample.page[offset % sample.page.size()] = std::byte{data[k + 3]};
    }
    std::vector<std::uint64_t> block(mesh::blockBytes(sample.shape) / 8);
    const mesh::NodeArrays arrays(sample.shape, block);
    const absl::Status status = mesh::decodePage(sample.page, arrays);
    const bool isWithin = std::all_of(arrays.indices.begin(), arrays.indices.end(),
                                      [&](auto i) { return i < sample.shape.vertexCount; });
    if (status.ok() ? !isWithin : status.code() != absl::StatusCode::kDataLoss)
        std::abort();
}

void decodeExact(const std::uint8_t* data, std::size_t size) {
    const std::vector<std::uint64_t> onLattice(40, 12345);
    const auto form = size % 2 == 0 ? mesh::ExactForm::Float32 : mesh::ExactForm::Float64;
    const auto exact = mesh::decodeExact(std::as_bytes(std::span(data + 1, size - 1)), onLattice,
                                         {{-2, 0, 16}, 0.125}, form);
    if (!exact.ok() && exact.status().code() != absl::StatusCode::kDataLoss)
        std::abort();
}

void checkTables(const std::uint8_t* data, std::size_t size) {
    std::vector<std::byte> file(size - 1);
    std::memcpy(file.data(), data + 1, file.size());
    mesh::EymHeader header;
    if (file.size() < sizeof header)
        return;
    std::memcpy(&header, file.data(), sizeof header);
    header.magic = mesh::kEymMagic;
    header.version = mesh::kEymVersion;
    header.headerBytes = sizeof header;
    header.fileBytes = file.size();
    header.checksum = mesh::headerChecksum(header);
    std::memcpy(file.data(), &header, sizeof header);
    if (!mesh::checkHeader(file, file.size()).ok())
        return;
    std::vector<mesh::Node> nodes(header.nodeCount);
    std::memcpy(nodes.data(), file.data() + sizeof header, nodes.size() * sizeof(mesh::Node));
    const auto levels = mesh::checkNodes(header, nodes);
    if (levels.ok() && (*levels < 1 || *levels > mesh::kMaxTreeDepth))
        std::abort();
    const std::byte* at = file.data() + sizeof header + nodes.size() * sizeof(mesh::Node);
    const auto tableOf = [&at]<typename Record>(std::vector<Record> table) {
        std::memcpy(table.data(), at, table.size() * sizeof(Record));
        at += table.size() * sizeof(Record);
        return table;
    };
    const auto materials = tableOf(std::vector<mesh::Material>(header.materialCount));
    const auto images = tableOf(std::vector<mesh::ImageRecord>(header.imageCount));
    const auto ranges = tableOf(std::vector<mesh::MaterialRange>(header.rangeCount));
    if (levels.ok() && mesh::checkMaterials(header, nodes, {materials, images, ranges}).ok())
        for (const mesh::ImageRecord& image : images)
            if (image.offset + image.bytes > file.size())
                std::abort();
    const auto points = tableOf(std::vector<mesh::PointRange>(header.pointRangeCount));
    if (levels.ok() && mesh::checkPointRanges(nodes, points).ok())
        for (const mesh::PointRange& range : points)
            if (range.points > nodes[range.node].vertexCount)
                std::abort();
    const auto lights = tableOf(std::vector<mesh::Light>(header.lightCount));
    if (mesh::checkLights(lights).ok())
        for (const mesh::Light& light : lights)
            if (!(light.reachMetres >= 0))
                std::abort();
    const auto cones = tableOf(std::vector<mesh::Cone>(mesh::coneCount(header)));
    if (mesh::checkCones(lights, cones).ok())
        for (const mesh::Cone& cone : cones)
            if (cone.isSpot() && !(cone.innerDegrees <= cone.outerDegrees))
                std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0)
        return 0;
    if (data[0] == 255)
        checkTables(data, size);
    else if (data[0] == 254)
        decodeExact(data, size);
    else
        decodePage(data, size);
    return 0;
}
