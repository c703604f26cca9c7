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
// file. 253 and 252 change a real file likewise, coded or not. Checksums of files are put right.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

#include "renderer/mesh/codec/exact_codec.h"
#include "renderer/mesh/codec/page_codec.h"
#include "renderer/mesh/eym_check.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/mesh/node_geometry.h"
#include "tests/renderer/mesh/sample_eym.h"
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

const std::string& real(bool isCoded) {
    static const std::string kCoded = test::sampleEym(true);
    static const std::string kRaw = test::sampleEym(false);
    return isCoded ? kCoded : kRaw;
}

std::string changedFile(const std::uint8_t* data, std::size_t size) {
    if (data[0] == 255)
        return {data + 1, data + size};
    std::string file = real(data[0] == 253);
    for (std::size_t k = 1; k + 4 <= size; k += 4) {
        const std::size_t offset =
            data[k] | std::size_t{data[k + 1]} << 8 | std::size_t{data[k + 2]} << 16;
        file[offset % file.size()] = static_cast<char>(data[k + 3]);
    }
    return file;
}

/// Of a part of a file; 0 where it leaves that.
std::uint64_t hashOf(const std::string& file, std::uint64_t offset, std::uint64_t bytes) {
    if (offset > file.size() || bytes > file.size() - offset)
        return 0;
    return mesh::contentHash(std::as_bytes(std::span(file).subspan(offset, bytes)));
}

/// Calls `seal` with each record of a table that lies in the file.
template <typename Record, typename Seal>
void sealEach(std::string& file, std::uint64_t offset, std::uint64_t count, const Seal& seal) {
    for (; count > 0 && offset <= file.size() && sizeof(Record) <= file.size() - offset;
         --count, offset += sizeof(Record)) {
        Record record;
        std::memcpy(static_cast<void*>(&record), file.data() + offset, sizeof record);
        seal(record);
        std::memcpy(file.data() + offset, &record, sizeof record);
    }
}

/// What must be right before anything else is looked at.
void putRight(std::string& file) {
    mesh::EymHeader header;
    std::memcpy(&header, file.data(), sizeof header);
    header.magic = mesh::kEymMagic;
    header.version = mesh::kEymVersion;
    header.headerBytes = sizeof header;
    header.fileBytes = file.size();
    sealEach<mesh::Node>(file, sizeof header, header.nodeCount, [&](mesh::Node& node) {
        node.pageChecksum = hashOf(file, node.pageOffset, node.pageBytes);
        node.exactChecksum = hashOf(file, node.exactOffset, node.exactBytes);
        if ((header.flags & mesh::kIsCoded) == 0)
            node.blockChecksum = node.pageChecksum;
    });
    const std::uint64_t lids = mesh::endOfNodes(header);
    const std::uint64_t materials = mesh::endOfLids(header);
    const std::uint64_t points = mesh::endOfMaterials(header);
    const std::uint64_t lights = mesh::endOfPointRanges(header);
    sealEach<mesh::ImageRecord>(file, materials + header.materialCount * sizeof(mesh::Material),
                                header.imageCount, [&](mesh::ImageRecord& image) {
                                    image.checksum = hashOf(file, image.offset, image.bytes);
                                });
    header.nodesChecksum = hashOf(file, sizeof header, lids - sizeof header);
    header.lidsChecksum = hashOf(file, lids, materials - lids);
    header.materialsChecksum = hashOf(file, materials, points - materials);
    header.pointRangesChecksum = hashOf(file, points, lights - points);
    header.lightsChecksum = hashOf(file, lights, mesh::endOfTables(header) - lights);
    header.checksum = mesh::headerChecksum(header);
    std::memcpy(file.data(), &header, sizeof header);
}

void expect(bool holds) {
    if (!holds)
        std::abort();
}

void expectRead(const absl::Status& status) { expect(status.ok() || absl::IsDataLoss(status)); }

void useNode(const mesh::EymFile& file, std::uint32_t index) {
    const mesh::Node& node = file.nodes()[index];
    const auto geometry = file.geometry(index);
    expectRead(geometry.status());
    if (geometry.ok())
        expect(std::ranges::all_of(geometry->indices,
                                   [&](auto i) { return i < geometry->positions.size(); }));
    if (file.hasExactPositions() && node.isLeaf())
        expectRead(file.exactPositions(index).status());
    for (const mesh::PointRange& range : file.pointRanges(index))
        expect(range.points <= node.vertexCount);
    for (const mesh::MaterialRange& range : file.ranges(index))
        expect(range.material < file.materials().size());
}

/// Uses what the tables promise, as a renderer would.
void use(const mesh::EymFile& file) {
    expect(file.levels() >= 1 && file.levels() <= mesh::kMaxTreeDepth);
    for (std::uint32_t node = 0; node < file.nodes().size(); ++node) useNode(file, node);
    for (std::uint32_t image = 0; image < file.images().size(); ++image)
        expectRead(file.imageBlocks(image).status());
    for (const fabric::Box& lid : file.lids()) expect(!lid.isEmpty());
    for (const auto& light : file.lights().points) {
        expect(light.reachMetres > 0);
        expect(!light.cone || light.cone->innerDegrees <= light.cone->outerDegrees);
    }
}

void openFile(const std::uint8_t* data, std::size_t size) {
    std::string bytes = changedFile(data, size);
    if (bytes.size() >= sizeof(mesh::EymHeader))
        putRight(bytes);
    const int fd = memfd_create("mesh", MFD_CLOEXEC);
    if (fd < 0 || write(fd, bytes.data(), bytes.size()) < 0)
        std::abort();
    const auto file = mesh::EymFile::open("/proc/self/fd/" + std::to_string(fd));
    if (file.ok())
        use(*file);
    else
        expect(absl::IsDataLoss(file.status()) || absl::IsInvalidArgument(file.status()));
    close(fd);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0)
        return 0;
    if (data[0] == 255 || data[0] == 253 || data[0] == 252)
        openFile(data, size);
    else if (data[0] == 254)
        decodeExact(data, size);
    else
        decodePage(data, size);
    return 0;
}
