// SPDX-License-Identifier: Apache-2.0
// Whatever happens to the bytes of an .eym file, a reader ends in a status or in spans that lie
// inside the file. Run under the address sanitizer this also shows that nothing is read outside.
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "renderer/mesh/eym_format.h"
#include "renderer/mesh/eym_writer.h"
#include "renderer/mesh/kd_tree.h"
#include "tests/renderer/mesh/sample_meshes.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::mesh {
namespace {

std::string makeSmallFile() {
    const test::TemporaryFolder folder;
    const PackedMesh mesh = test::randomSoup(60, 40, 1000, 1, true);
    auto tree = buildKdTree(mesh.positions, mesh.triangles, {10});
    auto out = OutputFile::create(folder.file("m.eym"));
    EXPECT_TRUE(tree.ok() && out.ok());
    auto lod = buildLodTree(mesh, *tree);
    EXPECT_TRUE(lod.ok());
    EXPECT_TRUE(writeEym(mesh, *tree, *lod, 0, *out).ok());
    EXPECT_TRUE(out->commit().ok());
    return test::readFile(folder.file("m.eym"));
}

const std::string& smallFile() {
    static const std::string bytes = makeSmallFile();
    return bytes;
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
            sum += geometry->positions[index] + geometry->normals[index] + geometry->colours[index];
        EXPECT_NE(sum, std::numeric_limits<std::uint64_t>::max());  // keeps the reads
    }
    return absl::OkStatus();
}

/// A file's header and nodes, to be changed and sealed with the checksum that then is right.
struct Tables {
    explicit Tables(const std::string& bytes) {
        std::memcpy(&header, bytes.data(), sizeof header);
        nodes.resize(header.nodeCount);
        std::memcpy(nodes.data(), bytes.data() + sizeof header, nodes.size() * sizeof(Node));
    }
    std::string sealedInto(std::string bytes) {
        header.checksum = tableChecksum(header, nodes);
        std::memcpy(bytes.data(), &header, sizeof header);
        std::memcpy(bytes.data() + sizeof header, nodes.data(), nodes.size() * sizeof(Node));
        return bytes;
    }
    EymHeader header;
    std::vector<Node> nodes;
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

TEST(EymDamage, OfAnyBitThatMattersIsNoticed) {
    const test::TemporaryFolder folder;
    const std::string& bytes = smallFile();
    const Tables tables(bytes);
    std::size_t unnoticed = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        std::string flipped = bytes;
        flipped[i] = static_cast<char>(flipped[i] ^ 1 << i % 8);
        test::writeFile(folder.file("m.eym"), flipped);
        unnoticed += readAll(folder.file("m.eym")).ok() ? 1 : 0;
    }
    // Only padding between sections and between the nodes' indices carries nothing.
    std::uint64_t carried = sizeof(EymHeader) + tables.nodes.size() * sizeof(Node);
    for (const Node& node : tables.nodes) carried += node.vertexCount * 16 + node.indexCount * 2;
    EXPECT_EQ(unnoticed, bytes.size() - carried);
}

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
        {"vertices beyond the section", [](Tables& t) { t.nodes.back().firstVertex += 1; }},
        {"vertices far away", [huge](Tables& t) { t.nodes.back().firstVertex = huge - 2; }},
        {"too many vertices", [](Tables& t) { t.nodes.back().vertexCount = 65536; }},
        {"indices beyond the section", [](Tables& t) { t.nodes.back().firstIndex += 4; }},
        {"indices far away", [huge](Tables& t) { t.nodes.back().firstIndex = huge - 3; }},
        {"indices not aligned", [](Tables& t) { t.nodes.back().firstIndex -= 1; }},
        {"fewer indices than triangles", [](Tables& t) { t.nodes.back().indexCount -= 3; }},
        {"box upside down", [](Tables& t) { t.nodes[0].boxMin.x = t.nodes[0].boxMax.x + 1; }},
        {"box off the lattice", [](Tables& t) { t.nodes[0].boxMax.y = 1U << 21; }},
        {"box leaves the parent's", [](Tables& t) { t.nodes[1].boxMax.z = 2000; }},
        {"fronts past the indices",
         [](Tables& t) { t.nodes.back().frontIndexCount = t.nodes.back().indexCount + 3; }},
        {"part of a triangle's front", [](Tables& t) { t.nodes.back().frontIndexCount = 1; }},
        {"error below the child's", [](Tables& t) { t.nodes[0].errorMetres = 0; }},
        {"error not finite",
         [](Tables& t) { t.nodes[1].errorMetres = std::numeric_limits<float>::quiet_NaN(); }},
        {"range with a gap", [](Tables& t) { t.nodes[1].triangleEnd -= 1; }},
        {"empty range", [](Tables& t) { t.nodes[0].triangleEnd = 0; }},
        {"other triangle count", [](Tables& t) { t.header.triangleCount += 1; }},
        {"no nodes", [](Tables& t) { t.header.nodeCount = 0; }},
        {"many nodes", [](Tables& t) { t.header.nodeCount = 0xFFFFFFFF; }},
        {"many vertices", [huge](Tables& t) { t.header.vertexCount = huge; }},
        {"many indices", [huge](Tables& t) { t.header.indexCount = huge / 2 + 1; }},
        {"section elsewhere", [](Tables& t) { t.header.positionsOffset = 0; }},
        {"colours elsewhere", [](Tables& t) { t.header.coloursOffset = 1 << 20; }},
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

TEST(EymDamage, AnIndexBeyondItsVerticesIsRefusedWithARightChecksum) {
    const test::TemporaryFolder folder;
    std::string bytes = smallFile();
    Tables tables(bytes);
    Node& leaf = tables.nodes.back();
    const auto vertices = static_cast<std::uint16_t>(leaf.vertexCount);
    std::memcpy(bytes.data() + tables.header.indicesOffset + leaf.firstIndex * 2, &vertices, 2);
    const auto section = [&](std::uint64_t offset, std::uint64_t bytesEach) {
        return bytes.data() + offset + leaf.firstVertex * bytesEach;
    };
    leaf.checksum = geometryChecksum(
        {{reinterpret_cast<const std::uint64_t*>(section(tables.header.positionsOffset, 8)),
          leaf.vertexCount},
         {reinterpret_cast<const std::uint32_t*>(section(tables.header.normalsOffset, 4)),
          leaf.vertexCount},
         {reinterpret_cast<const std::uint32_t*>(section(tables.header.coloursOffset, 4)),
          leaf.vertexCount},
         {reinterpret_cast<const std::uint16_t*>(bytes.data() + tables.header.indicesOffset +
                                                 leaf.firstIndex * 2),
          leaf.indexCount}});
    test::writeFile(folder.file("m.eym"), tables.sealedInto(bytes));
    const absl::Status status = readAll(folder.file("m.eym"));
    EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss);
    EXPECT_NE(status.message().find("found index"), std::string::npos) << status;
}

RC_GTEST_PROP(EymDamage, OfTheTablesWithARightChecksumNeverLeavesTheFile, ()) {
    const test::TemporaryFolder folder;
    const std::string& bytes = smallFile();
    std::string damaged = bytes;
    const std::size_t tableBytes = sizeof(EymHeader) + Tables(bytes).nodes.size() * sizeof(Node);
    for (int i = *rc::gen::inRange(1, 4); i > 0; --i)
        damaged[*rc::gen::inRange<std::size_t>(16, tableBytes)] = *rc::gen::arbitrary<char>();
    Tables tables(bytes);  // with the count that the bytes have room for
    std::memcpy(&tables.header, damaged.data(), sizeof tables.header);
    std::memcpy(tables.nodes.data(), damaged.data() + sizeof tables.header,
                tables.nodes.size() * sizeof(Node));
    test::writeFile(folder.file("m.eym"), tables.sealedInto(damaged));
    const absl::Status status = readAll(folder.file("m.eym"));
    RC_CLASSIFY(status.ok());
    RC_ASSERT(status.ok() || !status.message().empty());
}

}  // namespace
}  // namespace eyrie::mesh
