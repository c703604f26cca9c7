// SPDX-License-Identifier: Apache-2.0
// Whatever happens to the bytes of an .eym file, a reader ends in a status or in spans that may be
// read. Run under the address sanitizer this also shows that nothing is read outside.
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "renderer/mesh/eym_format.h"
#include "tests/renderer/mesh/sample_eym.h"
#include "tests/renderer/mesh/temporary_folder.h"
#include "tests/support/memory_limit.h"

namespace eyrie::mesh {
namespace {

const std::string& smallFile(bool isCoded = true) {
    static const std::string coded = test::sampleEym(true);
    static const std::string raw = test::sampleEym(false);
    return isCoded ? coded : raw;
}

/// The first error of opening the file and taking all its geometry, as drawing would.
absl::Status readAll(const std::string& path) {
    const auto file = EymFile::open(path);
    if (!file.ok())
        return file.status();
    for (std::uint32_t node = 0; node < file->nodes().size(); ++node) {
        const auto geometry = file->geometry(node);
        if (!geometry.ok())
            return geometry.status();
        std::uint64_t sum = 0;
        for (const std::uint16_t index : geometry->indices)
            sum += geometry->positions[index] + geometry->normals[index] +
                   geometry->colours[index] +
                   static_cast<std::uint32_t>(geometry->textureCoordinates[index].x);
        for (const PointRange& range : file->pointRanges(node))
            sum += geometry->colours[range.points - 1] + geometry->positions[range.points - 1];
        for (const MaterialRange& range : file->ranges(node))
            sum += file->materials()[range.material].flags + range.indexCount;
        EXPECT_NE(sum, std::numeric_limits<std::uint64_t>::max());  // keeps the reads
        if (!file->nodes()[node].isLeaf())
            continue;
        if (const auto exact = file->exactPositions(node); !exact.ok())
            return exact.status();
    }
    for (std::uint32_t image = 0; image < file->images().size(); ++image)
        if (const auto blocks = file->imageBlocks(image); !blocks.ok())
            return blocks.status();
    return absl::OkStatus();
}

/// The second range of a node.
template <typename Ranges>
auto& laterRange(Ranges& ranges) {
    const auto at = std::ranges::adjacent_find(
        ranges, [](const PointRange& a, const PointRange& b) { return a.node == b.node; });
    EXPECT_NE(at, ranges.end());
    return *std::next(at);
}

/// A file's header and tables, to be changed and sealed with the checksum that then is right.
struct Tables {
    explicit Tables(const std::string& bytes) {
        std::memcpy(&header, bytes.data(), sizeof header);
        nodes.resize(header.nodeCount);
        lids.resize(header.lidCount);
        materials.resize(header.materialCount);
        images.resize(header.imageCount);
        ranges.resize(header.rangeCount);
        pointRanges.resize(header.pointRangeCount);
        lights.resize(header.lightCount);
        cones.resize(coneCount(header));
        const char* at = bytes.data() + sizeof header;
        forAll([&at](auto table) {
            std::memcpy(table.data(), at, table.size());
            at += table.size();
        });
    }
    std::string sealedInto(std::string bytes) {
        header.nodesChecksum = contentHash(std::as_bytes(std::span(nodes)));
        char* at = bytes.data() + sizeof header;
        header.lidsChecksum = contentHash(std::as_bytes(std::span(lids)));
        const char* const materialsAt =
            at + nodes.size() * sizeof(Node) + lids.size() * sizeof(Lid);
        forAll([&at](auto table) {
            std::memcpy(at, table.data(), table.size());
            at += table.size();
        });
        header.pointRangesChecksum = contentHash(std::as_bytes(std::span(pointRanges)));
        const std::size_t lightBytes =
            std::as_bytes(std::span(lights)).size() + std::as_bytes(std::span(cones)).size();
        header.lightsChecksum = contentHash(std::as_bytes(std::span(at - lightBytes, lightBytes)));
        const auto materialBytes = static_cast<std::size_t>(at - materialsAt) -
                                   std::as_bytes(std::span(pointRanges)).size() - lightBytes;
        header.materialsChecksum =
            contentHash(std::as_bytes(std::span(materialsAt, materialBytes)));
        header.checksum = headerChecksum(header);
        std::memcpy(bytes.data(), &header, sizeof header);
        return bytes;
    }
    template <typename Visit>
    void forAll(const Visit& visit) {
        visit(std::as_writable_bytes(std::span(nodes)));
        visit(std::as_writable_bytes(std::span(lids)));
        visit(std::as_writable_bytes(std::span(materials)));
        visit(std::as_writable_bytes(std::span(images)));
        visit(std::as_writable_bytes(std::span(ranges)));
        visit(std::as_writable_bytes(std::span(pointRanges)));
        visit(std::as_writable_bytes(std::span(lights)));
        visit(std::as_writable_bytes(std::span(cones)));
    }
    std::size_t endOfTables() const {
        return endOfPointRanges(header) + lights.size() * sizeof(Light) +
               cones.size() * sizeof(Cone);
    }

    EymHeader header;
    std::vector<Node> nodes;
    std::vector<Lid> lids;
    std::vector<Material> materials;
    std::vector<ImageRecord> images;
    std::vector<MaterialRange> ranges;
    std::vector<PointRange> pointRanges;
    std::vector<Light> lights;
    std::vector<Cone> cones;  ///< of each light
};

TEST(EymDamage, OfTheLengthIsAlwaysNoticed) {
    const test::TemporaryFolder folder;
    const std::string& bytes = smallFile();
    for (std::size_t length = 0; length < bytes.size(); length += 64) {
        test::writeFile(folder.file("m.eym"), bytes.substr(0, length));
        EXPECT_FALSE(readAll(folder.file("m.eym")).ok()) << length;
    }
    test::writeFile(folder.file("m.eym"), bytes + std::string(8, '\0'));
    EXPECT_FALSE(readAll(folder.file("m.eym")).ok());
}

class EymDamageByForm : public testing::TestWithParam<bool> {};

TEST_P(EymDamageByForm, OfAnyBitThatMattersIsNoticed) {
    const test::TemporaryFolder folder;
    const std::string& bytes = smallFile(GetParam());
    const Tables tables(bytes);
    std::size_t unnoticed = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        std::string flipped = bytes;
        flipped[i] = static_cast<char>(flipped[i] ^ 1 << i % 8);
        test::writeFile(folder.file("m.eym"), flipped);
        unnoticed += readAll(folder.file("m.eym")).ok() ? 1 : 0;
    }
    // Only padding between pages carries nothing.
    std::uint64_t carried = tables.endOfTables();
    for (const Node& node : tables.nodes) carried += node.pageBytes + node.exactBytes;
    for (const ImageRecord& image : tables.images) carried += image.bytes;
    EXPECT_EQ(unnoticed, bytes.size() - carried);
}

INSTANTIATE_TEST_SUITE_P(CodedAndRaw, EymDamageByForm, testing::Bool());

TEST(EymDamage, WithARightChecksumIsStillRefused) {
    struct Case {
        const char* name;
        std::function<void(Tables&)> damage;
    };
    const std::uint64_t huge = std::numeric_limits<std::uint64_t>::max();
    const std::vector<Case> cases = {
        {"child is itself", [](Tables& t) { t.nodes[0].left = 0; }},
        {"child before its parent", [](Tables& t) { t.nodes[1].right = 0; }},
        {"child beyond the table", [](Tables& t) { t.nodes[0].right = 1 << 30; }},
        {"negative child", [](Tables& t) { t.nodes[0].right = -5; }},
        {"right child is the left", [](Tables& t) { t.nodes[0].right = t.nodes[0].left; }},
        {"page beyond the file", [](Tables& t) { t.nodes.back().pageOffset += 1 << 20; }},
        {"page far away", [huge](Tables& t) { t.nodes.back().pageOffset = huge - 7; }},
        {"page in the tables", [](Tables& t) { t.nodes.back().pageOffset = 256; }},
        {"page too long", [](Tables& t) { t.nodes.back().pageBytes = 1U << 31; }},
        {"source positions beyond the file",
         [](Tables& t) { t.nodes.back().exactBytes += 1U << 20; }},
        {"vertices that none uses",
         [](Tables& t) {
             t.nodes.back().vertexCount = static_cast<std::uint16_t>(t.nodes.back().indexCount + 1);
         }},
        {"a leaf of points", [](Tables& t) { t.nodes.back().indexCount = 0; }},
        {"points without ranges", [](Tables& t) { t.pointRanges[0].node = 1U << 20; }},
        {"ranges of a node without points", [](Tables& t) { t.pointRanges.back().node += 1; }},
        {"more points than there are", [](Tables& t) { t.pointRanges[0].points = 1000; }},
        {"no points", [](Tables& t) { t.pointRanges[0].points = 0; }},
        {"as many points again", [](Tables& t) { laterRange(t.pointRanges).points = 1; }},
        {"ranges of too few points", [](Tables& t) { ++t.nodes[0].vertexCount; }},
        {"an error of more points that is greater",
         [](Tables& t) { laterRange(t.pointRanges).errorMetres *= 100; }},
        {"an error of points that is not finite",
         [](Tables& t) { t.pointRanges[0].errorMetres = std::numeric_limits<float>::quiet_NaN(); }},
        {"an error of all points that is not the node's",
         [](Tables& t) { t.nodes[0].errorMetres *= 2; }},
        {"more triangles than a node stands for",
         [](Tables& t) {
             t.nodes[0].indexCount = 3 * (kMaxNodeTriangles + 1);
             t.nodes[0].vertexCount = 3;
         }},
        {"fewer indices than triangles", [](Tables& t) { t.nodes.back().indexCount -= 3; }},
        {"box upside down", [](Tables& t) { t.nodes[0].boxMin.x = t.nodes[0].boxMax.x + 1; }},
        {"box off the lattice", [](Tables& t) { t.nodes[0].boxMax.y = 1U << 21; }},
        {"box leaves the parent's", [](Tables& t) { t.nodes[1].boxMax.z = 2000; }},
        {"fronts past the indices",
         [](Tables& t) { t.nodes.back().frontIndexCount = t.nodes.back().indexCount + 3; }},
        {"part of a triangle's front", [](Tables& t) { t.nodes.back().frontIndexCount = 1; }},
        {"fronts beside those of ranges", [](Tables& t) { t.nodes.back().frontIndexCount = 3; }},
        {"an image that is not there", [](Tables& t) { t.materials[0].image = 2; }},
        {"no image at all", [](Tables& t) { t.materials[0].image = -2; }},
        {"unknown property of a material", [](Tables& t) { t.materials[1].flags = 8; }},
        {"one side and two", [](Tables& t) { t.materials[1].flags = 6; }},
        {"cutoff of a material", [](Tables& t) { t.materials[1].alphaCutoff = 2; }},
        {"image of no size", [](Tables& t) { t.images[0].shape.width = 0; }},
        {"image of another size", [](Tables& t) { t.images[0].shape.width = 9; }},
        {"absurd image", [](Tables& t) { t.images[0].shape.height = 1U << 31; }},
        {"unknown kind of image", [](Tables& t) { t.images[1].shape.flags = 64; }},
        {"image beyond the file", [](Tables& t) { t.images[1].offset += 8; }},
        {"image in the tables", [](Tables& t) { t.images[1].offset = 0; }},
        {"material that is not there", [](Tables& t) { t.ranges[0].material = 3; }},
        {"range of nothing", [](Tables& t) { t.ranges[0].indexCount = 0; }},
        {"range of another node", [](Tables& t) { t.ranges.back().node = 1U << 30; }},
        {"ranges of too few indices", [](Tables& t) { t.ranges[0].indexCount -= 3; }},
        {"more fronts than indices", [](Tables& t) { t.ranges[0].frontIndexCount = 3000; }},
        {"images without materials", [](Tables& t) { t.header.materialCount = 0; }},
        {"texture coordinates that are not there",
         [](Tables& t) { t.header.flags &= ~kHasTextures; }},
        {"error below the child's", [](Tables& t) { t.nodes[0].errorMetres = 0; }},
        {"error not finite",
         [](Tables& t) { t.nodes[1].errorMetres = std::numeric_limits<float>::quiet_NaN(); }},
        {"colours from less far than the child's",
         [](Tables& t) { t.nodes[1].colourReach = 0x5000; }},
        {"colours from no number of metres", [](Tables& t) { t.nodes[0].colourReach = 0x7FC0; }},
        {"colours from less than no distance", [](Tables& t) { t.nodes[0].colourReach = 0xBF80; }},
        {"a reach of colours that are not there",
         [](Tables& t) {
             t.header.flags &= ~kHasColours;
             t.nodes[0].colourReach = 0x3F80;
         }},
        {"normals less off than not at all",
         [](Tables& t) { t.nodes[0].normalErrorDegrees = t.nodes[0].normalErrorMeanDegrees = -1; }},
        {"normals off by no angle",
         [](Tables& t) {
             t.nodes[0].normalErrorDegrees = std::numeric_limits<float>::quiet_NaN();
         }},
        {"normals off by more than half a turn",
         [](Tables& t) { t.nodes[0].normalErrorDegrees = 181; }},
        {"normals more off on average than at most",
         [](Tables& t) {
             t.nodes[0].normalErrorDegrees = 20;
             t.nodes[0].normalErrorMeanDegrees = 21;
         }},
        {"a leaf's normals off", [](Tables& t) { t.nodes.back().normalErrorDegrees = 1; }},
        {"range with a gap", [](Tables& t) { t.nodes[1].triangleEnd -= 1; }},
        {"empty range", [](Tables& t) { t.nodes[0].triangleEnd = 0; }},
        {"other triangle count", [](Tables& t) { t.header.triangleCount += 1; }},
        {"no nodes", [](Tables& t) { t.header.nodeCount = 0; }},
        {"many nodes", [](Tables& t) { t.header.nodeCount = 0xFFFFFFFF; }},
        {"many lids", [huge](Tables& t) { t.header.lidCount = huge; }},
        {"lid upside down", [](Tables& t) { t.lids[0].boxMin.x = t.lids[0].boxMax.x + 1; }},
        {"lid off the lattice", [](Tables& t) { t.lids[0].boxMax.y = 1U << 21; }},
        {"many lights", [huge](Tables& t) { t.header.lightCount = huge; }},
        {"a distant light from nowhere", [](Tables& t) { t.lights[0].place = {}; }},
        {"a light that is nowhere",
         [](Tables& t) { t.lights[1].place[2] = std::numeric_limits<double>::infinity(); }},
        {"a light that takes light", [](Tables& t) { t.lights[1].colour[0] = -1; }},
        {"a spot at no place",
         [](Tables& t) {
             t.cones[0] = {.axis = {0, 0, 1}, .innerDegrees = 1, .outerDegrees = 2};
         }},
        {"a spot that shines nowhere", [](Tables& t) { t.cones[1].axis = {}; }},
        {"a spot of more than half of the space", [](Tables& t) { t.cones[1].outerDegrees = 91; }},
        {"a cone inside out", [](Tables& t) { t.cones[1].innerDegrees = 21; }},
        {"a cone of no angle",
         [](Tables& t) { t.cones[1].outerDegrees = std::numeric_limits<float>::quiet_NaN(); }},
        {"a light of no reach", [](Tables& t) { t.lights[1].reachMetres = -1; }},
        {"unknown flag", [](Tables& t) { t.header.flags |= 1U << 7; }},
        {"step no power of two", [](Tables& t) { t.header.stepMetres = 0.3; }},
        {"error of the file", [](Tables& t) { t.header.coarsestErrorMetres = -1; }},
    };
    const test::TemporaryFolder folder;
    const std::string& bytes = smallFile();
    for (const Case& c : cases) {
        Tables tables(bytes);
        c.damage(tables);
        test::writeFile(folder.file("m.eym"), tables.sealedInto(bytes));
        const absl::Status status = readAll(folder.file("m.eym"));
        EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss) << c.name;
        EXPECT_NE(status.message().find("found"), std::string::npos) << c.name << ": " << status;
    }
}

/// A few blocks on disk may claim a file of gigabytes.
TEST(EymDamage, APageLargerThanItsNodeCanHaveIsRefusedBeforeItIsRead) {
    const test::TemporaryFolder folder;
    const std::string& bytes = smallFile();
    constexpr std::uint64_t kLong = 1U << 30;
    for (const auto& damage : {+[](Node& node) { node.pageBytes = kLong; },
                               +[](Node& node) { node.exactBytes = kLong; }}) {
        Tables tables(bytes);
        tables.header.fileBytes += kLong;
        damage(tables.nodes.back());
        test::writeFile(folder.file("m.eym"), tables.sealedInto(bytes));
        std::filesystem::resize_file(folder.file("m.eym"), tables.header.fileBytes);
        const absl::Status refused = EymFile::open(folder.file("m.eym")).status();
        EXPECT_EQ(refused.code(), absl::StatusCode::kDataLoss);
        EXPECT_NE(refused.message().find("found 1073741824 bytes"), std::string::npos) << refused;
    }
}

TEST(EymDamage, TablesLargerThanTheMemoryForThemAreNotReadFirst) {
    const test::TemporaryFolder folder;
    const std::string& bytes = smallFile();
    Tables tables(bytes);
    test::writeFile(folder.file("m.eym"), bytes);
    const std::uint64_t needed = EymFile::open(folder.file("m.eym"))->tableMemoryBytes();
    EXPECT_GE(needed, tables.endOfTables() - sizeof(EymHeader));
    EXPECT_TRUE(EymFile::open(folder.file("m.eym"), {}, needed).ok());
    tables.header.nodeCount = 1U << 31;
    tables.header.fileBytes = std::uint64_t{300} << 30;
    test::writeFile(folder.file("m.eym"), tables.sealedInto(bytes));
    std::filesystem::resize_file(folder.file("m.eym"), tables.header.fileBytes);
    const absl::Status refused =
        EymFile::open(folder.file("m.eym"), {}, std::uint64_t{1} << 30).status();
    EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted) << refused;
    EXPECT_NE(refused.message().find("its tables take"), std::string::npos) << refused;
    if (!test::MemoryLimit::kIsPossible)
        return;
    const test::MemoryLimit limit(std::uint64_t{1} << 30);
    const absl::Status tooMuch = EymFile::open(folder.file("m.eym")).status();
    EXPECT_EQ(tooMuch.code(), absl::StatusCode::kResourceExhausted) << tooMuch;
    EXPECT_NE(tooMuch.message().find("its tables take"), std::string::npos) << tooMuch;
}

TEST(EymDamage, AnEarlierVersionIsRefusedForItsBounds) {
    const test::TemporaryFolder folder;
    const std::string& bytes = smallFile();
    Tables tables(bytes);
    EXPECT_EQ(tables.header.version, kEymVersion);
    --tables.header.version;
    test::writeFile(folder.file("m.eym"), tables.sealedInto(bytes));
    const absl::Status status = readAll(folder.file("m.eym"));
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_NE(status.message().find("import the mesh again"), std::string::npos) << status;
}

TEST(EymDamage, OfAnUncodedPageIsRefusedByItsShape) {
    const test::TemporaryFolder folder;
    const std::string& bytes = smallFile(false);
    for (const auto& damage :
         {+[](Node& node) { node.pageBytes += 8; }, +[](Node& node) { node.pageOffset -= 4; }}) {
        Tables tables(bytes);
        damage(tables.nodes.back());
        test::writeFile(folder.file("m.eym"), tables.sealedInto(bytes));
        EXPECT_EQ(readAll(folder.file("m.eym")).code(), absl::StatusCode::kDataLoss);
    }
}

TEST(EymDamage, AnIndexBeyondItsVerticesIsRefusedWithARightChecksum) {
    const test::TemporaryFolder folder;
    std::string bytes = smallFile(false);
    Tables tables(bytes);
    Node& leaf = tables.nodes.back();
    std::memcpy(bytes.data() + leaf.pageOffset + leaf.vertexCount * 24, &leaf.vertexCount, 2);
    leaf.blockChecksum =
        contentHash(std::as_bytes(std::span(bytes).subspan(leaf.pageOffset, leaf.pageBytes)));
    leaf.pageChecksum = leaf.blockChecksum;
    test::writeFile(folder.file("m.eym"), tables.sealedInto(bytes));
    const absl::Status status = readAll(folder.file("m.eym"));
    EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss);
    EXPECT_NE(status.message().find("found index"), std::string::npos) << status;
}

/// What was read stays as it was, and what is read then is refused.
TEST(EymDamage, OfAnOpenFileThatIsCutShortOrWrittenOverIsNoticed) {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("m.eym");
    for (const bool isCoded : {false, true}) {
        const std::string& whole = smallFile(isCoded);
        for (const std::string& now : {std::string(), std::string(whole.size(), '\xff')}) {
            test::writeFile(path, whole);
            const auto file = EymFile::open(path);
            ASSERT_TRUE(file.ok()) << file.status();
            const auto last = static_cast<std::uint32_t>(file->nodes().size() - 1);
            const auto geometry = file->geometry(last);
            ASSERT_TRUE(geometry.ok()) << geometry.status();
            std::ofstream(path, std::ios::binary) << now;  // in place
            EXPECT_EQ(file->geometry(last).status().code(), absl::StatusCode::kDataLoss);
            EXPECT_EQ(contentHash(geometry->block), file->nodes()[last].blockChecksum);
        }
    }
}

/// What a page decodes to is held against what was encoded, whatever the page's own checksum says.
TEST(EymDamage, OfACodedPageIsNoticedWithARightChecksum) {
    const test::TemporaryFolder folder;
    const std::string& whole = smallFile();
    const Tables tables(whole);
    const Node& node = tables.nodes.back();
    int unheeded = 0;
    for (std::uint32_t at = 0; at < node.pageBytes; ++at) {
        std::string bytes = whole;
        bytes[node.pageOffset + at] = static_cast<char>(bytes[node.pageOffset + at] ^ 1 << at % 8);
        Tables damaged(bytes);
        damaged.nodes.back().pageChecksum =
            contentHash(std::as_bytes(std::span(bytes).subspan(node.pageOffset, node.pageBytes)));
        test::writeFile(folder.file("m.eym"), damaged.sealedInto(bytes));
        const absl::Status status = readAll(folder.file("m.eym"));
        // A padding bit behind the last one of the bits is no one's.
        EXPECT_TRUE(status.ok() || absl::IsDataLoss(status)) << at << ": " << status;
        if (status.ok()) {
            EXPECT_LE(++unheeded, 2) << at;
        }
    }
}

RC_GTEST_PROP(EymDamage, OfTheTablesWithARightChecksumNeverLeavesTheFile, ()) {
    const test::TemporaryFolder folder;
    const std::string& bytes = smallFile();
    std::string damaged = bytes;
    const std::size_t tableBytes = Tables(bytes).endOfTables();
    for (int i = *rc::gen::inRange(1, 4); i > 0; --i)
        damaged[*rc::gen::inRange<std::size_t>(16, tableBytes)] = *rc::gen::arbitrary<char>();
    Tables tables(bytes);  // with the count that the bytes have room for
    std::memcpy(&tables.header, damaged.data(), sizeof tables.header);
    const char* at = damaged.data() + sizeof tables.header;
    tables.forAll([&at](auto table) {
        std::memcpy(table.data(), at, table.size());
        at += table.size();
    });
    test::writeFile(folder.file("m.eym"), tables.sealedInto(damaged));
    const absl::Status status = readAll(folder.file("m.eym"));
    RC_CLASSIFY(status.ok());
    RC_ASSERT(status.ok() || !status.message().empty());
}

}  // namespace
}  // namespace eyrie::mesh
