// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_reader.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/gltf_chunks.h"
#include "renderer/import/obj_text.h"
#include "renderer/import/stl_text.h"
#include "tests/renderer/import/assimp_files.h"
#include "tests/renderer/import/mesh_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(AssimpReader, TakesMaterialsThatNobodyWouldSeeForOpaque) {
    const test::TemporaryFolder folder;
    std::string unseen = test::kAc3d;
    unseen.replace(unseen.find("trans 0"), 7, "trans 1");
    test::writeFile(folder.file("m.ac"), unseen);
    const auto mesh = readWithAssimp(folder.file("m.ac"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_THAT(mesh->notes, testing::Contains(HasSubstr("1 of 2 materials have no opacity")));
    for (const fabric::Rgba& colour : mesh->colours) EXPECT_EQ(colour.a, 255);
    for (const mesh::Material& material : mesh->materials) EXPECT_FALSE(material.isBlended());
}

TEST(AssimpReader, PutsObjectsAtTheirPlacesInTheColoursOfTheirMaterials) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.ac"), test::kAc3d);
    const auto mesh = readWithAssimp(folder.file("m.ac"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_EQ(mesh->triangles.size(), 3U);
    const std::vector<fabric::Vec3> square = {{1, -3, 2}, {2, -3, 2}, {2, -4, 2}, {1, -4, 2}};
    const std::vector<fabric::Vec3> triangle = {{10, 0, 0}, {11, 0, 0}, {10, 0, 1}};
    std::size_t reds = 0;
    for (std::size_t i = 0; i < mesh->positions.size(); ++i) {
        const bool isRed = mesh->colours[i] == fabric::Rgba{255, 0, 0, 255};
        reds += isRed ? 1 : 0;
        EXPECT_TRUE(isRed || mesh->colours[i] == (fabric::Rgba{128, 128, 128, 255}));
        EXPECT_THAT(isRed ? square : triangle, testing::Contains(mesh->positions[i]));
    }
    EXPECT_EQ(reds, 4U);
    EXPECT_THAT(mesh->notes, ElementsAre(HasSubstr("'loc'")));
}

TEST(AssimpReader, TakesTransformsInDoublePrecisionAndTurnsMirroredFaces) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.gltf"), test::kGltf);
    const auto mesh = readWithAssimp(folder.file("m.gltf"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_EQ(mesh->triangles.size(), 2U);
    for (const auto& [a, b, c] : mesh->triangles) {  // seen from -y, where z of the file points
        const auto normal = glm::cross(mesh->positions[b] - mesh->positions[a],
                                       mesh->positions[c] - mesh->positions[a]);
        EXPECT_EQ(normal, fabric::Vec3(0, -1, 0));
    }
    // In float the quarter would be gone: 1e6 has a spacing of 1/16.
    EXPECT_THAT(mesh->positions, testing::Contains(fabric::Vec3(999999.25, 0, 0)));
    for (const fabric::Rgba colour : mesh->colours)
        EXPECT_EQ(colour, (fabric::Rgba{128, 255, 0, 255}));
}

constexpr const char* kGltfWithABuffer =
    R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
"min":[0,0,0],"max":[1,1,0]}}],"bufferViews":[{{"buffer":0,"byteLength":36}}],
"buffers":[{{"byteLength":36,"uri":"{}"}}]}})";

TEST(AssimpReader, FindsBuffersOfAGltfByUriAndByPlainName) {
    const test::TemporaryFolder folder;
    std::string corners(36, '\0');
    corners.replace(14, 2, "\x80\x3F").replace(30, 2, "\x80\x3F");  // of 1, 0 and 0, 1
    for (const auto& [uri, file] : {std::pair("a%20%C3%A4.bin", "a \xC3\xA4.bin"),
                                    {"b c.bin", "b c.bin"},
                                    {"d%20e.bin", "d%20e.bin"},
                                    {"100%.bin", "100%.bin"}}) {
        test::writeFile(folder.file(file), corners);
        test::writeFile(folder.file("m.gltf"), fmt::format(kGltfWithABuffer, uri));
        const auto mesh = readWithAssimp(folder.file("m.gltf"));
        ASSERT_TRUE(mesh.ok()) << uri << ": " << mesh.status();
        EXPECT_NEAR(test::area(*mesh), 0.5, 1e-12) << uri;
    }
}

TEST(AssimpReader, CutsConcavePolygonsWithoutCoveringWhatIsOutside) {
    const test::TemporaryFolder folder;
    // An L of area 3 whose fan from the first corner would cover 5.
    test::writeFile(folder.file("m.obj"),
                    "v 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nf 1 2 3 4 5 6\n");
    const auto mesh = readWithAssimp(folder.file("m.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->triangles.size(), 4U);
    EXPECT_NEAR(test::area(*mesh), 3, 1e-12);
}

TEST(AssimpReader, MultipliesVertexColoursAndLeavesBlankOnesOut) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.mtl"), "newmtl half\nKd 0.5 1 1\n");
    test::writeFile(folder.file("m.obj"),
                    "mtllib m.mtl\nv 0 0 0 1 0.5 0\nv 1 0 0 1 0.5 0\nv 0 1 0 1 0.5 0\n"
                    "usemtl half\nf 1 2 3\n");
    const auto mesh = readWithAssimp(folder.file("m.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_FALSE(mesh->colours.empty());
    EXPECT_EQ(mesh->colours[0], (fabric::Rgba{128, 128, 0, 255}));
    test::writeFile(folder.file("plain.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_TRUE(readWithAssimp(folder.file("plain.obj"))->colours.empty());
}

/// What reading that text says.
std::vector<std::string> notesOfFile(const std::string& path, const std::string& text) {
    test::writeFile(path, text);
    const auto mesh = readWithAssimp(path);
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    return mesh.ok() ? mesh->notes : std::vector<std::string>();
}

TEST(AssimpReader, SaysWhereCoordinatesLoseWhatOneSees) {
    const test::TemporaryFolder folder;
    const auto notesAt = [&](double x, const std::string& name) {
        test::writeFile(folder.file(name),
                        fmt::format("OFF\n3 1 0\n{} 0 0\n{} 0 0\n{} 1 0\n3 0 1 2\n", x, x + 1, x));
        const auto mesh = readWithAssimp(folder.file(name));
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        return mesh.ok() ? mesh->notes : std::vector<std::string>();
    };
    EXPECT_THAT(notesAt(100, "m.off"), IsEmpty());
    EXPECT_THAT(notesAt(5e5, "m.off"),
                ElementsAre(testing::AllOf(HasSubstr("by up to 0.03 m"), HasSubstr("PLY"))));
}

/// A triangle that node 0 has, with what else is said of its mesh and node, and of the file.
std::string gltfOfATriangle(std::string_view ofMesh, std::string_view ofNode,
                            std::string_view rest) {
    const std::string zeros(400, 'A');  // places, joints and matrices: all 0
    return fmt::format(
        R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0, 1]}}],
"nodes": [{{"mesh": 0 {1}}}, {{}}], "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0,
"JOINTS_0": 1, "WEIGHTS_0": 2}}, "targets": [{{"POSITION": 0}}]}}] {0}}}], {2}
"buffers": [{{"byteLength": 300, "uri": "data:application/octet-stream;base64,{3}"}}],
"bufferViews": [{{"buffer": 0, "byteLength": 300}}],
"accessors": [
{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]}},
{{"bufferView": 0, "componentType": 5121, "count": 3, "type": "VEC4"}},
{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC4"}},
{{"bufferView": 0, "componentType": 5126, "count": 1, "type": "MAT4"}}]}})",
        ofMesh, ofNode, rest, zeros);
}

TEST(AssimpReader, SaysThatShapesAndSkeletonsAreLeftOut) {
    const test::TemporaryFolder folder;
    const auto notesOf = [&](const std::string& gltf) {
        return notesOfFile(folder.file("m.gltf"), gltf);
    };
    EXPECT_THAT(notesOf(gltfOfATriangle("", "", "")), IsEmpty());
    EXPECT_THAT(notesOf(gltfOfATriangle(R"(, "weights": [0])", "", "")), IsEmpty());
    EXPECT_THAT(notesOf(gltfOfATriangle(R"(, "weights": [0.5])", "", "")),
                ElementsAre(HasSubstr("morph targets of 1 of 1 meshes")));
    EXPECT_THAT(notesOf(gltfOfATriangle("", R"(, "weights": [0])", "")), IsEmpty());
    EXPECT_THAT(notesOf(gltfOfATriangle("", R"(, "weights": [0.5])", "")),
                ElementsAre(HasSubstr("weights of morph targets of 1 nodes")));
    EXPECT_THAT(
        notesOf(gltfOfATriangle("", R"(, "skin": 0)",
                                R"("skins": [{"joints": [1], "inverseBindMatrices": 3}],)")),
        ElementsAre(HasSubstr("skeletons of 1 of 1 meshes")));
}

TEST(AssimpReader, SaysWhatFilesLackThatWereCutOffOrAreReadInPart) {
    const test::TemporaryFolder folder;
    const auto notesOf = [&](const std::string& name, const std::string& text) {
        return notesOfFile(folder.file(name), text);
    };
    const std::string facet =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\n";
    EXPECT_THAT(notesOf("m.stl", "solid a\n" + facet + facet + "endsolid a\n"), IsEmpty());
    EXPECT_THAT(notesOf("m.stl", "solid a\n" + facet + facet),
                ElementsAre(HasSubstr("without 'endsolid'")));
    EXPECT_THAT(notesOf("m.stl", "solid a\n" + facet + "endsolid a\nsolid b\n" + facet),
                ElementsAre(HasSubstr("without 'endsolid'")));
    EXPECT_THAT(
        notesOf("m.stl", "solid a\n" + facet + "endsolid a\nsolid b\n" + facet + "endsolid b\n"),
        IsEmpty());

    const std::string face = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    EXPECT_THAT(notesOf("m.obj", face), IsEmpty());
    EXPECT_THAT(notesOf("m.obj", face + "cstype bezier\nsurf 0 1 0 1 1 2 3\nend\n"),
                ElementsAre(HasSubstr("left out 1 free-form surfaces")));
}

TEST(AssimpReader, ReadsTextStlInCapitalsAndBehindBlankLines) {
    const test::TemporaryFolder folder;
    const std::string facet =
        "facet normal 0 0 1\nouter loop\nvertex 5E-1 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\n";
    std::string capitals = facet;
    for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    for (const std::string& text :
         {"SOLID A\n" + capitals + "ENDSOLID A\n", "\r\n \nsolid A\r\n" + facet + "endsolid A\n",
          "\xef\xbb\xbf\nSolid A\n" + facet + "EndSolid A\n", "solid\n" + capitals + "endsolid\n",
          "solid A\n" + facet + "endsolid A\n"}) {
        test::writeFile(folder.file("m.stl"), text);
        const auto mesh = readWithAssimp(folder.file("m.stl"));
        ASSERT_TRUE(mesh.ok()) << text << mesh.status();
        ASSERT_EQ(mesh->triangles.size(), 1U) << text;
        EXPECT_EQ(mesh->positions[mesh->triangles[0][0]], fabric::Vec3(0.5, 0, 0)) << text;
        EXPECT_THAT(mesh->notes, IsEmpty()) << text;
    }
    EXPECT_THAT(notesOfFile(folder.file("m.stl"), "\nSOLID A\n" + capitals),
                ElementsAre(HasSubstr("without 'endsolid'")));
}

TEST(StlTextForAssimp, LeavesAsTheyAreFilesThatAreReadRightly) {
    EXPECT_FALSE(stlTextForAssimp("solid Of Names\nfacet normal 1E3 0 0\nendsolid Of Names"));
    EXPECT_FALSE(stlTextForAssimp("Solid" + std::string(79, '\0'))) << "binary";
    EXPECT_FALSE(stlTextForAssimp(""));
    EXPECT_FALSE(stlTextForAssimp(" \nsoli"));
}

TEST(AssimpReader, PassesPrimitivesOfGltfWithoutPositionsOver) {
    const test::TemporaryFolder folder;
    const auto gltfWith = [](const std::string& primitives) {
        std::string gltf = test::kGltf;
        return gltf.replace(gltf.find(R"({"attributes")"), 0, primitives);
    };
    test::writeFile(folder.file("m.gltf"),
                    gltfWith(R"({"attributes":{"NORMAL":0}},{"attributes":{}},{},)"));
    const auto mesh = readWithAssimp(folder.file("m.gltf"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->triangles.size(), 2U);
    EXPECT_THAT(mesh->notes, testing::Contains(HasSubstr("left out 3 of 4 parts of its meshes")));
    std::string none = gltfWith(R"({"attributes":{}}]},{"primitives":[)");
    test::writeFile(folder.file("m.gltf"), none.replace(none.rfind("\"mesh\":0"), 8, "\"mesh\":1"));
    const auto other = readWithAssimp(folder.file("m.gltf"));
    ASSERT_TRUE(other.ok()) << other.status();
    EXPECT_EQ(other->triangles.size(), 1U) << "of the second node's mesh";
}

TEST(AssimpReader, CountsMaterialsThatEmitMoreThanTheyReflect) {
    const test::TemporaryFolder folder;
    const auto notesWith = [&](const std::string& emitted) {
        std::string ac = test::kAc3d;
        ac.replace(ac.find("emis 0 0 0"), 10, "emis " + emitted);
        return notesOfFile(folder.file("m.ac"), ac);
    };
    EXPECT_THAT(notesWith("1 0 0"), ElementsAre(HasSubstr("'loc'")));
    EXPECT_THAT(notesWith("0.5 0.1 0"), testing::Contains(HasSubstr("the light of 1 of 2 materials "
                                                                    "that emit more")));
}

std::string chunkOf3ds(int id, const std::string& content) {
    const auto bytesOf = [](std::size_t value, int count) {
        std::string bytes;
        for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFF);
        return bytes;
    };
    return bytesOf(static_cast<std::size_t>(id), 2) + bytesOf(content.size() + 6, 4) + content;
}

/// A triangle without a material, whose last corner may be no vertex.
std::string threeDsOf(char lastCorner) {
    std::string vertices("\3\0", 2);
    for (const float value : {0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F})
        vertices.append(reinterpret_cast<const char*>(&value), sizeof value);
    std::string faces("\1\0\0\0\1\0\2\0\7\0", 10);
    faces[6] = lastCorner;
    const std::string mesh =
        chunkOf3ds(0x4100, chunkOf3ds(0x4110, vertices) + chunkOf3ds(0x4120, faces));
    return chunkOf3ds(0x4D4D, chunkOf3ds(0x3D3D, chunkOf3ds(0x4000, std::string("a\0", 2) + mesh)));
}

TEST(AssimpReader, Has3dsWithoutMaterialsPlainAndTellsOfCornersThatAreNoVertices) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.3ds"), threeDsOf(2));
    const auto mesh = readWithAssimp(folder.file("m.3ds"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->triangles.size(), 1U);
    EXPECT_THAT(mesh->colours, IsEmpty());
    EXPECT_THAT(mesh->notes, IsEmpty());
    EXPECT_THAT(notesOfFile(folder.file("m.3ds"), threeDsOf(9)),
                ElementsAre(HasSubstr("Vertex index overflow")));
}

/// A face that is put in once, turned by so many degrees, in a file that may be cut off.
std::string dxfOfABlock(int degrees, std::string_view end) {
    return fmt::format(
        "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n8\n0\n2\nB1\n70\n0\n10\n0\n20\n0\n30\n0\n0\n3DFACE\n8\n0"
        "\n"
        "10\n0\n20\n0\n30\n0\n11\n10\n21\n0\n31\n0\n12\n10\n22\n1\n32\n0\n13\n0\n23\n1\n33\n0\n0\n"
        "ENDBLK\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n0\nINSERT\n8\n0\n2\nB1\n10\n0\n20\n0\n30\n0\n"
        "50\n{}\n0\nENDSEC\n{}",
        degrees, end);
}

TEST(AssimpReader, SaysThatBlocksOfDxfAreNotTurned) {
    const test::TemporaryFolder folder;
    const auto notesOf = [&](const std::string& text) {
        return notesOfFile(folder.file("m.dxf"), text);
    };
    EXPECT_THAT(notesOf(dxfOfABlock(0, "0\nEOF\n")), IsEmpty());
    EXPECT_THAT(notesOf(dxfOfABlock(90, "0\nEOF\n")),
                ElementsAre(HasSubstr("1 blocks are not put as the file has them")));
    EXPECT_THAT(notesOf(dxfOfABlock(0, "")), ElementsAre(HasSubstr("did not encounter DXF EOF")));
}

/// A triangle that is put at 10, 5, 2 and at 20, 5, 2 and turned by such an angle.
std::string amfOfInstances(std::string_view angle) {
    std::string amf =
        "<?xml version=\"1.0\"?><amf unit=\"millimeter\"><object id=\"0\"><mesh><vertices>";
    for (const char* vertex : {"<x>0</x><y>0</y>", "<x>1</x><y>0</y>", "<x>0</x><y>1</y>"})
        amf += fmt::format("<vertex><coordinates>{}<z>0</z></coordinates></vertex>", vertex);
    amf +=
        "</vertices><volume><triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume></mesh>"
        "</object><constellation id=\"1\">";
    for (const int x : {10, 20})
        amf += fmt::format(
            "<instance objectid=\"0\"><deltax>{}</deltax><deltay>5</deltay><deltaz>2</deltaz>"
            "<rx>0</rx><ry>{}</ry><rz>\n{}</rz></instance>",
            x, angle, angle);
    return amf + "</constellation></amf>";
}

TEST(AssimpReader, PutsInstancesOfAmfAtTheirPlacesWhateverTheirAngles) {
    const test::TemporaryFolder folder;
    for (const std::string_view angle : {"0", "0.00", "90"}) {
        test::writeFile(folder.file("m.amf"), amfOfInstances(angle));
        const auto mesh = readWithAssimp(folder.file("m.amf"));
        ASSERT_TRUE(mesh.ok()) << mesh.status();
        EXPECT_THAT(mesh->positions,
                    testing::IsSupersetOf({fabric::Vec3(10, 5, 2), fabric::Vec3(20, 5, 2)}));
        EXPECT_THAT(
            mesh->notes,
            testing::Contains(HasSubstr("rotations of 2 instances")).Times(angle == "90" ? 1 : 0));
    }
}

/// Three triangles side by side, of two volumes, the second of which has so much of its own.
std::string amfOfVolumes(const std::string& object, const std::string& first,
                         const std::string& second) {
    std::string amf =
        "<?xml version=\"1.0\"?><amf><material id=\"7\"><color><r>0</r><g>0</g><b>1</b>"
        "</color></material><object id=\"0\">" +
        object + "<mesh><vertices>";
    for (int x = 0; x < 3; ++x)
        for (const char* y :
             {"<x>{0}.0</x><y>0</y>", "<x>{0}.5</x><y>0</y>", "<x>{0}.0</x><y>1</y>"})
            amf += fmt::format("<vertex><coordinates>{}<z>0</z></coordinates></vertex>",
                               fmt::format(fmt::runtime(y), x));
    return amf + "</vertices><volume>" + first +
           "<triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume> <volume/>\n<volume " +
           second +
           "<triangle><v1>3</v1><v2>4</v2><v3>5</v3></triangle><triangle><color><r>1</r><g>1</g>"
           "<b>0</b></color><v1>6</v1><v2>7</v2><v3>8</v3></triangle></volume></mesh></object></"
           "amf>";
}

TEST(AssimpReader, HasAllVolumesOfAnAmfMeshInTheirColours) {
    const test::TemporaryFolder folder;
    const std::string red = "<color><r>1</r><g>0</g><b>0</b></color>";
    const std::string green =
        "<metadata type=\"name\">b</metadata><color><r>0</r><g>1</g><b>0</b></color>";
    const auto coloursOf = [&](const std::string& amf) {
        test::writeFile(folder.file("m.amf"), amf);
        const auto mesh = readWithAssimp(folder.file("m.amf"));
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        std::vector<std::pair<double, fabric::Rgba>> colours;  // of the first corners, by their x
        for (const auto& [a, b, c] : mesh->triangles)
            colours.emplace_back(
                std::min({mesh->positions[a].x, mesh->positions[b].x, mesh->positions[c].x}),
                mesh->colours.at(a));
        std::ranges::sort(colours, {}, &std::pair<double, fabric::Rgba>::first);
        EXPECT_THAT(mesh->notes, IsEmpty());
        return colours;
    };
    const fabric::Rgba isRed{255, 0, 0, 255}, isGreen{0, 255, 0, 255}, isBlue{0, 0, 255, 255};
    const std::pair last{2.0, fabric::Rgba{255, 255, 0, 255}};
    EXPECT_THAT(coloursOf(amfOfVolumes("", red, ">" + green)),
                ElementsAre(std::pair(0.0, isRed), std::pair(1.0, isGreen), last));
    EXPECT_THAT(coloursOf(amfOfVolumes("", red, "materialid=\"7\">")),
                ElementsAre(std::pair(0.0, isRed), std::pair(1.0, isBlue), last));
    EXPECT_THAT(coloursOf(amfOfVolumes(red, green, ">")),
                ElementsAre(std::pair(0.0, isGreen), std::pair(1.0, isRed), last));
    EXPECT_THAT(
        coloursOf(amfOfVolumes("", red, ">")),
        ElementsAre(std::pair(0.0, isRed), std::pair(1.0, fabric::Rgba{255, 255, 255, 255}), last));
}

/// Of two triangles, the second of which may have a corner that is no vertex.
std::string gltfOfTwoTriangles(int lastCorner) {
    const std::string base64 =
        fmt::format("AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIAAAABAA{}A",
                    lastCorner == 2 ? "I" : "k");  // or 9
    const std::string primitive = R"({"attributes": {"POSITION": 0}, "indices": 1})";
    return fmt::format(
        R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
"nodes": [{{"mesh": 0}}], "meshes": [{{"primitives": [{0}, {0}]}}],
"buffers": [{{"byteLength": 48, "uri": "data:application/octet-stream;base64,{1}"}}],
"bufferViews": [{{"buffer": 0, "byteLength": 36}},
{{"buffer": 0, "byteOffset": 36, "byteLength": 12}}],
"accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
"min": [0, 0, 0], "max": [1, 1, 0]}},
{{"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}}]}})",
        primitive, base64);
}

TEST(AssimpReader, SaysWhatAssimpPassesOver) {
    const test::TemporaryFolder folder;
    const auto read = [&](int lastCorner) {
        test::writeFile(folder.file("m.gltf"), gltfOfTwoTriangles(lastCorner));
        const auto mesh = readWithAssimp(folder.file("m.gltf"));
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        return mesh.ok() ? *mesh : TriangleMesh{};
    };
    const TriangleMesh sound = read(2);
    EXPECT_EQ(sound.triangles.size(), 4U);
    EXPECT_THAT(sound.notes, IsEmpty());
    const TriangleMesh broken = read(9);
    EXPECT_EQ(broken.triangles.size(), 2U);
    EXPECT_THAT(broken.notes, ElementsAre(HasSubstr("out-of-range indices")));
}

TEST(AssimpReader, ReadsObjsWithIndentsCommentsAndNumbersThatBeginWithTheirPoint) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"),
                    "\xef\xbb\xbfv .5 0 0 # 1\r\n v 1 -.5 0\r\nv 0 1 .25\nv 9 9 9\n"
                    "usemtl #.5 .5\nf 1 2 3 # all\nf -4 -3 -2#");
    const auto mesh = readWithAssimp(folder.file("m.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    const std::vector<fabric::Vec3> expected = {{0.5, 0, 0}, {1, -0.5, 0}, {0, 1, 0.25}};
    ASSERT_EQ(mesh->triangles.size(), 2U);
    for (const auto& triangle : mesh->triangles)
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(mesh->positions[triangle[k]], expected[k]);
    test::writeFile(folder.file("m.obj"),
                    "v 1 2 3 .5 1 .5\nv 2 2 3 .5 1 .5\nv 1 3 3 .5 1 .5\nf 1 2 3\n");
    const auto coloured = readWithAssimp(folder.file("m.obj"));
    ASSERT_TRUE(coloured.ok()) << coloured.status();
    EXPECT_THAT(coloured->positions, testing::Contains(fabric::Vec3(1, 2, 3)));
    EXPECT_THAT(coloured->colours, testing::Each(fabric::Rgba{128, 255, 128, 255}));
}

/// The colour that the vertex at `x`, 0, 0 has in a file.
fabric::Rgba colourAt(const std::string& path, const std::string& text, double x) {
    test::writeFile(path, text);
    const auto mesh = readWithAssimp(path);
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    for (std::size_t i = 0; mesh.ok() && i < mesh->colours.size(); ++i)
        if (mesh->positions[i] == fabric::Vec3(x, 0, 0))
            return mesh->colours[i];
    ADD_FAILURE() << "no colour";
    return {};
}

TEST(AssimpReader, KeepsColoursOfVerticesThatHaveThemAmongOthersOfAnObj) {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("m.obj");
    for (const auto& [red, bytes] : {std::pair("1 .5 0", "0 1 0"), {"255 128 0", "0 128 0"}}) {
        const std::string obj = fmt::format(
            "v 0 0 0\nv 0 9 0# plain\nv 1 0 0 {}\nv 2 0 0 {}\nf 1 2 3\nf 1 2 4\n", red, bytes);
        EXPECT_EQ(colourAt(path, obj, 0), (fabric::Rgba{255, 255, 255, 255})) << red;
        EXPECT_EQ(colourAt(path, obj, 1), (fabric::Rgba{255, 128, 0, 255})) << red;
    }
}

TEST(AssimpReader, TakesColoursThatReachTo255AsSuch) {
    const test::TemporaryFolder folder;
    const auto objOf = [](const char* colour) {
        return fmt::format("v 1 0 0 0 64 0\nv 2 0 0 {0}\nv 0 9 0 {0}\nf 1 2 3\n", colour);
    };
    EXPECT_EQ(colourAt(folder.file("m.obj"), objOf("0 2 0"), 1), (fabric::Rgba{0, 64, 0, 255}));
    EXPECT_THAT(notesOfFile(folder.file("m.obj"), objOf("0 2 0")),
                ElementsAre(HasSubstr("numbers of 0 to 255")));
    const std::string bright = "v 1 0 0 1.02 .5 0\nv 2 0 0 1 1 1\nv 0 9 0 1 1 1\nf 1 2 3\n";
    EXPECT_EQ(colourAt(folder.file("m.obj"), bright, 1), (fabric::Rgba{255, 128, 0, 255}));
}

TEST(AssimpReader, PassesOverWhatPolygonsOfAnObjHaveNoUseFor) {
    const test::TemporaryFolder folder;
    const auto read = [&](const std::string& vertices) {
        test::writeFile(folder.file("m.obj"), vertices + "f 1 2 3\n");
        const auto mesh = readWithAssimp(folder.file("m.obj"));
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        return mesh.ok() ? *mesh : TriangleMesh{};
    };
    for (const char* weight : {"1", "2.5", "0", "-1 # heavy"})
        EXPECT_THAT(read(fmt::format("v 0 0 0\nv 2 0 0 {0}\nv 0 2 .5 {0}\n", weight)).positions,
                    ElementsAre(fabric::Vec3(0), fabric::Vec3(2, 0, 0), fabric::Vec3(0, 2, 0.5)));
    for (const char* more : {"1 5", "1 0 0 1 .5", "1 0 0 0 0 1 7"}) {
        const TriangleMesh mesh = read(fmt::format("v 0 0 0\nv 2 0 0 {0}\nv 0 2 0 {0}\n", more));
        EXPECT_EQ(mesh.positions.size(), 3U);
        EXPECT_THAT(mesh.colours, IsEmpty());
        EXPECT_THAT(mesh.notes, ElementsAre(HasSubstr("all but the places of 2 vertices")));
    }
}

/// Behind a weight of 1, and before an opacity.
TEST(AssimpReader, FindsTheColoursAmongSevenNumbersOfAnObjsVertices) {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("m.obj");
    const auto objOf = [](const char* numbers) {
        return fmt::format("v 1 0 0 {}\nv 2 0 0\nv 0 9 0 1 0 1 1\nf 1 2 3\n", numbers);
    };
    EXPECT_EQ(colourAt(path, objOf("1 0.5 0 0"), 1), (fabric::Rgba{128, 0, 0, 255}));
    EXPECT_EQ(colourAt(path, objOf("1 .5 0 1"), 1), (fabric::Rgba{255, 128, 0, 255}));
    EXPECT_EQ(colourAt(path, objOf("0 .5 1 0.2"), 1), (fabric::Rgba{0, 128, 255, 255}));
    EXPECT_EQ(colourAt(path, objOf("0 .5 1 0.2"), 2), (fabric::Rgba{255, 255, 255, 255}));
    EXPECT_THAT(notesOfFile(path, objOf("0 0.5 1 1")), IsEmpty());
    EXPECT_THAT(notesOfFile(path, objOf("0 0.5 1 0.2")),
                ElementsAre(HasSubstr("the opacity of 1 vertices")));
}

TEST(ObjForAssimp, LeavesAsTheyAreFilesThatAreReadRightly) {
    EXPECT_FALSE(objForAssimp("# .5\no a .5 # b\nv 0.5 -.5 1.\nvn 0 0 1\nf 1 2 3\n"));
    EXPECT_FALSE(objForAssimp(""));
    EXPECT_FALSE(objForAssimp("f 1 2\\\n 3\n")) << "which goes on";
    EXPECT_EQ(objForAssimp("v .5 .5 1\r\to .5\rvt .1 # .1\r"), "v 0.5 0.5 1\ro .5\rvt 0.1 \r");
    EXPECT_FALSE(objForAssimp("mtllib a b.MTL\nmtllib a.mtl\nmtllib c.x d.x\n"));
}

TEST(AssimpReader, SaysHowLongABinaryStlOughtToBe) {
    const test::TemporaryFolder folder;
    for (const std::string header : {"made by hand", "solid made by hand"}) {
        std::string file = header + std::string(84 + 2 * 50 - header.size(), '\0');
        file[80] = 2;
        file[84 + 26] = file[84 + 40] = '\x40';  // corners at 0 0 0, 2 0 0 and 0 2 0, and no others
        test::writeFile(folder.file("m.stl"), file);
        EXPECT_TRUE(readWithAssimp(folder.file("m.stl")).ok()) << header;
        test::writeFile(folder.file("m.stl"), file.substr(0, 150));
        EXPECT_THAT(std::string(readWithAssimp(folder.file("m.stl")).status().message()),
                    HasSubstr("m.stl: its header counts 2 triangles, which take 184 bytes, and it "
                              "has 150; it is cut off"))
            << header;
    }
}

/// The first facet is red, of its own; the second has the green of the part. Those with the highest
/// bit the other way around are MeshLab's.
TEST(AssimpReader, TakesColoursOfAnStlAsMaterialiseMeansThem) {
    const test::TemporaryFolder folder;
    for (const bool isMeshLab : {false, true}) {
        std::string file(84 + 2 * 50, '\0');
        file.replace(0, 6, "COLOR=");
        file[7] = file[9] = '\xFF';
        file[80] = 2;
        for (const std::size_t facet : {84U, 134U}) file[facet + 26] = file[facet + 40] = '\x40';
        file[84 + 48] = 31;
        file[isMeshLab ? 84 + 49 : 134 + 49] = '\x80';
        test::writeFile(folder.file("m.stl"), file);
        const auto mesh = readWithAssimp(folder.file("m.stl"));
        ASSERT_TRUE(mesh.ok()) << mesh.status();
        ASSERT_EQ(mesh->triangles.size(), 2U);
        EXPECT_EQ(mesh->colours[mesh->triangles[0][0]], (fabric::Rgba{255, 0, 0, 255}));
        EXPECT_EQ(mesh->colours[mesh->triangles[1][0]], (fabric::Rgba{0, 255, 0, 255}));
    }
}

TEST(AssimpReader, SaysWhatToDoWithFilesThatAreEmptyMisnamedOrLackBytesOfABuffer) {
    const test::TemporaryFolder folder;
    const auto expectRefused = [&](const std::string& name, const std::string& text,
                                   const std::string& why) {
        test::writeFile(folder.file(name), text);
        const absl::Status refused = readWithAssimp(folder.file(name)).status();
        EXPECT_TRUE(absl::IsInvalidArgument(refused)) << refused;
        EXPECT_EQ(std::string(refused.message()), folder.file(name) + ": " + why);
    };
    for (const char* name : {"m.ac", "m.gltf", "m.obj", "m.stl"})
        expectRefused(name, "", "is empty; copy it again, or export it again");
    const auto glb = glbOf(test::kGltf, {});
    ASSERT_TRUE(glb.ok()) << glb.status();
    expectRefused("m.gltf", *glb, "is a .glb file by what is in it; rename it so");
    expectRefused("m.glb", test::kGltf, "is a .gltf file by what is in it; rename it so");

    std::string outside = test::kGltf;
    const std::size_t data = outside.find("data:");
    outside.replace(data, outside.find('"', data) - data, "m%20a.bin");
    test::writeFile(folder.file("m a.bin"), std::string(35, '\0'));
    expectRefused("m.gltf", outside,
                  "found 35 bytes in its buffer 'm%20a.bin', expected 36; copy that file again, or "
                  "export the mesh again");
}

TEST(AssimpReader, TellsMissingFilesFromBadOnes) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(readWithAssimp(folder.file("no.obj")).status().code(), absl::StatusCode::kNotFound);
    test::writeFile(folder.file("m.3ds"), "this is no 3ds file at all");
    const auto bad = readWithAssimp(folder.file("m.3ds"));
    EXPECT_EQ(bad.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(bad.status().message()), HasSubstr(folder.file("m.3ds")));
}

}  // namespace
}  // namespace eyrie::import
