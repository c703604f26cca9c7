// SPDX-License-Identifier: Apache-2.0
// Mesh files that are wrong in every way that is known: a message, or a repair that is counted.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_reader.h"
#include "renderer/import/pack_mesh.h"
#include "renderer/mesh/eym_format.h"
#include "tests/renderer/import/mesh_text.h"
#include "tests/renderer/import/ply_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::HasSubstr;

constexpr const char* kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

struct Case {
    const char* name;
    const char* file;
    std::string content;
    std::uint64_t triangles;    // stored; 0: refused
    std::uint64_t leftOut = 0;  // faces without area or of fewer than three corners, duplicates
};

/// A regular polygon of `corners`, as an OBJ; concave ones have every other corner drawn in.
std::string polygon(int corners, bool isConcave) {
    std::string text, face = "f";
    for (int i = 0; i < corners; ++i) {
        const double radius = isConcave && i % 2 == 1 ? 999 : 1000;
        const double angle = 2 * 3.14159265358979 * i / corners;
        text +=
            fmt::format("v {:.7f} {:.7f} 0\n", radius * std::cos(angle), radius * std::sin(angle));
        face += fmt::format(" {}", i + 1);
    }
    return text + face + "\n";
}

/// The same as a PLY, with faces of no, one and two corners after it.
std::string plyPolygon(int corners, bool isConcave, const std::string& count = "int") {
    std::string text, face = fmt::format("{}", corners);
    std::istringstream lines(polygon(corners, isConcave));
    for (std::string line; std::getline(lines, line) && line[0] == 'v';)
        text += line.substr(2) + "\n";
    for (int i = 0; i < corners; ++i) face += fmt::format(" {}", i);
    return fmt::format(
               "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
               "property double z\nelement face 4\nproperty list {} int vertex_indices\n"
               "end_header\n",
               corners, count) +
           text + face + "\n0\n1 0\n2 0 1\n";
}

std::string square(const std::string& faces) { return kSquare + faces; }

std::string binaryStl(std::uint32_t declared) {
    std::string text(1024, '\0');
    std::memcpy(text.data() + 80, &declared, 4);
    return text;
}

std::string gltf(const std::string& nodes, const std::string& count, const std::string& bytes) {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)" + nodes +
           R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{)"
           R"("bufferView":0,"componentType":5126,"count":)" +
           count + R"(,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":)" + bytes +
           R"(}],"buffers":[{"byteLength":)" + bytes +
           R"(,"uri":"data:application/octet-stream;base64,)"
           R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
}

/// Three corners of a triangle and, where there are any, indices: `bytes` in base 64.
std::string indexedGltf(const std::string& bytes) {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
           R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[)"
           R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
           R"({"bufferView":1,"componentType":5125,"count":3,"type":"SCALAR"}],"bufferViews":[)"
           R"({"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":12}],)"
           R"("buffers":[{"byteLength":48,"uri":"data:application/octet-stream;base64,)" +
           bytes + R"("}]})";
}

/// A header that goes on and on.
std::string plyHeader(const std::string& line, int times) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex 3\n";
    for (int i = 0; i < times; ++i) text += fmt::format("{}{}\n", line, i);
    return text + "end_header\n";
}

std::string glb() {
    std::string text = "glTF";
    for (const std::uint32_t word : {2U, 3'000'000'000U, 2'999'999'000U, 0x4E4F534AU})
        text.append(reinterpret_cast<const char*>(&word), 4);
    return text + "{}";
}

const std::vector<Case> kCases = {
    {"NoCorners", "m.obj", square("f\nf 1 2 3\n"), 1},
    {"OneCorner", "m.obj", square("f 1\nf 1 2 3\n"), 1, 1},
    {"TwoCorners", "m.obj", square("f 1 2\nf 1 2 3\n"), 1, 1},
    {"PointsAndLinesOnly", "m.obj", square("p 1\nl 1 2\n"), 0},
    {"PointsAndLinesBesideFaces", "m.obj", square("p 1\nl 1 2\nf 1 2 3\n"), 1, 2},
    {"NoFaces", "m.obj", kSquare, 0},
    {"TenThousandCorners", "m.obj", polygon(10000, false), 9998},
    {"TenThousandCornersConcave", "m.obj", polygon(10000, true), 9998},
    {"TwentyThousandCornersConcave", "m.obj", polygon(20000, true), 0},
    {"PlyOfTenThousandCornersAndOfFewerThanThree", "m.ply", plyPolygon(10000, false), 9998, 3},
    {"PlyOfTenThousandCornersConcave", "m.ply", plyPolygon(10000, true), 9998, 3},
    {"PlyOfMoreCornersThanACountOfItsTypeHolds", "m.ply", plyPolygon(300, false, "uchar"), 298, 3},
    {"GltfIndexBeyondTheLast", "m.gltf",
     indexedGltf("AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAEAAAADAAAA"), 0},
    {"GltfHugeIndex", "m.gltf",
     indexedGltf("AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAEAAAD/////"), 0},
    {"GltfNotANumber", "m.gltf",
     indexedGltf("AADAfwAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAEAAAACAAAA"), 0},
    {"RelativeCorners", "m.obj", square("f -4 -3 -2\n"), 1},
    {"RelativeCornersBeforeTheFirst", "m.obj", square("f -4 -3 -5\n"), 0},
    {"CornerZero", "m.obj", square("f 0 1 2\n"), 0},
    {"CornerBeyondTheLast", "m.obj", square("f 1 2 5\n"), 0},
    {"HugeCorner", "m.obj", square("f 1 2 2147483647\n"), 0},
    {"HugerCorner", "m.obj", square("f 1 2 4294967297\n"), 0},
    {"DuplicateFaces", "m.obj", square("f 1 2 3\nf 2 3 1\nf 3 2 1\nf 1 2 3\n"), 2, 2},
    {"ZeroAreaFaces", "m.obj", square("f 1 1 2\nf 1 2 3\nf 3 3 3\n"), 1, 2},
    {"AllPointsEqual", "m.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", 0},
    {"AllPointsCollinear", "m.obj", "v 0 0 0\nv 1 1 1\nv 3 3 3\nf 1 2 3\n", 0},
    {"NotANumber", "m.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 0},
    {"Infinite", "m.obj", "v inf 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 0},
    {"TooLargeForAFloat", "m.obj", "v 1e50 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 0},
    {"MissingMaterials", "m.obj", square("mtllib no.mtl\nusemtl no\nf 1 2 3\n"), 1},
    {"EmptyDae", "m.dae", "", 0},
    {"EmptyObj", "m.obj", "", 0},
    {"EmptyStl", "m.stl", "", 0},
    {"EmptyGlb", "m.glb", "", 0},
    {"EmptyPly", "m.ply", "", 0},
    {"EmptyJdn", "m.jdn", "", 0},
    {"EmptyAc", "m.ac", "", 0},
    {"EmptyIfc", "m.ifc", "", 0},
    {"EmptyFbx", "m.fbx", "", 0},
    {"EmptyX3d", "m.x3d", "", 0},
    {"Empty3ds", "m.3ds", "", 0},
    {"Empty3mf", "m.3mf", "", 0},
    {"EmptyAmf", "m.amf", "", 0},
    {"EmptyAse", "m.ase", "", 0},
    {"EmptyBlend", "m.blend", "", 0},
    {"EmptyDxf", "m.dxf", "", 0},
    {"EmptyLwo", "m.lwo", "", 0},
    {"EmptyMd3", "m.md3", "", 0},
    {"EmptySmd", "m.smd", "", 0},
    {"EmptyX", "m.x", "", 0},
    {"EmptyZae", "m.zae", "", 0},
    {"FourBillionStlFaces", "m.stl", binaryStl(0xFFFFFFFF), 0},
    {"SixtyMillionStlFaces", "m.stl", binaryStl(60'000'000), 0},
    {"ThreeBillionGltfVertices", "m.gltf", gltf(R"([{"mesh":0}])", "3000000000", "36"), 0},
    {"ThreeGigabytesOfGltf", "m.gltf", gltf(R"([{"mesh":0}])", "3", "3000000000"), 0},
    {"NodeThatIsItsOwnChild", "m.gltf", gltf(R"([{"mesh":0,"children":[0]}])", "3", "36"), 0},
    {"NodesThatAreEachOthers", "m.gltf",
     gltf(R"([{"mesh":0,"children":[1]},{"children":[0]}])", "3", "36"), 0},
    {"MissingNode", "m.gltf", gltf(R"([{"children":[7]}])", "3", "36"), 0},
    {"DeepJson", "m.gltf", std::string(200000, '['), 0},
    {"ThreeGigabytesOfGlb", "m.glb", glb(), 0},
    {"ThreeBillionPlyVertices", "m.ply",
     "ply\nformat ascii 1.0\nelement vertex 3000000000\nproperty float x\nproperty float y\n"
     "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0",
     0},
    {"ThreeGigabytesOfBinaryPly", "m.ply",
     "ply\nformat binary_little_endian 1.0\nelement vertex 250000000\nproperty float x\n"
     "property float y\nproperty float z\nelement face 1\nproperty list uchar int "
     "vertex_indices\nend_header\n" +
         std::string(800, 'x'),
     0},
    {"PlyOfAHundredThousandProperties", "m.ply", plyHeader("property float a", 100000), 0},
    {"PlyOfAHundredThousandElements", "m.ply", plyHeader("element e 1000000000000000000", 100000),
     0},
    {"PlyOfOneLongLine", "m.ply", "ply\nformat ascii 1.0\ncomment " + std::string(1 << 22, 'x'), 0},
    {"PlyOfTwoFormats", "m.ply", "ply\nformat ascii 1.0\nformat ascii 1.0\nply\nend_header\n", 0},
    {"ThreeBillionOffVertices", "m.off", "OFF\n3000000000 1 0\n0 0 0\n", 0},
    {"ThreeBillionAcVertices", "m.ac",
     "AC3Db\nOBJECT world\nkids 1\nOBJECT poly\nnumvert 3000000000\n0 0 0\n", 0},
    {"EndlessAcChildren", "m.ac", "AC3Db\nOBJECT world\nkids 3000000000\nOBJECT world\nkids 9\n",
     0},
};

class BadMesh : public testing::TestWithParam<Case> {};

TEST_P(BadMesh, GivesAMessageOrACountedRepair) {
    const test::TemporaryFolder folder;
    const std::string path = folder.file(GetParam().file);
    test::writeFile(path, GetParam().content);
    const auto report = importMesh({path}, folder.file("m.eym"));
    if (GetParam().triangles == 0) {
        EXPECT_FALSE(report.ok());
        EXPECT_THAT(std::string(report.status().message()), HasSubstr(path));
        EXPECT_GT(report.status().message().size(), path.size() + 20);
        EXPECT_THAT(folder.names(), testing::ElementsAre(GetParam().file));
        return;
    }
    ASSERT_TRUE(report.ok()) << report.status();
    EXPECT_EQ(report->triangles, GetParam().triangles);
    EXPECT_EQ(report->droppedFaces + report->counts.degenerateTriangles +
                  report->counts.duplicateTriangles,
              GetParam().leftOut);
}

INSTANTIATE_TEST_SUITE_P(Kinds, BadMesh, testing::ValuesIn(kCases),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(BadMesh, ConcavePolygonsOfTenThousandCornersCoverTheirArea) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), polygon(10000, true));
    const auto mesh = readMesh(folder.file("m.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    const double area = 10000 / 2.0 * 1000 * 999 * std::sin(2 * 3.14159265358979 / 10000);
    EXPECT_NEAR(test::area(*mesh), area, 1e-4 * area);
}

TEST(BadMesh, MissingTexturesAreNotMissed) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.mtl"), "newmtl a\nKd 0 1 0\nmap_Kd no.png\n");
    test::writeFile(folder.file("m.obj"), square("mtllib m.mtl\nusemtl a\nf 1 2 3\n"));
    const auto mesh = readMesh(folder.file("m.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->colours.at(0), (fabric::Rgba{0, 255, 0, 255}));
}

/// Whole files that are cut off anywhere: a message or a mesh, nothing else.
TEST(BadMesh, CutOffAnywhereNeverBreaksTheReader) {
    const test::TemporaryFolder folder;
    const std::vector<std::pair<const char*, std::string>> whole = {
        {"m.obj", square("f 1 2 3\nf 1 3 4\n")},
        {"m.gltf", gltf(R"([{"mesh":0}])", "3", "36")},
        {"m.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
        {"m.ac",
         "AC3Db\nMATERIAL \"a\" rgb 1 0 0 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 0 trans 0\n"
         "OBJECT world\nkids 1\nOBJECT poly\nnumvert 3\n0 0 0\n1 0 0\n0 1 0\nnumsurf 1\n"
         "SURF 0x10\nmat 0\nrefs 3\n0 0 0\n1 0 0\n2 0 0\nkids 0\n"}};
    for (const auto& [name, text] : whole) {
        for (std::size_t length = 0; length <= text.size(); length += 1 + text.size() / 24) {
            test::writeFile(folder.file(name), text.substr(0, length));
            const auto mesh = readMesh(folder.file(name));
            EXPECT_TRUE(mesh.ok() || mesh.status().message().find(name) != std::string::npos)
                << length;
        }
    }
}

/// A soup of `triangles` that share nothing, side by side.
TriangleMesh apart(std::uint32_t triangles) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const double x = i % 200 * 2, y = i / 200 * 2;
        mesh.positions.insert(mesh.positions.end(), {{x, y, 0}, {x + 1, y, 0}, {x, y + 1, 0}});
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

// Hard cases 17 and 19: expected is what each mesh is made of, counted by hand, and bounds that the
// report itself states.
TEST(HardCase17, LeavesOf65535VerticesAndMore) {
    const test::TemporaryFolder folder;
    for (const std::uint32_t triangles : {21845U, 21846U}) {  // 65,535 and 65,538 vertices
        const auto report =
            importMesh(apart(triangles), folder.file("m.eym"), {.leafTriangles = 65535});
        ASSERT_TRUE(report.ok()) << report.status();
        const auto file = mesh::EymFile::open(folder.file("m.eym"));
        ASSERT_TRUE(file.ok()) << file.status();
        std::uint64_t drawn = 0;
        for (std::uint32_t i = 0; i < file->nodes().size(); ++i)
            if (file->nodes()[i].isLeaf()) {
                const auto geometry = file->geometry(i);
                ASSERT_TRUE(geometry.ok()) << geometry.status();
                EXPECT_LE(geometry->positions.size(), 65535U);
                drawn += geometry->indices.size() / 3;
            }
        EXPECT_EQ(drawn, triangles);
        EXPECT_EQ(file->nodes().size(), triangles == 21845 ? 1U : 3U);
    }
}

/// A strip of triangles over `vertices` points.
TriangleMesh strip(std::uint32_t vertices) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < vertices; ++i)
        mesh.positions.emplace_back(i / 2, i % 2, std::sin(i / 100.0));
    for (std::uint32_t i = 0; i + 2 < vertices; ++i)
        mesh.triangles.push_back({i, i + 1 + i % 2, i + 2 - i % 2});
    return mesh;
}

TEST(HardCase17, ALeafOfExactly65535VerticesIsOneAndOfOneMoreIsNone) {
    const test::TemporaryFolder folder;
    for (const std::uint32_t vertices : {65535U, 65536U}) {
        const auto report =
            importMesh(strip(vertices), folder.file("m.eym"), {.leafTriangles = 65535});
        ASSERT_TRUE(report.ok()) << report.status();
        EXPECT_EQ(report->triangles, vertices - 2);
        const auto file = mesh::EymFile::open(folder.file("m.eym"));
        ASSERT_TRUE(file.ok()) << file.status();
        EXPECT_EQ(file->nodes().size(), vertices == 65535 ? 1U : 3U);
        EXPECT_TRUE(file->geometry(static_cast<std::uint32_t>(file->nodes().size() - 1)).ok());
    }
}

TEST(HardCase17, AThousandTrianglesOnOneEdge) {
    const test::TemporaryFolder folder;
    TriangleMesh fan;
    fan.positions = {{0, 0, -1}, {0, 0, 1}};
    for (std::uint32_t i = 0; i < 1000; ++i) {
        fan.positions.emplace_back(std::cos(i / 159.0), std::sin(i / 159.0), 0);
        fan.triangles.push_back({0, 1, i + 2});
    }
    for (const NormalSource normals : {NormalSource::Smooth, NormalSource::Crease}) {
        const auto report =
            importMesh(fan, folder.file("m.eym"),
                       {.leafTriangles = 100, .pack = {.normals = normals, .orients = true}});
        ASSERT_TRUE(report.ok()) << report.status();
        EXPECT_EQ(report->triangles, 1000U);
        EXPECT_EQ(report->counts.orient.components, 1000U);
    }
}

TEST(HardCase17, AMedianOfEqualKeys) {
    const test::TemporaryFolder folder;
    TriangleMesh stack;  // a thousand triangles with one centre
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const double size = 1 + i;
        stack.positions.insert(stack.positions.end(),
                               {{size, 0, -size}, {-size, size, 0}, {0, -size, size}});
        stack.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const auto report = importMesh(stack, folder.file("m.eym"), {.leafTriangles = 10});
    ASSERT_TRUE(report.ok()) << report.status();
    EXPECT_EQ(report->triangles, 1000U);
    EXPECT_TRUE(mesh::EymFile::open(folder.file("m.eym")).ok());
}

TEST(HardCase17, DuplicateFlippedAndZeroAreaTrianglesAndIsolatedVertices) {
    TriangleMesh mesh = test::tetrahedron();
    const auto [a, b, c] = mesh.triangles[0];
    mesh.positions.emplace_back(5, 5, 5);
    mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {c, b, a}, {a, a, b}, {4, 4, 4}});
    PackCounts counts;
    const auto packed = packMesh(mesh, counts);
    ASSERT_TRUE(packed.ok()) << packed.status();
    EXPECT_EQ(packed->triangles.size(), 5U);  // both sides of the first face
    EXPECT_EQ(counts.duplicateTriangles, 1U);
    EXPECT_EQ(counts.degenerateTriangles, 2U);
    EXPECT_EQ(counts.isolatedVertices, 1U);
}

TEST(HardCase17, FacesWithoutExtentFarAwayDoNotCoarsenTheLattice) {
    TriangleMesh mesh = test::tetrahedron();
    PackCounts counts;
    const auto near = packMesh(mesh, counts);
    const auto far = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), 3, {1e12, 0, 0});
    mesh.triangles.insert(mesh.triangles.end(),
                          {{far, far, far}, {0, far, far}, {far, far + 1, far + 2}});
    const auto packed = packMesh(mesh, counts);
    ASSERT_TRUE(near.ok() && packed.ok()) << near.status() << packed.status();
    EXPECT_EQ(packed->lattice.stepMetres, near->lattice.stepMetres);
    EXPECT_EQ(packed->triangles, near->triangles);
    EXPECT_EQ(counts.degenerateTriangles, 3U);
    EXPECT_EQ(counts.isolatedVertices, 3U);
}

/// 5 cm in the coordinates of a country, of which single precision leaves one point.
TEST(HardCase19, AMeshOfWhichRoundingLeavesNothingIsRefusedForThat) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"),
                    "v 2600000.01 1200000.01 400\nv 2600000.06 1200000.01 400\n"
                    "v 2600000.01 1200000.06 400\nf 1 2 3\n");
    const auto report = importMesh({folder.file("m.obj")}, folder.file("m.eym"));
    EXPECT_EQ(report.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(report.status().message()),
                testing::AllOf(testing::HasSubstr("none with any area"),
                               testing::HasSubstr("coordinates are rounded, by up to 1."),
                               testing::HasSubstr("export the mesh nearer to 0")));
}

TEST(HardCase19, MicrometresBesideATerametreAreStoredWithinTheStatedError) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), "v 1e-6 0 0\nv 1e12 0 0\nv 0 1e12 1e-6\nf 1 2 3\n");
    const auto report = importMesh({folder.file("m.obj")}, folder.file("m.eym"));
    ASSERT_TRUE(report.ok()) << report.status();
    EXPECT_EQ(report->triangles, 1U);
    EXPECT_LE(report->errorMetres, 1e12 / (1 << 20));
    EXPECT_NEAR(mesh::EymFile::open(folder.file("m.eym"))->bounds().max.x, 1e12,
                report->errorMetres);
}

TEST(HardCase19, MicrometresBesideATerametreInDoublePrecisionAreWithinTheStatedError) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.ply"),
                    "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\n"
                    "property double y\nproperty double z\nelement face 1\n"
                    "property list uchar int vertex_indices\nend_header\n"
                    "1e-6 0 0\n999999999999 0 0\n0 1e12 1e-6\n3 0 1 2\n");
    const auto report =
        importMesh({folder.file("m.ply")}, folder.file("m.eym"), {.pack = {.keepsExact = true}});
    ASSERT_TRUE(report.ok()) << report.status();
    const auto file = mesh::EymFile::open(folder.file("m.eym"));
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_NEAR(file->bounds().max.x, 999999999999, report->errorMetres);
    const auto exact = file->exactPositions(0);
    ASSERT_TRUE(exact.ok()) << exact.status();
    EXPECT_THAT(*exact, testing::UnorderedElementsAre(fabric::Vec3(1e-6, 0, 0),
                                                      fabric::Vec3(999999999999, 0, 0),
                                                      fabric::Vec3(0, 1e12, 1e-6)));
}

TEST(HardCase19, DenormalsAreZeroBesideAnythingElse) {
    TriangleMesh mesh = test::tetrahedron();
    for (fabric::Vec3& position : mesh.positions) position += fabric::Vec3(5e-324, -1e-310, 0);
    PackCounts counts;
    const auto packed = packMesh(mesh, counts);
    ASSERT_TRUE(packed.ok()) << packed.status();
    EXPECT_EQ(packed->triangles.size(), 4U);
    for (fabric::Vec3& position : mesh.positions) position *= 1e-310;  // nothing but denormals
    EXPECT_TRUE(absl::IsInvalidArgument(packMesh(mesh, counts).status()));
}

}  // namespace
}  // namespace eyrie::import
