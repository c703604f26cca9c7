// SPDX-License-Identifier: Apache-2.0
// Which edges of an imported mesh stay sharp: those of its file's normals, or none.
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "renderer/import/mesh_import.h"
#include "tests/renderer/import/ply_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

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

}  // namespace
}  // namespace eyrie::import
