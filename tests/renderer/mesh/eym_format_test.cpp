// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/eym_format.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/mesh/eym_writer.h"
#include "renderer/mesh/kd_tree.h"
#include "renderer/mesh/tuned_leaf.h"
#include "tests/renderer/mesh/sample_meshes.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::mesh {
namespace {

using Vertex = std::tuple<std::uint64_t, std::uint32_t, std::uint32_t>;
using Face = std::array<Vertex, 3>;

absl::Status write(const PackedMesh& mesh, std::uint32_t leafTriangles, const std::string& path,
                   bool isCoded = true) {
    auto tree = buildKdTree(mesh.positions, mesh.triangles, {leafTriangles});
    auto out = OutputFile::create(path);
    EXPECT_TRUE(tree.ok() && out.ok());
    auto lod = buildLodTree(mesh, *tree, {.nodeTriangles = 64});
    EXPECT_TRUE(lod.ok());
    const absl::Status written = writeEym(mesh, *tree, *lod, findBacks(mesh, *tree),
                                          {.isCoded = isCoded, .sourceHash = 0x1234}, *out);
    return written.ok() ? out->commit() : written;
}

/// Sorted, each beginning with its least corner: triangles are turned as they are stored.
std::vector<Face> ordered(std::vector<Face> faces) {
    for (Face& face : faces)
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    std::sort(faces.begin(), faces.end());
    return faces;
}

std::vector<Face> facesOf(const PackedMesh& mesh) {
    std::vector<Face> faces;
    for (const Triangle& triangle : mesh.triangles) {
        Face face;
        for (std::size_t i = 0; i < 3; ++i)
            face[i] = {mesh.positions[triangle[i]], mesh.normals[triangle[i]],
                       mesh.colours.empty() ? 0 : mesh.colours[triangle[i]]};
        faces.push_back(face);
    }
    return ordered(std::move(faces));
}

std::vector<Face> facesOf(const EymFile& file) {
    std::vector<Face> faces;
    for (std::uint32_t node = 0; node < file.nodes().size(); ++node) {
        const auto geometry = file.geometry(node);
        EXPECT_TRUE(geometry.ok()) << geometry.status();
        for (std::size_t i = 0; i < geometry->indices.size(); ++i) {
            const std::size_t v = geometry->indices[i];
            if (i % 3 == 0)
                faces.emplace_back();
            faces.back()[i % 3] = {geometry->positions[v], geometry->normals[v],
                                   geometry->colours.empty() ? 0 : geometry->colours[v]};
        }
    }
    return ordered(std::move(faces));
}

struct Form {
    bool hasColours;
    bool isCoded;
};
class EymFormat : public testing::TestWithParam<Form> {};

TEST_P(EymFormat, GivesEveryTriangleBackOnce) {
    const test::TemporaryFolder folder;
    const PackedMesh mesh = test::randomSoup(5000, 1500, 3000, 1, GetParam().hasColours);
    ASSERT_TRUE(write(mesh, 100, folder.file("m.eym"), GetParam().isCoded).ok());
    const auto file = EymFile::open(folder.file("m.eym"));
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_EQ(file->hasColours(), GetParam().hasColours);
    EXPECT_EQ(file->isCoded(), GetParam().isCoded);
    EXPECT_EQ(file->triangleCount(), 5000U);
    EXPECT_EQ(file->lattice(), mesh.lattice);
    EXPECT_EQ(file->sourceHash(), 0x1234U);
    EXPECT_EQ(facesOf(*file), facesOf(mesh));
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutColours, EymFormat,
                         testing::Values(Form{false, false}, Form{false, true}, Form{true, false},
                                         Form{true, true}));

TEST(EymFile, GivesPointsBack) {
    const test::TemporaryFolder folder;
    const PackedMesh mesh = test::randomSoup(600, 300, 3000, 1);
    const auto tree = buildKdTree(mesh.positions, mesh.triangles, {100});
    ASSERT_TRUE(tree.ok());
    const auto lod = buildLodTree(
        mesh, *tree, {.nodeTriangles = 100, .sampledTriangles = 200, .nodePoints = 40});
    ASSERT_TRUE(lod.ok() && lod->points[0]);
    for (const bool isCoded : {false, true}) {
        auto out = OutputFile::create(folder.file("m.eym"));
        ASSERT_TRUE(out.ok());
        ASSERT_TRUE(
            writeEym(mesh, *tree, *lod, findBacks(mesh, *tree), {.isCoded = isCoded}, *out).ok());
        ASSERT_TRUE(out->commit().ok());
        const auto file = EymFile::open(folder.file("m.eym"));
        ASSERT_TRUE(file.ok()) << file.status();
        const PointSample& root = *lod->points[0];
        EXPECT_TRUE(file->nodes()[0].isOfPoints());
        const auto geometry = file->geometry(0);
        ASSERT_TRUE(geometry.ok()) << geometry.status();
        EXPECT_TRUE(std::ranges::equal(geometry->positions, root.positions));
        EXPECT_TRUE(std::ranges::equal(geometry->normals, root.normals));
        EXPECT_TRUE(geometry->colours.empty() && geometry->indices.empty());
        const auto ranges = file->pointRanges(0);
        ASSERT_EQ(ranges.size(), root.prefixes.size());
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            EXPECT_EQ(ranges[i].points, root.prefixes[i].points);
            EXPECT_GE(ranges[i].errorMetres,
                      static_cast<float>(root.prefixes[i].errorSteps * mesh.lattice.stepMetres));
        }
        const auto leaf = static_cast<std::uint32_t>(file->nodes().size() - 1);
        EXPECT_TRUE(file->pointRanges(leaf).empty());
    }
}

/// What is sent to the device is the same bytes, so pictures are.
TEST(EymFile, GivesTheSameBlocksCodedAndRaw) {
    const test::TemporaryFolder folder;
    const PackedMesh mesh = test::randomSoup(9000, 3000, 3000, 4, true);
    ASSERT_TRUE(write(mesh, 700, folder.file("coded.eym"), true).ok());
    ASSERT_TRUE(write(mesh, 700, folder.file("raw.eym"), false).ok());
    const auto coded = EymFile::open(folder.file("coded.eym"));
    const auto raw = EymFile::open(folder.file("raw.eym"));
    ASSERT_TRUE(coded.ok() && raw.ok()) << coded.status() << raw.status();
    EXPECT_LT(coded->fileBytes(), raw->fileBytes());
    ASSERT_EQ(coded->nodes().size(), raw->nodes().size());
    for (std::uint32_t node = 0; node < coded->nodes().size(); ++node) {
        const auto a = coded->geometry(node);
        const auto b = raw->geometry(node);
        ASSERT_TRUE(a.ok() && b.ok()) << a.status() << b.status();
        EXPECT_TRUE(std::ranges::equal(a->block, b->block)) << node;
    }
}

/// Every triangle of the leaves, with the material of its range.
TEST(EymFile, GivesMaterialsTexturesAndImagesBack) {
    const test::TemporaryFolder folder;
    const PackedMesh mesh = test::texturedSoup(700, 8);
    for (const bool isCoded : {true, false}) {
        ASSERT_TRUE(write(mesh, 100, folder.file("m.eym"), isCoded).ok());
        const auto file = EymFile::open(folder.file("m.eym"));
        ASSERT_TRUE(file.ok()) << file.status();
        EXPECT_TRUE(std::ranges::equal(file->materials(), mesh.materials));
        for (std::uint32_t i = 0; i < mesh.images.size(); ++i) {
            EXPECT_EQ(file->images()[i].shape, mesh.images[i].shape);
            EXPECT_EQ(*file->imageBlocks(i), mesh.images[i].blocks);
        }
        using Corner = std::tuple<std::uint32_t, std::uint64_t, int, int>;
        std::vector<Corner> expected, found;
        for (const Triangle& triangle : mesh.triangles)
            for (const std::uint32_t v : triangle)
                expected.emplace_back(mesh.materialOf[v], mesh.positions[v],
                                      mesh.textureCoordinates[v].x, mesh.textureCoordinates[v].y);
        for (std::uint32_t node = 0; node < file->nodes().size(); ++node) {
            if (!file->nodes()[node].isLeaf())
                continue;
            const auto geometry = file->geometry(node);
            ASSERT_TRUE(geometry.ok()) << geometry.status();
            std::size_t at = 0;
            bool isBlended = false;
            for (const MaterialRange& range : file->ranges(node)) {
                const bool wasBlended =
                    std::exchange(isBlended, mesh.materials[range.material].isBlended());
                EXPECT_FALSE(wasBlended && !isBlended) << "what is blended comes last";
                EXPECT_EQ(range.frontIndexCount, 0U) << "what is see-through shows backs";
                for (const std::size_t end = at + range.indexCount; at < end; ++at) {
                    const std::uint16_t v = geometry->indices[at];
                    const glm::ivec2 place = geometry->textureCoordinates[v];
                    found.emplace_back(range.material, geometry->positions[v], place.x, place.y);
                }
            }
        }
        std::ranges::sort(expected);
        std::ranges::sort(found);
        EXPECT_EQ(found, expected);
    }
}

TEST(EymFile, KeepsSourcePositionsToTheBit) {
    const test::TemporaryFolder folder;
    PackedMesh mesh = test::randomSoup(3000, 1000, 3000, 5);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const fabric::Vec3 near = mesh.lattice.metres(unpackPosition(mesh.positions[v]));
        mesh.exact.push_back(near + 1e-3 * static_cast<double>(v % 50) / 7);
    }
    ASSERT_TRUE(write(mesh, 100, folder.file("m.eym")).ok());
    const auto file = EymFile::open(folder.file("m.eym"));
    ASSERT_TRUE(file.ok() && file->hasExactPositions()) << file.status();
    std::set<std::tuple<double, double, double>> found, expected;
    for (std::uint32_t node = 0; node < file->nodes().size(); ++node) {
        if (!file->nodes()[node].isLeaf())
            continue;
        const auto exact = file->exactPositions(node);
        ASSERT_TRUE(exact.ok()) << exact.status();
        for (const fabric::Vec3& p : *exact) found.insert({p.x, p.y, p.z});
    }
    for (const Triangle& triangle : mesh.triangles)
        for (const std::uint32_t v : triangle)
            expected.insert({mesh.exact[v].x, mesh.exact[v].y, mesh.exact[v].z});
    EXPECT_EQ(found, expected);
}

TEST(EymFile, TellsBoundsInMetresAndErrorsNotBelowTheLattices) {
    const test::TemporaryFolder folder;
    PackedMesh mesh = test::separateTriangles(40);
    mesh.lattice = {{-8, 16, 0}, 0.25};
    ASSERT_TRUE(write(mesh, 10, folder.file("m.eym")).ok());
    const auto file = EymFile::open(folder.file("m.eym"));
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_EQ(file->bounds(), (fabric::Box{{-8, 16, 0}, {2, 16.25, 0}}));
    EXPECT_EQ(file->vertexCount(), 120U);
    EXPECT_EQ(file->levels(), 3);
    for (const Node& node : file->nodes()) {
        EXPECT_GE(static_cast<double>(node.errorMetres), mesh.lattice.errorMetres());
        EXPECT_LE(static_cast<double>(node.errorMetres), mesh.lattice.errorMetres() * 1.000001);
    }
}

/// In half of a float, so a little more than it is.
TEST(EymFile, KeepsHowFarColoursReach) {
    const test::TemporaryFolder folder;
    PackedMesh mesh = test::randomSoup(600, 300, 3000, 1, true);
    const auto tree = buildKdTree(mesh.positions, mesh.triangles, {100});
    ASSERT_TRUE(tree.ok());
    auto lod = buildLodTree(mesh, *tree, {.nodeTriangles = 100});
    ASSERT_TRUE(lod.ok());
    for (std::size_t i = 0; i < tree->nodes.size(); ++i)
        lod->colourReachMetres[i] = tree->nodes[i].isLeaf() ? 0 : 0.3 / static_cast<double>(i + 1);
    const auto writeAs = [&](const std::string& name) {
        auto out = OutputFile::create(folder.file(name));
        EXPECT_TRUE(out.ok());
        EXPECT_TRUE(writeEym(mesh, *tree, *lod, findBacks(mesh, *tree), {}, *out).ok());
        EXPECT_TRUE(out->commit().ok());
        return EymFile::open(folder.file(name));
    };
    const auto file = writeAs("m.eym");
    ASSERT_TRUE(file.ok()) << file.status();
    for (std::size_t i = 0; i < tree->nodes.size(); ++i) {
        const Node& node = file->nodes()[i];
        EXPECT_GE(double{node.colourReachMetres()}, lod->colourReachMetres[i]);
        EXPECT_LE(double{node.colourReachMetres()}, lod->colourReachMetres[i] * 1.01);
        EXPECT_EQ(node.farthestMetres(), std::max(node.errorMetres, node.colourReachMetres()));
    }
}

TEST(EymFile, CountsOnlyVerticesThatTrianglesUse) {
    const test::TemporaryFolder folder;
    PackedMesh mesh = test::separateTriangles(4);
    mesh.triangles.pop_back();
    ASSERT_TRUE(write(mesh, 10, folder.file("m.eym")).ok());
    EXPECT_EQ(EymFile::open(folder.file("m.eym"))->vertexCount(), 9U);
}

TEST(EymFile, StaysTheSameForTheSameMesh) {
    const test::TemporaryFolder folder;
    const PackedMesh mesh = test::randomSoup(30000, 9000, 3000, 2, true);
    ASSERT_TRUE(write(mesh, 700, folder.file("a.eym")).ok());
    ASSERT_TRUE(write(mesh, 700, folder.file("b.eym")).ok());
    EXPECT_EQ(test::readFile(folder.file("a.eym")), test::readFile(folder.file("b.eym")));
}

TEST(EymFile, HoldsALeafOf65535Vertices) {
    const test::TemporaryFolder folder;
    const PackedMesh mesh = test::separateTriangles(kMaxLeafVertices / 3);
    ASSERT_TRUE(write(mesh, kMaxLeafVertices, folder.file("m.eym")).ok());
    const auto file = EymFile::open(folder.file("m.eym"));
    ASSERT_TRUE(file.ok()) << file.status();
    const auto geometry = file->geometry(0);
    ASSERT_TRUE(geometry.ok()) << geometry.status();
    EXPECT_EQ(geometry->positions.size(), 65535U);
    EXPECT_EQ(*std::max_element(geometry->indices.begin(), geometry->indices.end()), 65534);
}

TEST(EymFile, SaysThatAnotherKindOfFileIsNone) {
    const test::TemporaryFolder folder;
    for (const std::string& text : {std::string(), std::string("ply\n"), std::string(500, 'x')}) {
        test::writeFile(folder.file("m.eym"), text);
        const absl::Status status = EymFile::open(folder.file("m.eym")).status();
        EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
        EXPECT_THAT(std::string(status.message()),
                    testing::AllOf(testing::HasSubstr(folder.file("m.eym")),
                                   testing::HasSubstr("eyrie import mesh")));
    }
    EXPECT_EQ(EymFile::open(folder.file("none")).status().code(), absl::StatusCode::kNotFound);
}

TEST(EymFile, NamesTheVersionItCannotRead) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(write(test::separateTriangles(4), 10, folder.file("m.eym")).ok());
    std::string bytes = test::readFile(folder.file("m.eym"));
    bytes[8] = 1;
    test::writeFile(folder.file("m.eym"), bytes);
    const absl::Status status = EymFile::open(folder.file("m.eym")).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(status.message()), testing::HasSubstr("header.version is 1"));
}

TEST(EymFile, KeepsThatItsLeavesWereMeasured) {
    const test::TemporaryFolder folder;
    const PackedMesh mesh = test::randomSoup(300, 90, 1000, 4);
    ASSERT_TRUE(write(mesh, 50, folder.file("m.eym")).ok());
    const auto before = EymFile::open(folder.file("m.eym"));
    ASSERT_TRUE(before.ok()) << before.status();
    EXPECT_EQ(before->tunedLeafTriangles(), 0U);
    ASSERT_TRUE(recordTunedLeaf(folder.file("m.eym"), 50).ok());
    const auto file = EymFile::open(folder.file("m.eym"));
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_EQ(file->tunedLeafTriangles(), 50U);
    EXPECT_EQ(facesOf(*file), facesOf(*before));
    test::writeFile(folder.file("no.eym"), "no mesh");
    EXPECT_EQ(recordTunedLeaf(folder.file("no.eym"), 50).code(),
              absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace eyrie::mesh
