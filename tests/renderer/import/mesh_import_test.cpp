// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/mesh_import.h"

#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "renderer/import/mesh_import_parts.h"
#include "renderer/import/mesh_synth.h"
#include "renderer/import/ply_writer.h"
#include "renderer/mesh/eym_format.h"
#include "tests/renderer/import/file_size_limit.h"
#include "tests/renderer/import/ply_text.h"
#include "tests/renderer/import/tga_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(MeshImport, WritesTheMeshThatTheReportTellsOf) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(writePly(synthesizeMesh(30000, 1), folder.file("m.ply")).ok());
    const auto report = importMesh({folder.file("m.ply")}, folder.file("m.eym"));
    ASSERT_TRUE(report.ok()) << report.status();
    const auto file = mesh::EymFile::open(folder.file("m.eym"));
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_EQ(file->triangleCount(), report->triangles);
    EXPECT_EQ(file->vertexCount(), report->vertices);
    EXPECT_EQ(file->nodes().size(), report->nodes);
    EXPECT_EQ(file->fileBytes(), report->bytes);
    EXPECT_EQ(file->sourceHash(), *mesh::contentHash(folder.file("m.ply")));
    EXPECT_TRUE(report->counts.normalsComputed);
    EXPECT_EQ(report->triangles, report->vertices * 2 - 4);  // closed, so nothing was lost
    for (const mesh::Node& node : file->nodes())
        EXPECT_TRUE(!node.isLeaf() || node.triangleEnd - node.triangleBegin <= 8192U);
    EXPECT_THAT(folder.names(), testing::UnorderedElementsAre("m.ply", "m.eym"));
}

TEST(MeshImport, GivesTheSameBytesForAnyNumberOfThreadsAndEitherWay) {
    const test::TemporaryFolder folder;
    const TriangleMesh source = synthesizeMesh(100000, 2);
    ASSERT_TRUE(writePly(source, folder.file("m.ply")).ok());
    ASSERT_TRUE(importMesh({folder.file("m.ply")}, folder.file("a.eym")).ok());
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    ASSERT_TRUE(
        importMesh(source, folder.file("b.eym"), {}, {}, *mesh::contentHash(folder.file("m.ply")))
            .ok());
    EXPECT_EQ(test::readFile(folder.file("a.eym")), test::readFile(folder.file("b.eym")));
}

/// A ball without some of its triangles: nobody can tell which backs are seen.
TriangleMesh openBall(std::size_t triangles, std::uint32_t seed) {
    TriangleMesh ball = synthesizeMesh(triangles, seed);
    for (std::size_t i = 0; i < ball.triangles.size(); i += 1000) ball.triangles[i][0] = 0;
    return ball;
}

absl::StatusOr<MeshImportReport> importByParts(const std::string& source, const std::string& path,
                                               std::uint64_t atOnce,
                                               const MeshImportOptions& options = {},
                                               const ImportControl& control = {}) {
    auto out = mesh::OutputFile::create(path);
    if (!out.ok())
        return out.status();
    auto report = importInParts(std::vector{source}, *out, atOnce, options, control,
                                *mesh::contentHash(source));
    if (report.ok() && !out->commit().ok())
        return absl::UnavailableError("not committed");
    return report;
}

/// The file by parts, and all at once.
using TwoFiles = std::function<void(const std::string&, const std::string&)>;

void expectSameBytes(const std::string& parts, const std::string& whole) {
    EXPECT_EQ(test::readFile(parts), test::readFile(whole));
}

/// By parts no holes have lids: all backs are drawn.
void expectSameButForBacks(const std::string& parts, const std::string& whole) {
    const auto a = mesh::EymFile::open(parts);
    const auto b = mesh::EymFile::open(whole);
    ASSERT_TRUE(a.ok() && b.ok()) << a.status() << b.status();
    ASSERT_EQ(a->nodes().size(), b->nodes().size());
    EXPECT_THAT(a->lids(), testing::IsEmpty());
    for (std::size_t i = 0; i < a->nodes().size(); ++i) {
        const mesh::Node& node = a->nodes()[i];
        const mesh::Node& other = b->nodes()[i];
        EXPECT_EQ(node.frontIndexCount, 0U);
        EXPECT_EQ(std::tie(node.boxMin, node.boxMax, node.triangleBegin, node.triangleEnd),
                  std::tie(other.boxMin, other.boxMax, other.triangleBegin, other.triangleEnd));
        EXPECT_EQ(std::tie(node.errorMetres, node.vertexCount, node.indexCount),
                  std::tie(other.errorMetres, other.vertexCount, other.indexCount));
    }
}

void expectSameByParts(const TriangleMesh& source, const MeshImportOptions& options = {},
                       const TwoFiles& expectSame = expectSameBytes) {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("m.ply");
    ASSERT_TRUE(writePly(source, path).ok());
    const auto whole = importMesh({path}, folder.file("whole.eym"), options);
    const auto parted = importByParts(path, folder.file("parts.eym"), 16384, options);
    ASSERT_TRUE(whole.ok() && parted.ok()) << whole.status() << parted.status();
    EXPECT_EQ(parted->counts, whole->counts);
    EXPECT_EQ(parted->vertices, whole->vertices);
    EXPECT_EQ(parted->nodes, whole->nodes);
    EXPECT_EQ(parted->pointNodes, whole->pointNodes);
    EXPECT_EQ(parted->levels.size(), whole->levels.size());
    EXPECT_EQ(parted->coarsestErrorMetres, whole->coarsestErrorMetres);
    expectSame(folder.file("parts.eym"), folder.file("whole.eym"));
    EXPECT_THAT(folder.names(), testing::UnorderedElementsAre("m.ply", "whole.eym", "parts.eym"));
}

TEST(MeshImport, ByPartsGivesTheSameBytesAsAllAtOnce) {
    expectSameByParts(synthesizeMesh(60000, 3));
}

TEST(MeshImport, ByPartsGivesTheSameOfAnOpenMeshButForItsBacks) {
    expectSameByParts(openBall(40000, 3), {}, expectSameButForBacks);
}

/// A ball whose colours vanish from level to level.
TriangleMesh speckledBall() {
    TriangleMesh ball = synthesizeMesh(60000, 3);
    std::mt19937 engine(5);
    for (std::size_t i = 0; i < ball.positions.size(); ++i) {
        const auto shade = static_cast<std::uint8_t>(ball.positions[i].z > 0 ? engine() % 256 : 90);
        ball.colours.push_back({shade, 60, 200, 255});
    }
    return ball;
}

TEST(MeshImport, ByPartsGivesTheSameBytesWithReachesOfColours) {
    const test::TemporaryFolder folder;
    for (const bool isRaw : {false, true})
        for (const bool keepsExact : {false, true})
            expectSameByParts(speckledBall(), {.pack = {.keepsExact = keepsExact}, .isRaw = isRaw});
    const auto report = importMesh(speckledBall(), folder.file("m.eym"));
    ASSERT_TRUE(report.ok()) << report.status();
    const auto file = mesh::EymFile::open(folder.file("m.eym"));
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_GT(file->nodes()[0].colourReachMetres(), 0);
    EXPECT_GE(file->nodes()[0].colourReachMetres(),
              static_cast<float>(report->levels.back().largestReachMetres));
}

/// Balls of many sizes through each other, each fifth inside out, with colours and normals, faces
/// that are there twice and some without an area.
TriangleMesh soup(std::size_t balls, std::size_t triangles) {
    std::mt19937 engine(7);
    const auto random = [&engine] { return static_cast<double>(engine() % 10000) / 10000; };
    TriangleMesh soup;
    for (std::size_t i = 0; i < balls; ++i) {
        const TriangleMesh ball = synthesizeMesh(triangles, i % 3);
        const auto first = static_cast<std::uint32_t>(soup.positions.size());
        const fabric::Vec3 middle(40 * random(), 40 * random(), 10 * random());
        const double size = 0.2 + random();
        const auto shade = static_cast<std::uint8_t>(i);
        for (std::size_t v = 0; v < ball.positions.size(); ++v) {
            const fabric::Vec3& at = ball.positions[v];
            soup.positions.push_back(middle + size * at);
            soup.normals.emplace_back(at.x, at.y, v % 7 == 0 ? 0 : at.z);
            soup.colours.push_back(
                {shade, static_cast<std::uint8_t>(v % 50 == 0 ? 9 : 0), 80, 255});
        }
        for (auto [a, b, c] : ball.triangles) {
            if (i % 5 == 0)
                std::swap(b, c);
            soup.triangles.push_back({first + a, first + b, first + c});
            if (soup.triangles.size() % 100 == 0)
                soup.triangles.push_back({first + b, first + c, first + a});
            if (soup.triangles.size() % 333 == 0)
                soup.triangles.push_back({first + b, first + b, first + a});
        }
    }
    return soup;
}

TEST(MeshImport, ByPartsGivesTheSameBytesOfASoup) { expectSameByParts(soup(300, 200)); }

TEST(MeshImport, ByPartsGivesTheSameBytesWithCreasesAndSourcePositions) {
    expectSameByParts(
        soup(8, 5000),
        {.leafTriangles = 1000,
         .pack = {.keepsExact = true, .normals = NormalSource::Crease, .creaseDegrees = 20}});
}

TEST(MeshImport, CountsTheNodesThatPointsStandFor) {
    const test::TemporaryFolder folder;
    const auto report = importMesh(
        soup(8, 5000), folder.file("m.eym"),
        {.leafTriangles = 1000, .pack = {.normals = NormalSource::Crease, .creaseDegrees = 20}});
    ASSERT_TRUE(report.ok()) << report.status();
    const auto file = mesh::EymFile::open(folder.file("m.eym"));
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_GT(report->pointNodes, 0U);
    EXPECT_EQ(
        static_cast<std::size_t>(report->pointNodes),
        static_cast<std::size_t>(std::ranges::count_if(file->nodes(), &mesh::Node::isOfPoints)));
}

TEST(MeshImport, ByPartsGivesTheSameWithTheFilesNormalsAndMappedPages) {
    expectSameByParts(soup(8, 5000),
                      {.pack = {.latticeBits = 10, .normals = NormalSource::File}, .isRaw = true},
                      expectSameButForBacks);  // so coarse a lattice opens them
}

/// Two faces of a cube, of which each corner has its face's normal.
constexpr const char* kEdgeObj =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 -1\nv 1 0 -1\nvn 0 0 1\nvn 0 -1 0\n"
    "f 1//1 2//1 3//1\nf 1//1 3//1 4//1\nf 5//2 6//2 2//2\nf 5//2 2//2 1//2\n";

std::uint64_t verticesOf(const std::vector<std::string>& sources, const MeshImportOptions& how) {
    const test::TemporaryFolder folder;
    const auto report = importMesh(sources, folder.file("m.eym"), how);
    EXPECT_TRUE(report.ok()) << report.status();
    return report.ok() ? report->vertices : 0;
}

TEST(MeshImport, KeepsEdgesThatAnObjStates) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), kEdgeObj);
    const std::vector<std::string> obj = {folder.file("m.obj")};
    EXPECT_EQ(verticesOf(obj, {}), 8U);  // the two on the edge are there twice
    EXPECT_EQ(verticesOf(obj, {.pack = {.normals = NormalSource::Smooth}}), 6U);
}

/// The same faces with the same normals.
TriangleMesh edgeMesh() {
    TriangleMesh mesh;
    mesh.positions = {{10, 0, 0}, {11, 0, 0}, {11, 1, 0},  {10, 1, 0},
                      {10, 0, 0}, {11, 0, 0}, {10, 0, -1}, {11, 0, -1}};
    for (int i = 0; i < 8; ++i)
        mesh.normals.emplace_back(i < 4 ? glm::vec3(0, 0, 1) : glm::vec3(0, -1, 0));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {6, 7, 5}, {6, 5, 4}};
    return mesh;
}

TEST(MeshImport, SmoothsPlyByDefaultBesideAnObjThatStatesItsEdges) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.ply"), test::plyOf(edgeMesh(), test::Encoding::LittleEndian));
    test::writeFile(folder.file("m.obj"), kEdgeObj);
    const std::string ply = folder.file("m.ply");
    EXPECT_EQ(verticesOf({ply}, {}), 6U);
    EXPECT_EQ(verticesOf({ply}, {.pack = {.normals = NormalSource::File}}), 8U);
    EXPECT_EQ(verticesOf({ply, folder.file("m.obj")}, {}), 6U + 8U);
}

TEST(MeshImport, SmoothsStlWhoseNormalsAreOfFacesAlone) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.stl"),
                    "solid m\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                    "vertex 1 1 0\nendloop\nendfacet\nfacet normal 0 -1 0\nouter loop\n"
                    "vertex 0 0 -1\nvertex 1 0 0\nvertex 0 0 0\nendloop\nendfacet\n"
                    "endsolid m\n");
    const std::vector<std::string> stl = {folder.file("m.stl")};
    EXPECT_EQ(verticesOf(stl, {}), 4U);
    EXPECT_EQ(verticesOf(stl, {.pack = {.normals = NormalSource::File}}), 6U);
}

TEST(MeshImport, SaysByPartsTooWhatItLeavesOutOfAPly) {
    const test::TemporaryFolder folder;
    std::string text = test::plyOf(test::tetrahedron(), test::Encoding::Ascii);
    text.insert(text.find("element vertex"), "comment TextureFile a.png\n");
    text.insert(text.find("element face"), "element multi_texture_vertex 0\nproperty float u\n");
    test::writeFile(folder.file("m.ply"), text);
    const auto whole = importMesh({folder.file("m.ply")}, folder.file("whole.eym"));
    const auto parted = importByParts(folder.file("m.ply"), folder.file("parts.eym"), 16384);
    ASSERT_TRUE(whole.ok() && parted.ok()) << whole.status() << parted.status();
    EXPECT_THAT(whole->notes, ElementsAre(HasSubstr("1 textures"), HasSubstr("multi_text")));
    EXPECT_EQ(parted->notes, whole->notes);
}

TEST(MeshImport, ByPartsLeavesTexturesOutAndSaysSo) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.ply"),
                    "ply\nformat ascii 1.0\ncomment TextureFile a.tga\nelement vertex 3\n"
                    "property float x\nproperty float y\nproperty float z\nproperty float u\n"
                    "property float v\nelement face 1\nproperty list uchar int vertex_indices\n"
                    "end_header\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n");
    test::writeFile(folder.file("a.tga"), test::tgaOf(1, 1, {{9, 8, 7, 255}}));
    const auto whole = importMesh({folder.file("m.ply")}, folder.file("whole.eym"));
    const auto parted = importByParts(folder.file("m.ply"), folder.file("parts.eym"), 16384);
    ASSERT_TRUE(whole.ok()) << whole.status();
    ASSERT_TRUE(parted.ok()) << parted.status();
    EXPECT_THAT(whole->notes, testing::IsEmpty());
    EXPECT_EQ(mesh::EymFile::open(folder.file("whole.eym"))->images().size(), 1U);
    EXPECT_THAT(parted->notes, ElementsAre(HasSubstr("left out its 1 textures, which a mesh that "
                                                     "is imported part by part cannot have")));
    EXPECT_TRUE(mesh::EymFile::open(folder.file("parts.eym"))->images().empty());
}

TEST(MeshImport, ReportsItsStagesInOrder) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(writePly(test::tetrahedron(), folder.file("m.ply")).ok());
    std::vector<std::string> stages;
    double last = 0;
    const ImportControl control{[&](std::string_view stage, double fraction) {
                                    if (stages.empty() || stages.back() != stage) {
                                        stages.emplace_back(stage);
                                        last = 0;
                                    }
                                    EXPECT_GE(fraction, last);
                                    EXPECT_LE(fraction, 1);
                                    last = fraction;
                                },
                                {}};
    ASSERT_TRUE(importMesh({folder.file("m.ply")}, folder.file("m.eym"), {}, control).ok());
    EXPECT_THAT(stages, ElementsAre("reading", "welding", "normals", "tree", "levels", "writing"));
}

class MeshImportStopped : public testing::TestWithParam<const char*> {};

TEST_P(MeshImportStopped, LeavesNothingBehindAndTheOldFileAsItWas) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(writePly(synthesizeMesh(20000, 1), folder.file("m.ply")).ok());
    test::writeFile(folder.file("m.eym"), "old");
    std::stop_source stop;
    const ImportControl control{[&](std::string_view stage, double) {
                                    if (stage == GetParam())
                                        stop.request_stop();
                                },
                                stop.get_token()};
    const auto report = importMesh({folder.file("m.ply")}, folder.file("m.eym"), {}, control);
    EXPECT_EQ(report.status().code(), absl::StatusCode::kCancelled);
    EXPECT_EQ(test::readFile(folder.file("m.eym")), "old");
    EXPECT_THAT(folder.names(), testing::UnorderedElementsAre("m.ply", "m.eym"));
}

class MeshImportByParts : public testing::TestWithParam<const char*> {};

TEST_P(MeshImportByParts, LeavesNothingBehindWhenItIsStopped) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(writePly(synthesizeMesh(20000, 1), folder.file("m.ply")).ok());
    std::stop_source stop;
    const ImportControl control{[&](std::string_view stage, double) {
                                    if (stage == GetParam())
                                        stop.request_stop();
                                },
                                stop.get_token()};
    const auto report =
        importByParts(folder.file("m.ply"), folder.file("m.eym"), 16384, {}, control);
    EXPECT_EQ(report.status().code(), absl::StatusCode::kCancelled);
    EXPECT_THAT(folder.names(), ElementsAre("m.ply"));
}

INSTANTIATE_TEST_SUITE_P(Stages, MeshImportByParts,
                         testing::Values("reading", "welding", "backs", "tree", "borders", "levels",
                                         "writing"));

TEST(MeshImport, ByPartsSaysThatTheDiskIsFullAndLeavesNothingBehind) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(writePly(synthesizeMesh(20000, 1), folder.file("m.ply")).ok());
    const test::FileSizeLimit full(std::uint64_t{1} << 18);
    const auto report = importByParts(folder.file("m.ply"), folder.file("m.eym"), 16384);
    EXPECT_EQ(report.status().code(), absl::StatusCode::kResourceExhausted);
    EXPECT_THAT(std::string(report.status().message()),
                testing::AllOf(HasSubstr(folder.file("m.eym")), HasSubstr("allow larger files")));
    EXPECT_THAT(folder.names(), ElementsAre("m.ply"));
}

TEST(MeshImport, ThatWouldTakeMoreMemoryThanItMayGoesByPartsOrSaysWhatItTakes) {
    const test::TemporaryFolder folder;
    // What fits is known from the header. Of its faces one has corners.
    test::writeFile(folder.file("m.ply"),
                    "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
                    "property float y\nproperty float z\nelement face 5000000\n"
                    "property list uchar int vertex_indices\nend_header\n" +
                        std::string(12, '\0') + '\4');
    std::filesystem::resize_file(folder.file("m.ply"), 5000500);
    const MeshImportOptions little{.memoryBytes = kLeastMeshMemory};
    const auto parted = importMesh({folder.file("m.ply")}, folder.file("m.eym"), little);
    EXPECT_THAT(std::string(parted.status().message()),
                testing::AllOf(HasSubstr("m.ply"), HasSubstr("found 4"), HasSubstr("triangulate")));
    MeshImportOptions orienting = little;
    orienting.pack.orients = true;
    const auto refused = importMesh({folder.file("m.ply")}, folder.file("m.eym"), orienting);
    EXPECT_EQ(refused.status().code(), absl::StatusCode::kResourceExhausted);
    EXPECT_THAT(std::string(refused.status().message()),
                testing::AllOf(HasSubstr("m.ply"), HasSubstr("310 MiB"), HasSubstr("may use 256"),
                               HasSubstr("leave that out")));
    test::writeFile(folder.file("m.obj"), "v 0 0 0\n");
    std::filesystem::resize_file(folder.file("m.obj"), std::uint64_t{300} << 20);
    const auto whole = importMesh({folder.file("m.obj")}, folder.file("m.eym"), little);
    EXPECT_EQ(whole.status().code(), absl::StatusCode::kResourceExhausted);
    EXPECT_THAT(std::string(whole.status().message()),
                testing::AllOf(HasSubstr("m.obj"), HasSubstr("301 MiB"), HasSubstr("PLY")));
    EXPECT_THAT(folder.names(), testing::UnorderedElementsAre("m.ply", "m.obj"));
}

/// The header of one of faces of so many corners says little of its triangles.
TEST(MeshImport, AdvisesToTriangulateAPlyWhoseFacesHaveManyCorners) {
    constexpr int kCorners = 64;
    constexpr int kFaces = 75'000;
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 64\nproperty float x\nproperty float y\n"
        "property float z\nelement face 75000\nproperty list uchar uchar vertex_indices\n"
        "end_header\n";
    std::string face = "64";
    for (int i = 0; i < kCorners; ++i) {
        const double angle = 2 * std::numbers::pi * i / kCorners;
        text += std::to_string(std::cos(angle)) + ' ' + std::to_string(std::sin(angle)) + " 0\n";
        face += ' ' + std::to_string(i);
    }
    for (int i = 0; i < kFaces; ++i) text += face + '\n';
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.ply"), text);
    const auto report =
        importMesh({folder.file("m.ply")}, folder.file("m.eym"), {.memoryBytes = kLeastMeshMemory});
    EXPECT_EQ(report.status().code(), absl::StatusCode::kResourceExhausted);
    EXPECT_THAT(std::string(report.status().message()),
                testing::AllOf(HasSubstr("m.ply"), HasSubstr("may use 256"),
                               HasSubstr("triangulate it"), testing::Not(HasSubstr("convert"))));
}

TEST(MeshImport, KnowsThatTrianglesWhichShareNoCornersTakeMoreMemory) {
    constexpr std::uint64_t kTriangles = 2'000'000;
    constexpr std::uint64_t kFileBytes = 98'000'000;
    // Measured: 652 MiB, of which about 160 are for the program and its buffers.
    EXPECT_GT(importBytes(kTriangles, 3 * kTriangles, kFileBytes, {}), std::uint64_t{492} << 20);
    EXPECT_LT(importBytes(kTriangles, kTriangles / 2, kFileBytes, {}), std::uint64_t{256} << 20);
    constexpr std::uint64_t kMemory = std::uint64_t{1} << 30;
    EXPECT_LT(trianglesAtOnce(kMemory, kTriangles, 3 * kTriangles, {}),
              trianglesAtOnce(kMemory, kTriangles, kTriangles / 2, {}) / 2);
}

TEST(MeshImport, KnowsThatTexturedTrianglesTakeMoreMemory) {
    constexpr std::uint64_t kTriangles = 500'000;
    // Measured: 175 MiB, of which about 55 are for the program; 24 are the file.
    EXPECT_GT(importBytes(kTriangles, 300'000, std::uint64_t{24} << 20, {}, true),
              std::uint64_t{115} << 20);
    EXPECT_LT(importBytes(kTriangles, 300'000, std::uint64_t{24} << 20, {}),
              std::uint64_t{64} << 20);
}

INSTANTIATE_TEST_SUITE_P(Stages, MeshImportStopped,
                         testing::Values("reading", "welding", "normals", "tree", "levels",
                                         "writing"));

TEST(MeshImport, LeavesNothingBehindWhenTheSourceIsBad) {
    const test::TemporaryFolder folder;
    const std::string whole = test::plyOf(test::tetrahedron(), test::Encoding::LittleEndian);
    for (const std::string& text : {std::string(), whole.substr(0, whole.size() - 2)}) {
        test::writeFile(folder.file("m.ply"), text);
        const auto report = importMesh({folder.file("m.ply")}, folder.file("m.eym"));
        EXPECT_EQ(report.status().code(), absl::StatusCode::kInvalidArgument);
        EXPECT_THAT(std::string(report.status().message()), HasSubstr(folder.file("m.ply")));
        EXPECT_THAT(folder.names(), ElementsAre("m.ply"));
    }
}

TEST(MeshImport, NamesTheFileWhoseMeshCannotBeStored) {
    const test::TemporaryFolder folder;
    TriangleMesh source = test::tetrahedron();
    source.positions[3].z = 1e20;
    ASSERT_TRUE(writePly(source, folder.file("m.ply")).ok());
    const auto report = importMesh({folder.file("m.ply")}, folder.file("m.eym"));
    EXPECT_EQ(report.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(report.status().message()),
                testing::AllOf(HasSubstr("m.ply"), HasSubstr("z 0 to"), HasSubstr("units")));
    EXPECT_THAT(folder.names(), ElementsAre("m.ply"));
}

TEST(MeshImport, StoresTinyDetailsBesideHugeDistancesWithinTheStatedError) {
    const test::TemporaryFolder folder;
    TriangleMesh source = test::tetrahedron();
    source.positions = {{1e-6, 0, 0}, {1e12, 0, 0}, {0, 1e12, 1e-6}, {0, 0, 1e6}};
    const auto report = importMesh(source, folder.file("m.eym"));
    ASSERT_TRUE(report.ok()) << report.status();
    EXPECT_NEAR(mesh::EymFile::open(folder.file("m.eym"))->bounds().max.x, 1e12,
                report->errorMetres);
}

TEST(MeshImport, WithFewerBitsMakesASmallerFileWithWhatItRoundsInTheBound) {
    const test::TemporaryFolder folder;
    const TriangleMesh source = synthesizeMesh(20000, 3);
    const auto fine = importMesh(source, folder.file("fine.eym"));
    const auto coarse =
        importMesh(source, folder.file("coarse.eym"), {.pack = {.latticeBits = 12}});
    ASSERT_TRUE(fine.ok() && coarse.ok()) << fine.status() << coarse.status();
    EXPECT_LT(coarse->bytes, fine->bytes * 3 / 4);
    EXPECT_EQ(coarse->stepMetres, fine->stepMetres * 512);
    const auto file = mesh::EymFile::open(folder.file("coarse.eym"));
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_EQ(file->lattice().stepMetres, coarse->stepMetres);
    for (const mesh::Node& node : file->nodes())
        EXPECT_GE(static_cast<double>(node.errorMetres), file->lattice().errorMetres());
    EXPECT_EQ(
        importMesh(source, folder.file("none.eym"), {.pack = {.latticeBits = 22}}).status().code(),
        absl::StatusCode::kInvalidArgument);
}

TEST(MeshImport, LosslessKeepsEverySourcePositionOfAFloatFileToTheBit) {
    const test::TemporaryFolder folder;
    TriangleMesh source = synthesizeMesh(20000, 3);
    for (fabric::Vec3& p : source.positions)
        for (int axis = 0; axis < 3; ++axis) {
            // g++ 12 leaves out rounding to float and back where it vectorises it.
            const volatile float rounded = static_cast<float>(p[axis]);
            p[axis] = static_cast<double>(rounded);
        }
    const auto without = importMesh(source, folder.file("m.eym"));
    const auto report = importMesh(source, folder.file("m.eym"), {.pack = {.keepsExact = true}});
    ASSERT_TRUE(without.ok() && report.ok()) << report.status();
    EXPECT_LT(report->bytes, without->bytes + 6 * report->vertices);  // half of three floats
    const auto file = mesh::EymFile::open(folder.file("m.eym"));
    ASSERT_TRUE(file.ok() && file->hasExactPositions()) << file.status();
    using Bits = std::array<std::uint64_t, 3>;
    const auto bits = [](const fabric::Vec3& p) {
        return std::bit_cast<Bits>(std::array{p.x, p.y, p.z});
    };
    std::set<Bits> expected, found;
    for (const auto& triangle : source.triangles)
        for (const std::uint32_t corner : triangle) expected.insert(bits(source.positions[corner]));
    for (std::uint32_t node = 0; node < file->nodes().size(); ++node) {
        if (!file->nodes()[node].isLeaf())
            continue;
        const auto exact = file->exactPositions(node);
        ASSERT_TRUE(exact.ok()) << exact.status();
        for (const fabric::Vec3& p : *exact) found.insert(bits(p));
    }
    EXPECT_EQ(found, expected);
}

TEST(MeshImport, SaysWhichFormatsItReads) {
    const test::TemporaryFolder folder;
    const auto report = importMesh({folder.file("bunny.max")}, folder.file("m.eym"));
    EXPECT_EQ(report.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(report.status().message()),
                testing::AllOf(HasSubstr("bunny.max"), HasSubstr("'.max'"), HasSubstr(".ply"),
                               HasSubstr(".obj")));
}

TEST(MeshImport, RefusesToReplaceItsOwnSource) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(writePly(test::tetrahedron(), folder.file("m.ply")).ok());
    EXPECT_EQ(importMesh({folder.file("m.ply")}, folder.file("m.ply")).status().code(),
              absl::StatusCode::kInvalidArgument);
    EXPECT_GT(test::readFile(folder.file("m.ply")).size(), 100U);
}

TEST(MeshImport, TellsMissingSourcesAndFoldersApart) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(importMesh({folder.file("no.ply")}, folder.file("m.eym")).status().code(),
              absl::StatusCode::kNotFound);
    EXPECT_THAT(folder.names(), testing::IsEmpty());
    const auto report = importMesh(test::tetrahedron(), folder.file("none/m.eym"));
    EXPECT_EQ(report.status().code(), absl::StatusCode::kNotFound);
    EXPECT_THAT(std::string(report.status().message()), HasSubstr("create the folder"));
}

TEST(MeshImport, RefusesLeavesThat16BitsCannotIndex) {
    const test::TemporaryFolder folder;
    for (const std::uint32_t leafTriangles : {0U, 65536U})
        EXPECT_EQ(
            importMesh(test::tetrahedron(), folder.file("m.eym"), {leafTriangles}).status().code(),
            absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace eyrie::import
