// SPDX-License-Identifier: Apache-2.0
// One solid in every format that a test can write: by Assimp's exporters, as text, as bytes. The
// others were tried with Assimp's own models (docs/benchmarks.md).
#include "renderer/import/assimp_formats.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <assimp/Exporter.hpp>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/assimp_reader.h"
#include "tests/renderer/import/assimp_files.h"
#include "tests/renderer/import/mesh_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

/// A tetrahedron with edges of 1, 2 and 3 along x, y and z from (10, 20, 30).
const std::vector<fabric::Vec3> kCorners = {{10, 20, 30}, {11, 20, 30}, {10, 22, 30}, {10, 20, 33}};
constexpr unsigned int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

/// The scene that Assimp's own exporters write. It owns all that it points to.
std::unique_ptr<aiScene> tetrahedron() {
    auto* mesh = new aiMesh;
    mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
    mesh->mNumVertices = 4;
    mesh->mVertices = new aiVector3D[4];
    for (unsigned int i = 0; i < 4; ++i)
        mesh->mVertices[i] =
            aiVector3D(static_cast<float>(kCorners[i].x), static_cast<float>(kCorners[i].y),
                       static_cast<float>(kCorners[i].z));
    mesh->mNumFaces = 4;
    mesh->mFaces = new aiFace[4];
    for (unsigned int i = 0; i < 4; ++i) {
        mesh->mFaces[i].mNumIndices = 3;
        mesh->mFaces[i].mIndices = new unsigned int[3];
        std::copy_n(kFaces[i], 3, mesh->mFaces[i].mIndices);
    }
    auto scene = std::make_unique<aiScene>();
    scene->mMetaData = new aiMetadata;
    scene->mNumMeshes = 1;
    scene->mMeshes = new aiMesh* [1] { mesh };
    scene->mNumMaterials = 1;
    scene->mMaterials = new aiMaterial* [1] { new aiMaterial };
    auto* node = new aiNode("t");
    node->mNumMeshes = 1;
    node->mMeshes = new unsigned int[1]{0};
    scene->mRootNode = new aiNode("root");
    scene->mRootNode->addChildren(1, &node);
    return scene;
}

/// What a file's reader makes of it, upright: all corners, and as many cubic units of inside.
void expectSolid(const std::string& path,
                 const std::function<fabric::Vec3(fabric::Vec3)>& upright) {
    const auto mesh = readWithAssimp(path);
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_EQ(mesh->triangles.size(), 4U);
    for (const fabric::Vec3& corner : kCorners)
        EXPECT_TRUE(std::ranges::any_of(
            mesh->positions,
            [&](const fabric::Vec3& p) { return glm::distance(p, upright(corner)) < 1e-5; }))
            << corner.x << ' ' << corner.y << ' ' << corner.z;
    EXPECT_NEAR(test::signedVolume(*mesh), 1, 1e-4);
}

fabric::Vec3 asItIs(fabric::Vec3 corner) { return corner; }
fabric::Vec3 fromYUp(fabric::Vec3 corner) { return {corner.x, -corner.z, corner.y}; }

struct Exported {
    const char* exporter;
    const char* extension;
    bool isWrittenAsItIs = false;  ///< not turned for the format's idea of up
};

class AssimpFormats : public testing::TestWithParam<Exported> {};

TEST_P(AssimpFormats, GiveTheSameSolidUpright) {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("t") + GetParam().extension;
    Assimp::Exporter exporter;
    ASSERT_EQ(exporter.Export(tetrahedron().get(), GetParam().exporter, path), AI_SUCCESS)
        << exporter.GetErrorString();
    const AssimpFormat* format = findAssimpFormat(path);
    ASSERT_NE(format, nullptr);
    expectSolid(path, format->isYUp && !GetParam().isWrittenAsItIs ? fromYUp : asItIs);
}

INSTANTIATE_TEST_SUITE_P(Exporters, AssimpFormats,
                         testing::Values(Exported{"obj", ".obj"}, Exported{"stl", ".stl"},
                                         Exported{"stlb", ".stl"}, Exported{"gltf2", ".gltf"},
                                         Exported{"glb2", ".glb"}, Exported{"collada", ".dae"},
                                         Exported{"3ds", ".3ds", true}, Exported{"x3d", ".x3d"},
                                         Exported{"x", ".x"}, Exported{"3mf", ".3mf"}),
                         [](const auto& test) { return std::string("As_") + test.param.exporter; });

/// The solid as FBX whose unit is so many centimetres.
void writeFbx(const std::string& path, float centimetres) {
    const std::unique_ptr<aiScene> scene = tetrahedron();
    scene->mMetaData->Add("UnitScaleFactor", centimetres);
    Assimp::Exporter exporter;
    ASSERT_EQ(exporter.Export(scene.get(), "fbxa", path), AI_SUCCESS) << exporter.GetErrorString();
}

TEST(FbxUnits, OfAMetreGiveTheSameSolidUpright) {
    const test::TemporaryFolder folder;
    writeFbx(folder.file("t.fbx"), 100);
    expectSolid(folder.file("t.fbx"), fromYUp);
    EXPECT_THAT(readWithAssimp(folder.file("t.fbx"))->notes, testing::IsEmpty());
}

TEST(FbxUnits, OfACentimetreAreBroughtToMetresAndSaidSo) {
    const test::TemporaryFolder folder;
    writeFbx(folder.file("t.fbx"), 1);
    const auto mesh = readWithAssimp(folder.file("t.fbx"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    for (const fabric::Vec3& corner : kCorners)
        EXPECT_TRUE(std::ranges::any_of(mesh->positions, [&](const fabric::Vec3& p) {
            return glm::distance(p, 0.01 * fromYUp(corner)) < 1e-7;
        }));
    EXPECT_NEAR(test::signedVolume(*mesh), 1e-6, 1e-10);
    EXPECT_THAT(mesh->notes, testing::ElementsAre(testing::HasSubstr("unit is 0.01 m")));
}

TEST(FbxUnits, ThatAreNoneAreTakenForMetresAloud) {
    const test::TemporaryFolder folder;
    writeFbx(folder.file("t.fbx"), -1);
    const auto mesh = readWithAssimp(folder.file("t.fbx"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_NEAR(test::signedVolume(*mesh), 1, 1e-4);
    EXPECT_THAT(mesh->notes, testing::ElementsAre(testing::HasSubstr("unit is -1 cm")));
}

/// A triangle as FBX whose axes to the right, up and to who looks from the front are those given.
std::string fbxWithAxes(std::string_view axes) {
    constexpr std::array<std::string_view, 6> kNames = {
        "CoordAxis", "CoordAxisSign", "UpAxis", "UpAxisSign", "FrontAxis", "FrontAxisSign"};
    std::string text =
        "; FBX 7.3.0 project file\nFBXHeaderExtension:  {\nFBXVersion: 7300\n}\n"
        "GlobalSettings:  {\nProperties70:  {\n"
        "P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",100\n";
    for (std::size_t i = 0; i < kNames.size(); ++i)
        text += fmt::format("P: \"{}\", \"int\", \"Integer\", \"\",{}\n", kNames[i],
                            i % 2 == 0       ? axes[i] - 'x'
                            : axes[i] == '-' ? -1
                                             : 1);
    return text +
           "}\n}\nObjects:  {\nGeometry: 10, \"Geometry::\", \"Mesh\" {\nVertices: *9 {\n"
           "a: 1,2,3,4,2,3,1,5,3\n}\nPolygonVertexIndex: *3 {\na: 0,1,-3\n}\n}\n"
           "Model: 11, \"Model::M\", \"Mesh\" {\n}\n}\n"
           "Connections:  {\nC: \"OO\",11,0\nC: \"OO\",10,11\n}\n";
}

TEST(FbxAxes, StandUprightAsTheFileSays) {
    const test::TemporaryFolder folder;
    const auto firstOf = [&](std::string_view axes) {
        test::writeFile(folder.file("t.fbx"), fbxWithAxes(axes));
        const auto mesh = readWithAssimp(folder.file("t.fbx"));
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        return mesh.ok() ? mesh->positions[mesh->triangles[0][0]] : fabric::Vec3(0);
    };
    EXPECT_EQ(firstOf("x+y+z+"), fabric::Vec3(1, -3, 2)) << "of Maya, and where nothing is said";
    EXPECT_EQ(firstOf("x+z+y-"), fabric::Vec3(1, 2, 3)) << "of 3ds Max";
    EXPECT_EQ(firstOf("z+x+y+"), fabric::Vec3(3, -2, 1));
    EXPECT_EQ(firstOf("x-y+z-"), fabric::Vec3(-1, 3, 2)) << "turned about what is up";
    EXPECT_EQ(firstOf("x+x+x+"), fabric::Vec3(1, -3, 2)) << "which are none";
}

/// `each` of every corner, one after another: `{0}` its number, `{1}`, `{2}`, `{3}` its place.
std::string corners(std::string_view each) {
    std::string text;
    for (std::size_t i = 0; i < kCorners.size(); ++i)
        text += fmt::format(fmt::runtime(each), i, kCorners[i].x, kCorners[i].y, kCorners[i].z);
    return text;
}

/// `each` of every face: `{0}` its number, `{1}`, `{2}`, `{3}` its corners'.
std::string faces(std::string_view each) {
    std::string text;
    for (std::size_t i = 0; i < std::size(kFaces); ++i)
        text += fmt::format(fmt::runtime(each), i, kFaces[i][0], kFaces[i][1], kFaces[i][2]);
    return text;
}

/// `each` of every corner of every face, with `begin` and `end` around each face.
std::string faceCorners(std::string_view begin, std::string_view each, std::string_view end) {
    std::string text;
    for (const auto& face : kFaces) {
        text += begin;
        for (std::size_t i = 0; i < 3; ++i) {
            const fabric::Vec3& place = kCorners[face[i]];
            text += fmt::format(fmt::runtime(each), i, place.x, place.y, place.z);
        }
        text += end;
    }
    return text;
}

/// Bytes of a file, of either order.
class Bytes {
public:
    explicit Bytes(std::endian order) : order_(order) {}

    Bytes& text(std::string_view text, std::size_t size = 0) {
        bytes_ += text;
        bytes_.append(size > text.size() ? size - text.size() : 0, '\0');
        return *this;
    }
    template <typename T>
    Bytes& number(T value) {
        std::array<char, sizeof(T)> raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
        if (order_ != std::endian::native)
            std::ranges::reverse(raw);
        bytes_.append(raw.data(), raw.size());
        return *this;
    }
    template <typename T, typename... Rest>
    Bytes& numbers(T value, Rest... rest) {
        number(value);
        if constexpr (sizeof...(rest) > 0)
            numbers(static_cast<T>(rest)...);
        return *this;
    }
    Bytes& place(const fabric::Vec3& place) {
        return numbers(static_cast<float>(place.x), place.y, place.z);
    }
    /// Four letters, the size and the content.
    Bytes& chunk(std::string_view name, const Bytes& content) {
        return text(name)
            .number(static_cast<std::uint32_t>(content.bytes_.size()))
            .text(content.bytes_)
            .text("", content.bytes_.size() % 2 * (order_ == std::endian::big ? 1 : 0));
    }
    const std::string& all() const { return bytes_; }

private:
    std::endian order_;
    std::string bytes_;
};

std::string amf() {
    return "<?xml version=\"1.0\"?><amf unit=\"meter\"><object id=\"1\"><mesh><vertices>" +
           corners("<vertex><coordinates><x>{1}</x><y>{2}</y><z>{3}</z></coordinates></vertex>") +
           "</vertices><volume>" +
           faces("<triangle><v1>{1}</v1><v2>{2}</v2><v3>{3}</v3></triangle>") +
           "</volume></mesh></object></amf>";
}

std::string ase() {
    return "*3DSMAX_ASCIIEXPORT\t200\n*GEOMOBJECT {\n*NODE_NAME \"t\"\n*NODE_TM {\n*NODE_NAME "
           "\"t\"\n*TM_ROW0 1 0 0\n*TM_ROW1 0 1 0\n*TM_ROW2 0 0 1\n*TM_ROW3 0 0 0\n}\n*MESH {\n"
           "*TIMEVALUE 0\n*MESH_NUMVERTEX 4\n*MESH_NUMFACES 4\n*MESH_VERTEX_LIST {\n" +
           corners("*MESH_VERTEX {0} {1} {2} {3}\n") + "}\n*MESH_FACE_LIST {\n" +
           faces(
               "*MESH_FACE {0}: A: {1} B: {2} C: {3} AB: 1 BC: 1 CA: 1 *MESH_SMOOTHING 1 "
               "*MESH_MTLID 0\n") +
           "}\n}\n}\n";
}

std::string dxf() {
    std::string text = "0\nSECTION\n2\nENTITIES\n";
    for (const auto& face : kFaces) {
        text += "0\n3DFACE\n8\n0\n";  // a triangle's fourth corner is its third
        for (std::size_t i = 0; i < 4; ++i) {
            const fabric::Vec3& p = kCorners[face[std::min<std::size_t>(i, 2)]];
            text += fmt::format("1{0}\n{1}\n2{0}\n{2}\n3{0}\n{3}\n", i, p.x, p.y, p.z);
        }
    }
    return text + "0\nENDSEC\n0\nEOF\n";
}

std::string md5mesh() {
    return "MD5Version 10\ncommandline \"\"\n\nnumJoints 1\nnumMeshes 1\n\njoints {\n\t\"origin\" "
           "-1 ( 0 0 0 ) ( 0 0 0 )\n}\n\nmesh {\n\tshader \"none\"\n\tnumverts 4\n" +
           corners("\tvert {0} ( 0 0 ) {0} 1\n") + "\tnumtris 4\n" +
           faces("\ttri {0} {1} {3} {2}\n")  // clockwise
           + "\tnumweights 4\n" + corners("\tweight {0} 0 1 ( {1} {2} {3} )\n") + "}\n";
}

std::string smd() {
    return "version 1\nnodes\n0 \"root\" -1\nend\nskeleton\ntime 0\n0 0 0 0 0 0 "
           "0\nend\ntriangles\n" +
           faceCorners("none\n", "0 {1} {2} {3} 0 0 1 0 0\n", "") + "end\n";
}

/// LightWave's hands are left ones: its z goes into the picture.
std::string lwo() {
    const auto big = [] { return Bytes(std::endian::big); };
    Bytes points = big(), polygons = big(), tags = big();
    for (const fabric::Vec3& corner : kCorners) points.place({corner.x, corner.y, -corner.z});
    polygons.text("FACE");
    tags.text("SURF");
    std::uint16_t polygon = 0;
    for (const auto& [a, b, c] : kFaces) {
        polygons.numbers(std::uint16_t{3}, c, b, a);
        tags.numbers(polygon++, 0);
    }
    Bytes form = big();
    form.text("LWO2")
        .chunk("TAGS", big().text("S", 2))
        .chunk("LAYR", big().numbers(std::uint16_t{0}, 0).numbers(0.0F, 0, 0).text("", 2))
        .chunk("PNTS", points)
        .chunk("POLS", polygons)
        .chunk("PTAG", tags)
        .chunk("SURF", big().text("S", 2).text("", 2));
    return big().chunk("FORM", form).all();
}

std::string ms3d() {
    Bytes file(std::endian::little);
    file.text("MS3D000000").number(std::int32_t{4});
    file.number(static_cast<std::uint16_t>(kCorners.size()));
    for (const fabric::Vec3& corner : kCorners)
        file.number(std::uint8_t{0}).place(corner).numbers(std::int8_t{-1}, 0);
    file.number(static_cast<std::uint16_t>(std::size(kFaces)));
    for (const auto& [a, b, c] : kFaces) {
        file.numbers(std::uint16_t{0}, a, b, c);
        for (int i = 0; i < 9 + 6; ++i) file.number(0.0F);  // normals and places in images
        file.numbers(std::uint8_t{1}, 0);
    }
    file.number(std::uint16_t{1}).number(std::uint8_t{0}).text("all", 32);
    file.numbers(std::uint16_t{4}, 0, 1, 2, 3).number(std::int8_t{-1});
    file.number(std::uint16_t{0}).numbers(24.0F, 0).number(std::int32_t{0});
    return file.number(std::uint16_t{0}).all();
}

/// Blitz3D's hands are left ones.
std::string b3d() {
    const auto little = [] { return Bytes(std::endian::little); };
    Bytes vertices = little(), triangles = little();
    vertices.numbers(std::int32_t{0}, 0, 0);
    for (const fabric::Vec3& corner : kCorners) vertices.place({corner.x, corner.y, -corner.z});
    triangles.number(std::int32_t{-1});
    for (const auto& [a, b, c] : kFaces) triangles.numbers(static_cast<std::int32_t>(c), b, a);
    Bytes mesh = little();
    mesh.number(std::int32_t{-1}).chunk("VRTS", vertices).chunk("TRIS", triangles);
    Bytes node = little();
    node.text("t", 2).numbers(0.0F, 0, 0).numbers(1.0F, 1, 1).numbers(1.0F, 0, 0, 0);
    node.chunk("MESH", mesh);
    Bytes file = little();
    file.number(std::int32_t{1}).chunk("NODE", node);
    return little().chunk("BB3D", file).all();
}

/// Quake III's: 64ths of a unit, faces clockwise.
std::string md3() {
    constexpr std::int32_t kHeader = 108, kFrame = 56, kSurface = 108;
    const auto little = [] { return Bytes(std::endian::little); };
    Bytes surface = little();
    constexpr std::int32_t kTriangles = kSurface, kShaders = kTriangles + 4 * 12,
                           kPlaces = kShaders + 68, kVertices = kPlaces + 4 * 8,
                           kEnd = kVertices + 4 * 8;
    surface.text("IDP3").text("t", 64).numbers(std::int32_t{0}, 1, 1, 4, 4);
    surface.numbers(kTriangles, kShaders, kPlaces, kVertices, kEnd);
    for (const auto& [a, b, c] : kFaces) surface.numbers(static_cast<std::int32_t>(c), b, a);
    surface.text("none", 64).number(std::int32_t{0});
    for (int i = 0; i < 8; ++i) surface.number(0.0F);
    for (const fabric::Vec3& corner : kCorners)
        surface.numbers(static_cast<std::int16_t>(64 * corner.x), 64 * corner.y, 64 * corner.z, 0);
    Bytes file = little();
    file.text("IDP3").number(std::int32_t{15}).text("t", 64).number(std::int32_t{0});
    file.numbers(std::int32_t{1}, 0, 1, 0);
    file.numbers(kHeader, kHeader + kFrame, kHeader + kFrame, kHeader + kFrame + kEnd);
    return file.text("", kFrame).text(surface.all()).all();
}

struct Written {
    const char* extension;
    std::string (*content)();
    fabric::Vec3 (*upright)(fabric::Vec3);
};

class WrittenFormats : public testing::TestWithParam<Written> {};

TEST_P(WrittenFormats, GiveTheSameSolidUpright) {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("t") + GetParam().extension;
    test::writeFile(path, GetParam().content());
    expectSolid(path, GetParam().upright);
}

INSTANTIATE_TEST_SUITE_P(
    Written, WrittenFormats,
    testing::Values(Written{".amf", amf, asItIs}, Written{".ase", ase, asItIs},
                    Written{".b3d", b3d, fromYUp}, Written{".dxf", dxf, asItIs},
                    Written{".lwo", lwo, fromYUp}, Written{".md3", md3, asItIs},
                    Written{".md5mesh", md5mesh, asItIs}, Written{".ms3d", ms3d, fromYUp},
                    Written{".smd", smd, asItIs}),
    [](const auto& test) { return std::string("As_") + (test.param.extension + 1); });

/// Where there are bones alone Assimp makes spikes of them, which nobody modelled.
TEST(WrittenFormats, OfBonesAloneHaveNoFace) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("t.smd"),
                    "version 1\nnodes\n0 \"root\" -1\n1 \"arm\" 0\nend\nskeleton\ntime 0\n"
                    "0 0 0 0 0 0 0\n1 1 2 3 0 0 0\nend\n");
    const auto mesh = readWithAssimp(folder.file("t.smd"));
    ASSERT_FALSE(mesh.ok());
    EXPECT_THAT(std::string(mesh.status().message()), testing::HasSubstr("found no face"));
}

/// Of which Assimp takes what there is.
TEST(WrittenFormats, SayThatTheyWereCutOff) {
    const test::TemporaryFolder folder;
    const auto notesOf = [&](const std::string& name, const std::string& content) {
        test::writeFile(folder.file(name), content);
        const auto mesh = readWithAssimp(folder.file(name));
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        return mesh.ok() ? mesh->notes : std::vector<std::string>();
    };
    const auto cut = [](const std::string& content, std::size_t by) {
        return content.substr(0, content.size() - by);
    };
    using testing::HasSubstr;
    EXPECT_THAT(notesOf("t.lwo", lwo()), testing::IsEmpty());
    EXPECT_THAT(notesOf("t.lwo", cut(lwo(), 12)),
                testing::ElementsAre(HasSubstr("says that it has 188 bytes, and it has 176")));
    EXPECT_THAT(notesOf("t.smd", smd()), testing::Not(testing::Contains(HasSubstr("EOF"))));
    EXPECT_THAT(notesOf("t.smd", cut(smd(), 10)), testing::Contains(HasSubstr("Unexpected EOF")));
    const std::string ac = test::kAc3d;
    EXPECT_THAT(notesOf("t.ac", ac.substr(0, ac.rfind("F 0x10"))),
                testing::Contains(HasSubstr("Unexpected EOF")));
    EXPECT_THAT(notesOf("t.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
                testing::Contains(HasSubstr("its header counts 2 faces, and it has 1")));
}

TEST(WrittenFormats, OfAmfWithoutColoursIsPlain) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("t.amf"), amf());
    const auto mesh = readWithAssimp(folder.file("t.amf"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_THAT(mesh->colours, testing::IsEmpty());
    EXPECT_THAT(mesh->notes, testing::IsEmpty());
}

}  // namespace
}  // namespace eyrie::import
