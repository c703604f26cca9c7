// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <bit>
#include <initializer_list>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/assimp_caveats.h"
#include "renderer/import/assimp_formats.h"
#include "renderer/import/assimp_reader.h"
#include "renderer/import/collada_text.h"
#include "renderer/import/x3d_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

/// Where textures lie by the formats that Assimp reads, each as its own specification has it. All
/// files are one triangle, whose corners are at 0, 0, at u = 1 and at v = 1 of the texture, v
/// upwards; what is expected is v downwards.
namespace eyrie::import {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TriangleMesh read(const std::string& name, const std::string& text) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file(name), text);
    auto mesh = readWithAssimp(folder.file(name));
    EXPECT_TRUE(mesh.ok()) << mesh.status() << text;
    return mesh.ok() ? *std::move(mesh) : TriangleMesh();
}

void expectPlaces(const TriangleMesh& mesh, const std::array<glm::vec2, 3>& expected) {
    ASSERT_EQ(mesh.triangles.size(), 1U);
    ASSERT_EQ(mesh.textures.size(), 1U);
    ASSERT_EQ(mesh.textureCoordinates.size(), 3U);
    for (int i = 0; i < 3; ++i) {
        const std::uint32_t corner = mesh.triangles[0][i];
        const glm::vec2 place = mesh.textureCoordinates[corner];
        EXPECT_TRUE(mesh.materials[mesh.materialOf[corner]].hasImage());
        EXPECT_LT(glm::distance(place, expected[i]), 1e-5F)
            << i << ": " << place.x << " " << place.y;
    }
}

constexpr std::array<glm::vec2, 3> kPlain = {glm::vec2{0, 1}, {1, 1}, {0, 0}};

std::string x3d(std::string_view image, std::string_view transform = "") {
    return fmt::format(
        R"(<?xml version="1.0"?><X3D profile="Interchange" version="3.3"><Scene><Shape>
<Appearance><Material diffuseColor="1 1 1"/><ImageTexture {}/>{}</Appearance>
<IndexedFaceSet coordIndex="0 1 2 -1" texCoordIndex="0 1 2 -1">
<Coordinate point="0 0 0 1 0 0 0 1 0"/><TextureCoordinate point="0 0 1 0 0 1"/>
</IndexedFaceSet></Shape></Scene></X3D>)",
        image, transform);
}

TEST(TexturesOfX3d, HaveTheFirstOfTheirNames) {
    for (const auto& [url, name] :
         {std::pair(R"(url='"wall.png"')", "wall.png"),
          {R"(url = '"a wall.png" "http://b.c/wall.png"')", "a%20wall.png"},
          {R"(url="&quot;wall.png&quot;, &quot;b.png&quot;")", "wall.png"},
          {R"(url="wall.png")", "wall.png"}}) {
        const TriangleMesh mesh = read("m.x3d", x3d(url));
        ASSERT_EQ(mesh.textures.size(), 1U) << url;
        EXPECT_EQ(mesh.textures[0].name, name);
    }
}

/// repeatS and repeatT are TRUE where nothing is said.
TEST(TexturesOfX3d, RepeatUnlessTheySayOtherwise) {
    for (const auto& [repeats, flags] :
         {std::pair("", 0U),
          {"repeatS='false'", mesh::kClampsU},
          {"repeatS='true' repeatT='false'", mesh::kClampsV},
          {"repeatS='false' repeatT='false'", mesh::kClampsU | mesh::kClampsV}}) {
        const TriangleMesh mesh = read("m.x3d", x3d(fmt::format("url='\"w.png\"' {}", repeats)));
        ASSERT_EQ(mesh.textures.size(), 1U) << repeats;
        EXPECT_EQ(mesh.textures[0].flags, flags) << repeats;
    }
}

/// Tc' = -C * S * R * C * T * Tc (ISO/IEC 19775-1, 18.4.8).
TEST(TexturesOfX3d, LieWhereTheirTransformsPutThem) {
    const auto at = [](std::string_view transform) {
        return read("m.x3d", x3d("url='\"w.png\"'", transform));
    };
    expectPlaces(at(""), kPlain);
    expectPlaces(at("<TextureTransform translation='0.25 0.5' scale='2 3'/>"),
                 {glm::vec2{0.5F, -0.5F}, {2.5F, -0.5F}, {0.5F, -3.5F}});
    expectPlaces(at("<TextureTransform rotation='1.5707963'/>"),
                 {glm::vec2{0, 1}, {0, 0}, {-1, 1}});
    expectPlaces(at("<TextureTransform center='0.5 0.5' scale='2 3'/>"),
                 {glm::vec2{0.5F, 0}, {2.5F, 0}, {0.5F, -3}});
    expectPlaces(at("<TextureTransform center='0.5, 0.25' scale='2 3' rotation='1.5707963' "
                    "translation='0.125 0'/>"),
                 {glm::vec2{-1, -0.625F}, {-1, -3.625F}, {-3, -0.625F}});
}

/// The texture is no matter, but the reader of X3D is the same.
TEST(NodesOfX3d, ThatAreNotReadAreNamed) {
    std::string text = x3d("url='\"w.png\"'");
    EXPECT_THAT(read("m.x3d", text).notes, IsEmpty());
    text.insert(text.find("<Shape>"), "<LOD range='1'><Group/></LOD><Anchor><Group/></Anchor>");
    EXPECT_THAT(read("m.x3d", text).notes,
                ElementsAre(HasSubstr("in nodes of the kinds Anchor, LOD,")));
    text.insert(text.find("<Shape>"), "<CADLayer\n><Group/></CADLayer>");
    EXPECT_THAT(read("m.x3d", text).notes,
                ElementsAre(HasSubstr("in nodes of the kinds Anchor, CADLayer, LOD,")));
}

TEST(NodesOfX3d, ThatAreShapesAndNotReadAreNamed) {
    std::string text = x3d("url='\"w.png\"'");
    text.insert(text.find("<Shape>"),
                "<Shape><QuadSet/></Shape><Shape><NurbsPatchSurface\tuClosed='true'/></Shape>");
    EXPECT_THAT(read("m.x3d", text).notes,
                ElementsAre(HasSubstr("shapes of the kinds NurbsPatchSurface, QuadSet,")));
}

TEST(NodesOfX3d, ThatAreStripsAreReadAsThoseWithIndices) {
    const auto meshOf = [](std::string_view kind, std::string_view strips) {
        return read("m.x3d",
                    fmt::format("<?xml version='1.0'?><X3D version='3.0'><Scene><Shape><{0} {1}>"
                                "<Coordinate point='0 0 0 1 0 0 0 1 0 1 1 0 5 0 0 6 0 0 5 1 0'/>"
                                "<Color color='1 0 0 0 1 0 0 0 1 1 1 1 1 0 0 0 1 0 0 0 1'/>"
                                "</{0}></Shape></Scene></X3D>",
                                kind, strips));
    };
    const TriangleMesh mesh = meshOf("TriangleStripSet", "solid='false' stripCount='4, 3'");
    const TriangleMesh indexed =
        meshOf("IndexedTriangleStripSet", "solid='false' index='0 1 2 3 -1 4 5 6 -1'");
    EXPECT_EQ(mesh.triangles.size(), 3U);
    EXPECT_EQ(mesh.positions, indexed.positions);
    EXPECT_EQ(mesh.triangles, indexed.triangles);
    EXPECT_EQ(mesh.colours, indexed.colours);
    EXPECT_LT(x3dForAssimp("<TriangleStripSet stripCount='4 4000000000'>").size(), 100U);
}

TEST(ColoursOfX3d, OfFacesAreToldOf) {
    constexpr const char* kOfCorners = "colorIndex='0 1 0 -1 1 0 1 -1'";
    constexpr const char* kOfFaces = "colorPerVertex = 'false' colorIndex='0 1'";
    for (const auto& [set, count] : {std::pair(kOfCorners, 0), {kOfFaces, 1}}) {
        const std::string shape = fmt::format(
            "<Shape><IndexedFaceSet {} coordIndex='0 1 2 -1 1 3 2 -1'>"
            "<Coordinate point='0 0 0 1 0 0 0 1 0 1 1 0'/>",
            set);
        const std::string end = "</IndexedFaceSet></Shape></Scene></X3D>";
        const std::string begin = "<?xml version='1.0'?><X3D version='3.0'><Scene>";
        EXPECT_THAT(read("m.x3d", begin + shape + end).notes, IsEmpty()) << set;
        EXPECT_THAT(read("m.x3d", begin + shape + "<Color color='1 0 0 0 0 1'/>" + end).notes,
                    testing::Contains(HasSubstr("colours of faces of 1 shapes")).Times(count))
            << set;
    }
}

/// Of a square of which the second half is behind a comma, with such colours in such a material.
TriangleMesh squareOfX3d(std::string_view material, std::string_view colours) {
    return read("m.x3d", fmt::format("<?xml version='1.0'?><X3D version='3.0'><Scene><!-- it's 1,2 "
                                     "--><Transform translation='1,2,3'><Shape><Appearance>"
                                     "<Material {}/></Appearance>"
                                     "<IndexedFaceSet coordIndex='0 1 2 -1,0,2,3,-1'>"
                                     "<Coordinate point=\"0 0 0,1 0 0,1 1 0,0,1,0\"/>{}"
                                     "</IndexedFaceSet></Shape></Transform></Scene></X3D>",
                                     material, colours));
}

TEST(NumbersOfX3d, MayHaveCommasBetweenThem) {
    const TriangleMesh mesh = squareOfX3d("diffuseColor='1,0,0'", "");
    EXPECT_EQ(mesh.triangles.size(), 2U);
    EXPECT_THAT(mesh.positions, testing::Contains(fabric::Vec3(2, -3, 3)));
    EXPECT_THAT(mesh.colours, testing::Each(fabric::Rgba{255, 0, 0, 255}));
}

TEST(ColoursOfX3d, OfVerticesStandForThoseOfMaterials) {
    const TriangleMesh mesh = squareOfX3d("diffuseColor='1 0 0' transparency='0.6'",
                                          "<Color color='0 1 1, 0 1 1, 0 1 1, 0 1 1'/>");
    EXPECT_THAT(mesh.colours, testing::SizeIs(4));
    EXPECT_THAT(mesh.colours, testing::Each(fabric::Rgba{0, 255, 255, 102}));
}

TEST(X3dText, StaysWhereThereIsNothingToMend) {
    for (const std::string_view text :
         {"", "<X3D/>", "<ImageTexture", "<ImageTexture url='", "<ImageTexture url='\"\"'/>",
          "<ImageTexture url=''/>", "<TextureTransform scale='2 2'/>",
          "<TextureTransform center='1 1' scale='0 1'/>", "<!-- it's <a b='1,2'/> --><c/>",
          "<![CDATA[ <a b='1,2'/>", "<meta content='1, two'/>", "<a b='1 2'/>, <c/>"})
        EXPECT_EQ(x3dForAssimp(text), text);
}

/// As the loader that AC3D's author gives away has it: offset + place * repeat.
TEST(TexturesOfAc3d, AreRepeatedAndThenShifted) {
    expectPlaces(
        read("m.ac",
             "AC3Db\nMATERIAL \"\" rgb 1 1 1 amb 1 1 1 emis 0 0 0 spec 0 0 0 shi 1 trans 0\n"
             "OBJECT world\nkids 1\nOBJECT poly\ntexture \"w.png\"\ntexrep 2 4\n"
             "texoff 0.25 0.5\nnumvert 3\n0 0 0\n1 0 0\n0 0 1\nnumsurf 1\nSURF 0x10\n"
             "mat 0\nrefs 3\n0 0 0\n1 1 0\n2 0 1\nkids 0\n"),
        {glm::vec2{0.25F, 0.5F}, {2.25F, 0.5F}, {0.25F, -3.5F}});
}

constexpr const char* kFbx = R"(; FBX 7.3.0 project file
FBXHeaderExtension:  {{
FBXVersion: 7300
}}
Objects:  {{
Geometry: 10, "Geometry::", "Mesh" {{
Vertices: *9 {{
a: 0,0,0,1,0,0,0,1,0
}}
PolygonVertexIndex: *3 {{
a: 0,1,-3
}}
LayerElementUV: 0 {{
Name: "UV"
MappingInformationType: "ByPolygonVertex"
ReferenceInformationType: "Direct"
UV: *6 {{
a: 0,0,1,0,0,1
}}
}}
LayerElementMaterial: 0 {{
MappingInformationType: "AllSame"
ReferenceInformationType: "IndexToDirect"
Materials: *1 {{
a: 0
}}
}}
Layer: 0 {{
LayerElement:  {{
Type: "LayerElementUV"
TypedIndex: 0
}}
LayerElement:  {{
Type: "LayerElementMaterial"
TypedIndex: 0
}}
}}
}}
Model: 11, "Model::M", "Mesh" {{
}}
Material: 12, "Material::m", "" {{
ShadingModel: "lambert"
}}
Texture: 13, "Texture::t", "" {{
Type: "TextureVideoClip"
FileName: "w.png"
RelativeFilename: "w.png"
Properties70:  {{
P: "Rotation", "Vector3D", "Vector", "",0,0,{}
}}
}}
}}
Connections:  {{
C: "OO",11,0
C: "OO",10,11
C: "OO",12,11
C: "OP",13,12, "DiffuseColor"
}}
)";

/// Half a turn, which is the same in both directions.
TEST(TexturesOfFbx, AreTurnedByDegrees) {
    expectPlaces(read("m.fbx", fmt::format(kFbx, 0)), kPlain);
    expectPlaces(read("m.fbx", fmt::format(kFbx, 180)), {glm::vec2{0, 1}, {-1, 1}, {0, 2}});
}

/// As Maya and 3ds Max write their physical materials.
TEST(TexturesOfFbx, MayBeOfABaseColour) {
    for (const std::string_view name :
         {"Maya|baseColor", "Maya|TEX_color_map", "3dsMax|Parameters|base_color_map"}) {
        SCOPED_TRACE(name);
        std::string text = fmt::format(kFbx, 180);
        const std::string_view diffuse = "DiffuseColor";
        text.replace(text.find(diffuse), diffuse.size(), name);
        const TriangleMesh mesh = read("m.fbx", text);
        expectPlaces(mesh, {glm::vec2{0, 1}, {-1, 1}, {0, 2}});
        EXPECT_THAT(mesh.notes, ElementsAre(HasSubstr("brought to metres")));
    }
}

/// Of two sets of coordinates, numbered as given, the second has u and v exchanged.
std::string collada(std::string_view texcoord, std::string_view binding, int first, int second) {
    return fmt::format(
        R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<library_images><image id="i"><init_from>w.png</init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON>
<newparam sid="s"><surface type="2D"><init_from>i</init_from></surface></newparam>
<newparam sid="sm"><sampler2D><source>s</source></sampler2D></newparam>
<technique sid="c"><lambert><diffuse><texture texture="sm" texcoord="{}"/></diffuse></lambert>
</technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<source id="u"><float_array id="ua" count="6">0 0 1 0 0 1</float_array><technique_common>
<accessor source="#ua" count="3" stride="2"><param name="S" type="float"/>
<param name="T" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1" material="mm"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="TEXCOORD" source="#u" offset="1" set="{}"/>
{}<p>0 0 0 1 1 2 2 2 1</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="vs"><node id="n"><instance_geometry url="#g">
<bind_material><technique_common><instance_material symbol="mm" target="#m">{}
</instance_material></technique_common></bind_material></instance_geometry></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#vs"/></scene></COLLADA>)",
        texcoord, first,
        fmt::format(R"(<input semantic="TEXCOORD" source="#u" offset="2" set="{}"/>)", second),
        binding);
}

std::string bound(int set) {
    return fmt::format(
        R"(<bind_vertex_input semantic="CHANNEL1" input_semantic="TEXCOORD" input_set="{}"/>)",
        set);
}

/// "CHANNEL1" is what 3ds Max calls the first.
TEST(TexturesOfCollada, LieByTheCoordinatesThatTheirNamesAreBoundTo) {
    constexpr std::array<glm::vec2, 3> kSecond = {glm::vec2{0, 1}, {0, 0}, {1, 1}};
    expectPlaces(read("m.dae", collada("CHANNEL1", bound(0), 0, 1)), kPlain);
    expectPlaces(read("m.dae", collada("CHANNEL1", bound(1), 0, 1)), kSecond);
    expectPlaces(read("m.dae", collada("CHANNEL1", bound(1), 1, 2)), kPlain);
    expectPlaces(read("m.dae", collada("CHANNEL1", bound(2), 1, 2)), kSecond);
    expectPlaces(read("m.dae", collada("UV0", "", 0, 1)), kPlain);
    const TriangleMesh guessed = read("m.dae", collada("CHANNEL7", "", 0, 1));
    expectPlaces(guessed, kPlain);
    EXPECT_THAT(guessed.notes, IsEmpty());
}

TEST(TexturesOfCollada, AreSaidToRepeatWhereTheyOughtNot) {
    std::string text = collada("UV0", "", 0, 1);
    EXPECT_THAT(read("m.dae", text).notes, IsEmpty());
    text.insert(text.find("</sampler2D>"), "<wrap_s>WRAP</wrap_s><wrap_t>CLAMP</wrap_t>");
    EXPECT_THAT(read("m.dae", text).notes, ElementsAre(HasSubstr("CLAMP of wrap_s or wrap_t")));
}

/// A chunk of a 3DS file: its number, its length and what it holds.
std::string chunk(int number, const std::string& content) {
    const std::size_t size = content.size() + 6;
    std::string header = {static_cast<char>(number & 0xFF), static_cast<char>(number >> 8)};
    for (int shift = 0; shift < 32; shift += 8) header += static_cast<char>((size >> shift) & 0xFF);
    return header + content;
}

std::string floats(std::initializer_list<float> values) {
    std::string bytes;
    for (const float value : values) {
        const auto own = std::bit_cast<std::array<char, 4>>(value);
        bytes.append(own.data(), own.size());
    }
    return bytes;
}

/// A texture map with flags for how it is tiled: 2 to be mirrored, 16 not to be.
std::string tiled3ds(char flags) {
    const std::string texture =
        chunk(0xA300, std::string("w.png\0", 6)) + chunk(0xA351, {flags, '\0'});
    const std::string material =
        chunk(0xAFFF, chunk(0xA000, std::string("m\0", 2)) + chunk(0xA200, texture));
    const std::string faces =
        std::string("\1\0\0\0\1\0\2\0\7\0", 10) + chunk(0x4130, std::string("m\0\1\0\0\0", 6));
    const std::string mesh =
        chunk(0x4110, std::string("\3\0", 2) + floats({0, 0, 0, 1, 0, 0, 0, 1, 0})) +
        chunk(0x4140, std::string("\3\0", 2) + floats({0, 0, 1, 0, 0, 1})) + chunk(0x4120, faces);
    const std::string object = chunk(0x4000, std::string("o\0", 2) + chunk(0x4100, mesh));
    return chunk(0x4D4D, chunk(0x3D3D, material + object));
}

TEST(TexturesOf3ds, EndAtTheirEdgesWhereTheyAreNotTiled) {
    const TriangleMesh tiled = read("m.3ds", tiled3ds(0));
    expectPlaces(tiled, kPlain);
    EXPECT_EQ(tiled.textures[0].flags, 0U);
    EXPECT_THAT(tiled.notes, IsEmpty());
    const TriangleMesh decal = read("m.3ds", tiled3ds(16));
    expectPlaces(decal, kPlain);
    EXPECT_EQ(decal.textures[0].flags, mesh::kClampsU | mesh::kClampsV);
    EXPECT_THAT(decal.notes, ElementsAre(HasSubstr("ought to leave free")));
}

TEST(TexturesOfCollada, ThatIsPackedMayLieWrong) {
    EXPECT_THAT(caveats({}, *findAssimpFormat("m.zae")),
                ElementsAre(HasSubstr("<bind_vertex_input>")));
}

TEST(ColladaText, StaysWhereNothingIsBound) {
    for (const std::string_view text :
         {"", "<texture texture='a' texcoord='b1'/>", "<texture ", "<bind_vertex_input ",
          "<texture texcoord='b1'/><bind_vertex_input semantic='b1' input_set='3' "
          "input_semantic='TEXCOORD'/><input semantic='TEXCOORD' set='0'/>"})
        EXPECT_EQ(colladaForAssimp(text), text);
}

TEST(AssimpMaterials, SayWhatHasATextureButNoPlaceOnIt) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.mtl"), "newmtl wall\nmap_Kd w.png\n");
    test::writeFile(folder.file("m.obj"),
                    "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl wall\nf 1 2 3\n");
    const auto mesh = readWithAssimp(folder.file("m.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_THAT(mesh->notes, ElementsAre(HasSubstr("left out the textures of 1 of 1 meshes")));
}

}  // namespace
}  // namespace eyrie::import
