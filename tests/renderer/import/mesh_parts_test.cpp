// SPDX-License-Identifier: Apache-2.0
// Meshes that are imported part by part: the file, what is said, and what is left where it fails.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <stop_token>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/mesh_import.h"
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
                       const TwoFiles& expectSame = expectSameBytes, std::uint64_t atOnce = 16384) {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("m.ply");
    ASSERT_TRUE(writePly(source, path).ok());
    const auto whole = importMesh({path}, folder.file("whole.eym"), options);
    const auto parted = importByParts(path, folder.file("parts.eym"), atOnce, options);
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

TEST(MeshImport, ByPartsIsNotCoarsenedByFacesWithACornerTwiceEither) {
    TriangleMesh ball = synthesizeMesh(60000, 3);
    const auto far = static_cast<std::uint32_t>(ball.positions.size());
    ball.positions.insert(ball.positions.end(), 2, {1e12, 0, 0});
    ball.triangles.insert(ball.triangles.begin() + 100,
                          {{far, far, far}, {0, far, far}, {far, far + 1, 0}});
    expectSameByParts(ball);
    const test::TemporaryFolder folder;
    ball.triangles.assign(5, {far, far + 1, 0});
    ASSERT_TRUE(writePly(ball, folder.file("m.ply")).ok());
    EXPECT_THAT(
        importByParts(folder.file("m.ply"), folder.file("m.eym"), 16384, {}).status().message(),
        testing::AllOf(HasSubstr("m.ply"), HasSubstr("found 5 triangles, none with any area")));
}

/// What is left is exact in single precision; the faces that are there twice are not.
TEST(MeshImport, ByPartsKeepsNoMorePrecisionForFacesThatAreThereTwice) {
    TriangleMesh ball = synthesizeMesh(60000, 3);
    for (fabric::Vec3& at : ball.positions) at = glm::round(at * 65536.0) / 65536.0;
    const TriangleMesh once = ball;
    const auto copies = static_cast<std::uint32_t>(once.positions.size());
    for (const fabric::Vec3& at : once.positions) ball.positions.push_back(at * (1 - 1e-13));
    for (const auto& [a, b, c] : once.triangles)
        ball.triangles.push_back({copies + a, copies + b, copies + c});
    expectSameByParts(ball, {.pack = {.keepsExact = true}});
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

/// Apart from each other, so that nothing stays for the sake of borders.
TriangleMesh twoRings(std::uint32_t around) {
    constexpr std::uint32_t kAcross = 3;
    TriangleMesh mesh;
    for (const double aside : {0.0, 10.0}) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (std::uint32_t i = 0; i < around; ++i)
            for (std::uint32_t k = 0; k < kAcross; ++k) {
                const double u = 2 * std::numbers::pi * i / around;
                const double v = 2 * std::numbers::pi * k / kAcross;
                const double radius = 3 + std::cos(v);
                mesh.positions.emplace_back(radius * std::cos(u) + aside, radius * std::sin(u),
                                            std::sin(v));
                const auto at = [&](std::uint32_t row, std::uint32_t column) {
                    return first + row % around * kAcross + column % kAcross;
                };
                mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
                mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
            }
    }
    return mesh;
}

/// Parts come to half their triangles, which two of them together are few enough to be drawn as.
TEST(MeshImport, ByPartsGivesTheSameBytesWhereTwoPartsAreNoMoreThanANode) {
    expectSameByParts(twoRings(2731));
}

/// Of parts that are too large to be simplified, two together are still small enough for points.
TEST(MeshImport, ByPartsGivesTheSameBytesWherePointsStandForSeveralParts) {
    expectSameByParts(soup(4, 70000),
                      {.pack = {.normals = NormalSource::Crease, .creaseDegrees = 5}},
                      expectSameBytes, 100000);
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

/// A ball of real colours, of which only the last says that they reach to 255.
std::string plyOfRealColours() {
    const TriangleMesh ball = synthesizeMesh(200000, 3);
    test::PlyBody body(test::Encoding::BigEndian);
    for (std::size_t i = 0; i < ball.positions.size(); ++i) {
        const fabric::Vec3& at = ball.positions[i];
        body.add(at.x).add(at.y).add(at.z).add(at.z > 0 ? 1.0F : 0.0F).add(2.0F);
        body.add(i + 1 == ball.positions.size() ? 200.0F : 0.0F).add(std::uint8_t{100});
    }
    for (const auto& [a, b, c] : ball.triangles) body.add(std::uint8_t{3}).add(a).add(b).add(c);
    return fmt::format(
        "{}element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
        "property float red\nproperty float green\nproperty float blue\nproperty uchar alpha\n"
        "element face {}\nproperty list uchar uint vertex_indices\nend_header\n{}",
        test::formatLine(test::Encoding::BigEndian), ball.positions.size(), ball.triangles.size(),
        body.bytes());
}

TEST(MeshImport, ByPartsTakesTheSameColoursForBytesAndSaysTheSameOfOpacity) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.ply"), plyOfRealColours());
    const auto whole = importMesh({folder.file("m.ply")}, folder.file("whole.eym"));
    const auto parted = importByParts(folder.file("m.ply"), folder.file("parts.eym"), 65536);
    ASSERT_TRUE(whole.ok() && parted.ok()) << whole.status() << parted.status();
    EXPECT_THAT(whole->notes,
                ElementsAre(HasSubstr("numbers of 0 to 255"), HasSubstr("are not opaque")));
    EXPECT_EQ(parted->notes, whole->notes);
    expectSameBytes(folder.file("parts.eym"), folder.file("whole.eym"));
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

}  // namespace
}  // namespace eyrie::import
