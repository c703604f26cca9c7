// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/ply_reader.h"

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "renderer/import/ply_writer.h"
#include "tests/renderer/import/ply_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using test::Encoding;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

constexpr std::array kEncodings = {Encoding::Ascii, Encoding::LittleEndian, Encoding::BigEndian};

TriangleMesh parsed(const std::string& text) {
    auto mesh = parsePly(text, "sample.ply");
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    return mesh.ok() ? *std::move(mesh) : TriangleMesh{};
}

/// A text PLY with three vertices and what follows them.
std::string withTriangle(const std::string& faceLines,
                         const std::string& face = "property list uchar int vertex_indices\n",
                         int faces = 1) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
           "property float z\nelement face " +
           std::to_string(faces) + "\n" + face + "end_header\n0 0 0\n1 0 0\n0 1 0\n" + faceLines;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

rc::Gen<TriangleMesh> meshes() {
    const auto scalar = rc::gen::map(rc::gen::inRange(-1000000, 1000000),
                                     [](int value) { return value / 1024.0 / 3.0; });
    const auto corner = rc::gen::inRange<std::uint32_t>(0, 5);
    const auto make = [](std::vector<fabric::Vec3> positions, Triangles triangles, bool extras) {
        TriangleMesh mesh;
        mesh.positions = std::move(positions);
        mesh.triangles = std::move(triangles);
        for (std::uint32_t i = 0; extras && i < mesh.positions.size(); ++i) {
            mesh.normals.emplace_back(mesh.positions[i]);
            mesh.colours.push_back({static_cast<std::uint8_t>(40 * i), 2, 255, 128});
        }
        return mesh;
    };
    return rc::gen::apply(make,
                          rc::gen::container<std::vector<fabric::Vec3>>(
                              5, rc::gen::construct<fabric::Vec3>(scalar, scalar, scalar)),
                          rc::gen::nonEmpty(rc::gen::container<Triangles>(
                              rc::gen::container<std::array<std::uint32_t, 3>>(corner))),
                          rc::gen::arbitrary<bool>());
}

RC_GTEST_PROP(PlyReader, ReadsTheSameMeshFromEveryEncoding, ()) {
    const TriangleMesh mesh = *meshes();
    for (const Encoding encoding : kEncodings) {
        auto read = parsePly(test::plyOf(mesh, encoding), "sample.ply");
        RC_ASSERT(read.ok());
        RC_ASSERT(read->notes.size() == (mesh.colours.empty() ? 0U : 1U));  // not opaque
        read->notes.clear();
        RC_ASSERT(*read == mesh);
    }
}

TEST(PlyReader, GivesBackWhatTheWriterWrote) {
    const test::TemporaryFolder folder;
    TriangleMesh mesh = test::tetrahedron();
    for (const double scale : {1.0, 0.1}) {  // float holds the first exactly
        for (fabric::Vec3& position : mesh.positions) position *= scale;
        ASSERT_TRUE(writePly(mesh, folder.file("m.ply")).ok());
        const auto read = readPly(folder.file("m.ply"));
        ASSERT_TRUE(read.ok()) << read.status();
        EXPECT_EQ(*read, mesh);
        mesh.normals.assign(4, {1, 2, 3});
        mesh.colours.assign(4, {1, 2, 3, 255});
    }
}

TEST(PlyReader, TakesPropertiesAndElementsInAnyOrderAndSkipsOthers) {
    const std::string head =
        "comment by hand\nobj_info none\nelement face 1\nproperty uchar flags\n"
        "property list uchar float uv\nproperty list int uint vertex_index\n"
        "element material 2\nproperty list ushort double values\nproperty short id\n"
        "element vertex 3\nproperty uchar blue\nproperty double z\nproperty list uchar char tags\n"
        "property float quality\nproperty double x\nproperty uchar red\nproperty double y\n"
        "property uchar green\nend_header\n";
    for (const Encoding encoding : kEncodings) {
        test::PlyBody body(encoding);
        body.add(std::uint8_t{9}).add(std::uint8_t{2}).add(0.5F).add(0.25F);
        body.add(std::int32_t{3}).add(2U).add(0U).add(1U).endLine();
        body.add(std::uint16_t{1}).add(3.0).add(std::int16_t{-7}).endLine();
        body.add(std::uint16_t{0}).add(std::int16_t{8}).endLine();
        for (std::uint8_t i = 0; i < 3; ++i)
            body.add(std::uint8_t{30})
                .add(3.0)
                .add(std::uint8_t{1})
                .add(std::int8_t{-1})
                .add(0.75F)
                .add(1.0 + i)
                .add(std::uint8_t{10})
                .add(2.0)
                .add(std::uint8_t{20})
                .endLine();
        const TriangleMesh mesh = parsed(test::formatLine(encoding) + head + body.bytes());
        EXPECT_EQ(mesh.positions, (std::vector<fabric::Vec3>{{1, 2, 3}, {2, 2, 3}, {3, 2, 3}}));
        EXPECT_EQ(mesh.triangles, (Triangles{{2, 0, 1}}));
        EXPECT_EQ(mesh.colours, std::vector<fabric::Rgba>(3, {10, 20, 30, 255}));
        EXPECT_TRUE(mesh.normals.empty());
    }
}

const std::string kFaces = "property list uchar int vertex_indices\n";
const std::string kTexturedFaces =
    kFaces + "property list uchar float texcoord\nproperty int texnumber\n";

/// With images of these names.
std::string naming(const std::string& text, const std::vector<std::string>& images) {
    std::string comments;
    for (const std::string& image : images) comments += "comment TextureFile " + image + "\n";
    return replaced(text, "element vertex", comments + "element vertex");
}

/// Vertices with coordinates of these names.
std::string withPlaces(const std::string& u, const std::string& v) {
    return replaced(
        replaced(withTriangle("3 0 1 2\n"), "property float z\n",
                 "property float z\nproperty float " + u + "\nproperty float " + v + "\n"),
        "0 0 0\n1 0 0\n0 1 0\n", "0 0 0 0 0\n1 0 0 1 0.25\n0 1 0 nan 1\n");
}

/// Material and place of a corner.
std::pair<int, glm::vec2> lookOf(const TriangleMesh& mesh, std::size_t triangle,
                                 std::size_t corner) {
    const std::uint32_t vertex = mesh.triangles.at(triangle).at(corner);
    return {mesh.materialOf.at(vertex), mesh.textureCoordinates.at(vertex)};
}

TEST(PlyReader, SaysWhatItLeavesOutOfALook) {
    EXPECT_THAT(parsed(withTriangle("3 0 1 2\n")).notes, testing::IsEmpty());
    EXPECT_THAT(parsed(naming(withTriangle("3 0 1 2\n"), {"a.png", "b.png"})).notes,
                testing::ElementsAre(testing::HasSubstr("2 textures: it has no texture coord")));
    const std::string coloured =
        withTriangle("3 0 1 2 255 0 0\n",
                     kFaces + "property uchar red\nproperty uchar green\nproperty uchar blue\n");
    EXPECT_THAT(parsed(coloured).notes,
                testing::ElementsAre(testing::HasSubstr("left out its colours of faces:")));
    for (const std::string& text :
         {withPlaces("s", "t"), withTriangle("3 0 1 2 0 0\n", kTexturedFaces)}) {
        const TriangleMesh mesh = parsed(text);
        EXPECT_THAT(mesh.notes, testing::ElementsAre(testing::HasSubstr("it names no image")));
        EXPECT_TRUE(mesh.materials.empty() && mesh.textureCoordinates.empty());
    }
}

TEST(PlyReader, SaysThatMoreFollowsThanItsHeaderCounts) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    for (const Encoding encoding : {Encoding::Ascii, Encoding::LittleEndian, Encoding::BigEndian}) {
        const std::string ply = plyOf(mesh, encoding);
        EXPECT_THAT(parsed(ply).notes, testing::IsEmpty());
        EXPECT_THAT(parsed(ply + "\r\n\n").notes, testing::IsEmpty());
        EXPECT_THAT(
            parsed(ply + "3 0 2 1\n").notes,
            testing::ElementsAre(testing::HasSubstr("bytes behind what its header counts")));
    }
}

TEST(PlyReader, LaysTheFirstImageByTheCoordinatesOfVertices) {
    for (const auto& [u, v] : {std::pair("s", "t"), {"u", "v"}, {"texture_u", "texture_v"}}) {
        const TriangleMesh mesh = parsed(naming(withPlaces(u, v), {"my wall.png", "b.png"}));
        ASSERT_EQ(mesh.textures.size(), 2U);
        EXPECT_EQ(mesh.textures[0].name, "my wall.png");
        EXPECT_EQ(mesh.materials.at(1),
                  (mesh::Material{.image = 0, .flags = kAlphaByImage | kReplacesColour}));
        EXPECT_EQ(mesh.positions.size(), 3U);
        EXPECT_EQ(mesh.colours, std::vector<fabric::Rgba>(3, {204, 204, 204, 255}));
        EXPECT_EQ(lookOf(mesh, 0, 0), std::pair(1, glm::vec2(0, 1))) << "v goes up in PLY";
        EXPECT_EQ(lookOf(mesh, 0, 1), std::pair(1, glm::vec2(1, 0.75F)));
        EXPECT_EQ(lookOf(mesh, 0, 2), std::pair(1, glm::vec2(0, 0)));
        EXPECT_THAT(mesh.notes,
                    testing::ElementsAre(testing::HasSubstr("1 texture coordinates are no fin")));
    }
}

TEST(PlyReader, SplitsVerticesWhereFacesHaveOtherPlacesOrImages) {
    // The first two share two vertices with their places; the third has one other place, the
    // fourth another image. A quad after them lies in the second image.
    const std::string faces =
        "3 0 1 2 6 0 0 1 0 0 1 0\n3 2 1 0 6 0 1 1 0 0 0 0\n3 0 1 2 6 0.5 0 1 0 0 1 0\n"
        "3 0 1 2 6 0 0 1 0 0 1 1\n4 0 1 2 1 8 0 0 1 0 0 1 1 0 1\n";
    const TriangleMesh mesh =
        parsed(naming(withTriangle(faces, kTexturedFaces, 5), {"a.png", "b.png"}));
    ASSERT_EQ(mesh.triangles.size(), 6U);
    EXPECT_EQ(mesh.positions.size(), 3U + 1U + 3U);
    EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
    EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{2, 1, 0}));
    EXPECT_EQ(mesh.triangles[2][1], 1U);
    EXPECT_EQ(lookOf(mesh, 2, 0), std::pair(1, glm::vec2(0.5F, 1)));
    EXPECT_EQ(mesh.positions[mesh.triangles[2][0]], mesh.positions[0]);
    for (std::size_t corner = 0; corner < 3; ++corner) {
        EXPECT_EQ(lookOf(mesh, 3, corner).first, 2);
        EXPECT_EQ(lookOf(mesh, 4, corner).first, 2);
    }
    EXPECT_THAT(mesh.notes, testing::IsEmpty());
}

TEST(PlyReader, SplitsVerticesByTheNumbersOfImagesAlone) {
    std::string text = replaced(withPlaces("s", "t"), "3 0 1 2\n", "3 0 1 2 0\n3 0 1 2 1\n");
    text =
        replaced(replaced(text, kFaces, kFaces + "property uchar texnumber\n"), "face 1", "face 2");
    const TriangleMesh mesh = parsed(naming(text, {"a.png", "b.png"}));
    EXPECT_EQ(mesh.positions.size(), 6U);
    EXPECT_EQ(lookOf(mesh, 0, 1), std::pair(1, glm::vec2(1, 0.75F)));
    EXPECT_EQ(lookOf(mesh, 1, 1), std::pair(2, glm::vec2(1, 0.75F)));
}

TEST(PlyReader, CountsFacesWhoseTextureFitsNothingAndLeavesThemPlain) {
    // Of a wrong length; none; a number without an image, twice; none by its number; not a number.
    const std::string faces =
        "3 0 1 2 4 0 0 1 0 0\n3 0 1 2 0 0\n3 0 1 2 6 0 0 1 0 0 1 1\n3 0 1 2 6 0 0 1 0 0 1 9\n"
        "3 0 1 2 6 0 0 1 0 0 1 -1\n3 0 1 2 6 nan 0 1 inf 0 1 0\n2 0 1 4 0 0 1 0 0\n";
    const TriangleMesh mesh = parsed(naming(withTriangle(faces, kTexturedFaces, 7), {"a.png"}));
    ASSERT_EQ(mesh.triangles.size(), 6U);
    for (std::size_t triangle = 0; triangle < 5; ++triangle)
        EXPECT_EQ(lookOf(mesh, triangle, 0).first, 0) << triangle;
    EXPECT_EQ(lookOf(mesh, 5, 0), std::pair(1, glm::vec2(0)));
    EXPECT_EQ(mesh.droppedFaces, 1U);
    EXPECT_THAT(
        mesh.notes,
        testing::ElementsAre(testing::AllOf(testing::StartsWith("1 faces have a texcoord"),
                                            testing::HasSubstr("face 0")),
                             testing::AllOf(testing::StartsWith("2 faces have a texnumber"),
                                            testing::HasSubstr("none of the 1 textures"),
                                            testing::HasSubstr("face 2")),
                             testing::StartsWith("2 texture coordinates are no finite numbers")));
}

TEST(PlyReader, NamesImagesAfterTheFileWhereItSaysSo) {
    const auto mesh = parsePly(naming(withPlaces("s", "t"), {"<this>_A.png"}), "scans/wall.ply");
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->textures.at(0).name, "wall_A.png");
}

TEST(PlyReader, TakesColoursOfEveryTypeAsBytes) {
    const auto colourOf = [](const std::string& type, const std::string& values) {
        const TriangleMesh mesh = parsed(
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
            "property float z\nproperty " +
            type + " diffuse_red\nproperty " + type + " diffuse_green\nproperty " + type +
            " diffuse_blue\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n0 0 0 " +
            values + "\n3 0 0 0\n");
        return mesh.colours.at(0);
    };
    EXPECT_EQ(colourOf("uchar", "0 127 255"), (fabric::Rgba{0, 127, 255, 255}));
    EXPECT_EQ(colourOf("float", "0 0.5 1"), (fabric::Rgba{0, 128, 255, 255}));
    EXPECT_EQ(colourOf("ushort", "0 32896 65535"), (fabric::Rgba{0, 128, 255, 255}));
    EXPECT_EQ(colourOf("float", "-1 nan 1e30"), (fabric::Rgba{0, 0, 255, 255}));
    EXPECT_EQ(colourOf("int", "-5 7 300"), (fabric::Rgba{0, 7, 255, 255}));
}

/// Two vertices, the second with the colour and what follows it.
std::string withColours(const std::string& first, const std::string& second, Encoding encoding,
                        const std::string& more = "") {
    test::PlyBody body(encoding);
    for (const std::string& vertex : {first, second}) {
        body.add(0.0F).add(0.0F).add(0.0F);
        std::istringstream values(vertex);
        for (float value = 0; values >> value;) body.add(value);
        body.endLine();
    }
    body.add(std::uint8_t{3}).add(0).add(0).add(1);
    return test::formatLine(encoding) +
           "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
           "property float red\nproperty float green\nproperty float blue\n" +
           more + "element face 1\n" + kFaces + "end_header\n" + body.bytes();
}

TEST(PlyReader, TakesRealColoursForBytesWhereOneIsFarAboveOneAndSaysSo) {
    for (const Encoding encoding : kEncodings) {
        const TriangleMesh bytes = parsed(withColours("0 1 2", "0 127.6 300", encoding));
        EXPECT_EQ(bytes.colours, (std::vector<fabric::Rgba>{{0, 1, 2, 255}, {0, 128, 255, 255}}));
        EXPECT_THAT(bytes.notes, testing::ElementsAre(testing::HasSubstr("numbers of 0 to 255")));
        const TriangleMesh fractions = parsed(withColours("0 1 2", "0 0.5 1.3", encoding));
        EXPECT_EQ(fractions.colours,
                  (std::vector<fabric::Rgba>{{0, 255, 255, 255}, {0, 128, 255, 255}}));
        EXPECT_THAT(fractions.notes, testing::IsEmpty());
    }
}

TEST(PlyReader, TakesColoursOf16BitsForBytesWhereNoneIsAboveThoseAndSaysSo) {
    const auto read = [](Encoding encoding, const std::vector<std::uint16_t>& values,
                         const std::string& colour = "ushort") {
        test::PlyBody body(encoding);
        body.add(0.0F).add(0.0F).add(0.0F);
        for (const std::uint16_t value : values) body.add(value);
        body.endLine().add(std::uint8_t{3}).add(0).add(0).add(0);
        return parsed(test::formatLine(encoding) +
                      "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                      "property " +
                      colour + " red\nproperty " + colour + " green\nproperty " + colour +
                      " blue\nproperty ushort alpha\nelement face 1\n" + kFaces + "end_header\n" +
                      body.bytes());
    };
    for (const Encoding encoding : kEncodings) {
        const TriangleMesh bytes = read(encoding, {255, 128, 0, 255});
        EXPECT_EQ(bytes.colours, (std::vector<fabric::Rgba>{{255, 128, 0, 255}}));
        EXPECT_THAT(bytes.notes, testing::ElementsAre(testing::HasSubstr("numbers of 0 to 255")));
        const TriangleMesh wide = read(encoding, {255, 32896, 257, 65535});
        EXPECT_EQ(wide.colours, (std::vector<fabric::Rgba>{{1, 128, 1, 255}}));
        EXPECT_THAT(wide.notes, testing::IsEmpty());
    }
    EXPECT_EQ(read(Encoding::Ascii, {100, 0, 0, 65535}).colours,
              (std::vector<fabric::Rgba>{{0, 0, 0, 255}}))
        << "an opacity of 16 bits says what the colours have";
    EXPECT_EQ(read(Encoding::Ascii, {1, 2, 3, 32896}, "uchar").colours,
              (std::vector<fabric::Rgba>{{1, 2, 3, 128}}));
}

TEST(PlyReader, CountsVerticesThatAreNotOpaque) {
    const std::string alpha = "property float alpha\n";
    const auto notesOf = [&](const std::string& first, const std::string& second) {
        return parsed(withColours(first, second, Encoding::Ascii, alpha)).notes;
    };
    EXPECT_THAT(notesOf("0 0 0 1", "1 1 1 255"), testing::IsEmpty());
    EXPECT_THAT(notesOf("0 0 0 0.5", "1 1 1 128"),
                testing::ElementsAre(testing::HasSubstr("2 vertices are not opaque, which is left "
                                                        "out: for see-through surfaces")));
    EXPECT_THAT(parsed(naming(withColours("0 0 0 1 0 0", "1 1 1 0 1 1", Encoding::Ascii,
                                          alpha + "property float s\nproperty float t\n"),
                              {"a.png"}))
                    .notes,
                testing::ElementsAre(testing::HasSubstr(
                    "1 vertices are not opaque, which is left out where no texture is see-th")));
}

TEST(PlyReader, TakesColoursByEachOfTheirNames) {
    for (const std::string names :
         {"red green blue", "diffuse_red diffuse_green diffuse_blue", "r g b"}) {
        std::istringstream each(names);
        std::string properties;
        for (std::string name; each >> name;) properties += "property uchar " + name + "\n";
        const TriangleMesh mesh = parsed(
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
            "property float z\n" +
            properties +
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1 2 3\n3 0 "
            "0 0\n");
        EXPECT_EQ(mesh.colours, (std::vector<fabric::Rgba>{{1, 2, 3, 255}})) << names;
    }
}

TEST(PlyReader, ReadsWindowsAndMacLineEnds) {
    const std::string text = withTriangle("3 0 1 2\n");
    for (const std::string end : {"\r\n", "\r"}) {
        std::string other;
        for (const char c : text) other += c == '\n' ? end : std::string(1, c);
        EXPECT_EQ(parsed(other), parsed(text));
    }
}

TEST(PlyReader, NeedsNoLineEndAfterTheLastValue) {
    EXPECT_EQ(parsed(withTriangle("3 0 1 2")).triangles, (Triangles{{0, 1, 2}}));
}

TEST(PlyReader, DropsAndCountsFacesOfFewerThanThreeCorners) {
    const TriangleMesh mesh = parsed(
        withTriangle("0\n3 0 1 2\n2 0 1\n1 0\n", "property list uchar int vertex_indices\n", 4));
    EXPECT_EQ(mesh.droppedFaces, 3U);
    EXPECT_EQ(mesh.triangles.size(), 1U);
}

TEST(PlyReader, TurnsEveryOtherTriangleOfAStripAndRestartsAtMinusOne) {
    std::string text = replaced(withTriangle("10 0 1 2 0 -1 2 1 -1 1 2\n"), "face", "tristrips");
    text = replaced(text, "list uchar", "list int");
    EXPECT_EQ(parsed(text).triangles, (Triangles{{0, 1, 2}, {2, 1, 0}}));
}

/// Four of 12 bytes and one list: its count, and six corners that at most are one triangle each.
TEST(PlyReader, TakesStripsForAsManyTrianglesAsTheyHaveRoomFor) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.ply"),
                    "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
                    "property float y\nproperty float z\nelement tristrips 1\n"
                    "property list int int vertex_indices\nend_header\n" +
                        std::string(4 * 12 + 4 + 6 * 4, '\0'));
    const auto size = measurePly(folder.file("m.ply"));
    ASSERT_TRUE(size.ok()) << size.status();
    EXPECT_EQ(size->faces, 6U);
}

TEST(PlyReader, CountsTheVerticesThatPlacesOfFacesMayMake) {
    const test::TemporaryFolder folder;
    const auto measured = [&](const std::string& comment) {
        test::writeFile(folder.file("m.ply"),
                        "ply\nformat ascii 1.0\n" + comment +
                            "element vertex 3\nproperty float x\nproperty float y\n"
                            "property float z\nelement face 2\n"
                            "property list uchar int vertex_indices\n"
                            "property list uchar float texcoord\nend_header\n"
                            "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1\n"
                            "3 0 2 1 6 1 1 0 1 1 0\n");
        return measurePly(folder.file("m.ply"));
    };
    EXPECT_EQ(measured("comment TextureFile a.png\n")->splitVertices, 6U);
    EXPECT_EQ(measured("comment TextureFile a.png\n")->vertices, 3U);
    EXPECT_EQ(measured("")->splitVertices, 3U);
}

TEST(PlyReader, StopsWhenAsked) {
    std::stop_source stop;
    stop.request_stop();
    const auto mesh = parsePly(withTriangle("3 0 1 2\n"), "m.ply", {{}, stop.get_token()});
    EXPECT_EQ(mesh.status().code(), absl::StatusCode::kCancelled);
}

struct Refused {
    std::string text;
    std::vector<std::string> says;  // besides the file's name
};

class PlyReaderRefuses : public testing::TestWithParam<Refused> {};

TEST_P(PlyReaderRefuses, SayingWhereAndWhat) {
    const auto mesh = parsePly(GetParam().text, "sample.ply");
    ASSERT_EQ(mesh.status().code(), absl::StatusCode::kInvalidArgument) << GetParam().text;
    const std::string message(mesh.status().message());
    EXPECT_THAT(message, testing::StartsWith("sample.ply: "));
    EXPECT_THAT(message, testing::HasSubstr("; "));  // the remedy
    for (const std::string& part : GetParam().says) EXPECT_THAT(message, testing::HasSubstr(part));
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

INSTANTIATE_TEST_SUITE_P(
    Headers, PlyReaderRefuses,
    testing::Values(
        Refused{"", {"empty", "expected a PLY header"}},
        Refused{"solid cube\n", {"first line", "'solid cube'", "'ply'"}},
        Refused{"\x1f\x8b\x08", {"compressed", "gunzip"}},
        Refused{"ply\nformat ascii 1.0\nelement vertex 8\n", {"line 3", "end_header", "truncated"}},
        Refused{replaced(withTriangle("3 0 1 2"), "ascii", "utf8"),
                {"line 2", "format", "'utf8'", "binary_little_endian"}},
        Refused{replaced(withTriangle("3 0 1 2"), "format ascii 1.0\n", ""), {"no format line"}},
        Refused{replaced(withTriangle("3 0 1 2"), "vertex 3", "vertex -3"),
                {"line 3", "count of element 'vertex'", "'-3'"}},
        Refused{replaced(withTriangle("3 0 1 2"), "vertex 3", "vertex 250000000"),
                {"count of element 'vertex'", "250000000", "bytes"}},
        Refused{replaced(withTriangle("3 0 1 2"), "face 1", "face 18446744073709551615"),
                {"count of element 'face'", "18446744073709551615"}},
        Refused{replaced(withTriangle("3 0 1 2"), "float y", "real y"), {"line 5", "'real'"}},
        Refused{replaced(withTriangle("3 0 1 2"), "uchar int", "float int"),
                {"list count type", "'float'", "integer"}},
        Refused{replaced(withTriangle("3 0 1 2"), "uchar int", "uchar float"),
                {"element face", "whole numbers"}},
        Refused{replaced(withTriangle("3 0 1 2"), "vertex 3", "vertex 0"),
                {"count of element vertex", "found 0", "expected 1 to"}},
        Refused{replaced(withTriangle("3 0 1 2"), "float y", "float v"),
                {"element vertex", "x, y and z"}},
        Refused{replaced(withTriangle("3 0 1 2"), "element vertex", "element point"),
                {"point (3)", "vertex"}},
        Refused{replaced(withTriangle("3 0 1 2"), "vertex_indices", "corners"),
                {"element face", "vertex_indices"}},
        Refused{replaced(withTriangle(""), "face 1", "face 0"),
                {"3 vertices", "zero faces", "point cloud"}},
        Refused{"ply\nformat ascii 1.0\nelement vertex 1\n" + kXyz + "end_header\n0 0 0\n",
                {"1 vertices", "zero faces", "elements: vertex (1)"}},
        Refused{"ply\nformat ascii 1.0\nproperty float x\nend_header\n", {"line 3", "element"}},
        Refused{"ply\nformat ascii 1.0\nelement vertex 99999999999999999999999\nend_header\n",
                {"line 3", "count"}}));

INSTANTIATE_TEST_SUITE_P(
    Bodies, PlyReaderRefuses,
    testing::Values(
        Refused{replaced(withTriangle("3 0 1 2"), "1 0 0", "1 nan 0"),
                {"vertex 1, y", "line 11", "found nan", "finite"}},
        Refused{replaced(withTriangle("3 0 1 2"), "0 1 0", "0 1 -inf"),
                {"vertex 2, z", "found -inf"}},
        Refused{replaced(withTriangle("3 0 1 2"), "1 0 0", "1e300 0 0"),
                {"vertex 1, x", "found inf"}},  // a float property cannot hold it
        Refused{replaced(withTriangle("3 0 1 2"), "1 0 0", "1 zero 0"),
                {"vertex 1, y", "'zero'", "number"}},
        Refused{withTriangle("3 0 1 3"), {"face 0, vertex_indices[2]", "found 3", "0 to 2"}},
        Refused{withTriangle("3 0 -1 2"), {"face 0, vertex_indices[1]", "found -1", "0 to 2"}},
        Refused{withTriangle("4 0 1 2 4294967296"), {"vertex_indices[3]", "found 4294967296"}},
        Refused{withTriangle("-1 0 1 2"), {"face 0, count of vertex_indices", "found -1"}},
        Refused{withTriangle("2000000000 0 1 2"),
                {"face 0, count of vertex_indices", "2000000000"}},
        Refused{withTriangle("3 0 1"),
                {"face 0, count of vertex_indices", "line 13", "found 3", "truncated"}},
        Refused{withTriangle("2 0 1"), {"three corners", "1 with fewer"}},
        Refused{naming(withTriangle("3 0 1 2 200 0 0", kTexturedFaces), {"a.png"}),
                {"face 0, count of texcoord", "found 200", "truncated"}},
        Refused{naming(withTriangle("3 0 1 2 2 0 u 0", kTexturedFaces), {"a.png"}),
                {"face 0, texcoord", "'u'", "number"}},
        Refused{withTriangle("3 0 1.5 2"), {"face 0, vertex_indices", "'1.5'"}}));

TEST(PlyReader, TellsABinaryFileThatEndsEarlyFromOneThatLies) {
    const std::string whole = test::plyOf(test::tetrahedron(), Encoding::LittleEndian);
    const auto early = parsePly(whole.substr(0, whole.size() - 1), "m.ply");
    EXPECT_THAT(std::string(early.status().message()),
                testing::AllOf(testing::HasSubstr("face 3"), testing::HasSubstr("truncated")));
    const auto lying = parsePly(whole.substr(0, whole.size() - 90), "m.ply");
    EXPECT_THAT(std::string(lying.status().message()),
                testing::AllOf(testing::HasSubstr("count of element 'vertex'"),
                               testing::HasSubstr("truncated")));
}

TEST(PlyReader, NamesTheFileItCannotOpen) {
    const auto mesh = readPly("/nowhere/bunny.ply");
    EXPECT_EQ(mesh.status().code(), absl::StatusCode::kNotFound);
    EXPECT_THAT(std::string(mesh.status().message()), testing::HasSubstr("/nowhere/bunny.ply"));
}

}  // namespace
}  // namespace eyrie::import
