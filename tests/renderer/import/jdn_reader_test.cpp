// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/jdn_reader.h"

#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace eyrie::import {
namespace {

using testing::HasSubstr;

/// Two objects, of which the second has no normals and a material that is not there.
std::string sample() {
    return "Number of Materials = 1\n"
           "Material Name = roof\n"
           "Ambient = 0.05 0.05 0.06\n"
           "Diffuse =\t0.6 0.5  1.5\n"
           "Specular = 0.9 0.9 0.9\n"
           "Shine = 0.25\nShine Strength = 0.05\nTransparency = 0\n"
           "Material ID = 7\n"
           "Map Path = textures\\roof.jpg\n"
           "Number of Lights = 1\n"
           "Pos = -54 455 0\nDirection = 0 0 0\nColour = 1 1 1\nIntensity = 1\nFall = 45\nType = "
           "2\n"
           "Number of Objects = 2\n"
           "Material ID = 7\n"
           "Num   Vertices = 4\r\nNum Faces = 2\nNum textured vertices = 1\n"
           "Vert = 44.9 92.9 0\nVert = 1 0 0\nVert=0 1 0\nVert = 0 0 1e0\n"
           "Face = 0 1 2\nFace = 0 2 3\n"
           "Textured Vert = 0 0 0\nTextured Face = 0 0 0\nTextured Face = 0 0 0\n"
           "Face Normal = 0 0 1\nFace Normal = 0 0 1\n"
           "Vert Normal = 0 0 1\nVert Normal = 0 0 1\nVert Normal = 0 0 1\nVert Normal = 0 0 1\n"
           "Wind = strong\n"
           "Material ID = 8\n"
           "Num Vertices = 3\nNum Faces = 1\nNum textured vertices = 0\n"
           "Vert = 5 0 0\nVert = 6 0 0\nVert = 5 1 0\nFace = 2 1 0\n";
}

/// An object of so many vertices, a triangle for each, and as many textured vertices.
std::string large(int vertices) {
    const std::string count = std::to_string(vertices) + '\n';
    std::string text =
        "Number of Materials = 0\nNumber of Lights = 0\nNumber of Objects = 1\nMaterial ID = 0\n"
        "Num Vertices = " +
        count + "Num Faces = " + count + "Num textured vertices = " + count;
    for (int i = 0; i < vertices; ++i) text += " Vert = 0 0 0\n";
    for (int i = 0; i < vertices; ++i) text += "Face = 0 1 2\n";
    for (int i = 0; i < vertices; ++i) text += "Textured  Vert = 0 0 0\n";
    for (int i = 0; i < vertices; ++i) text += "Textured Face = 0 1 2\n";
    return text;
}

std::string messageOf(const std::string& text) {
    const auto mesh = parseJdn(text, "s.jdn");
    EXPECT_EQ(mesh.status().code(), absl::StatusCode::kInvalidArgument);
    return std::string(mesh.status().message());
}

std::string with(const std::string& old, const std::string& now) {
    std::string text = sample();
    EXPECT_NE(text.find(old), std::string::npos);
    return text.replace(text.find(old), old.size(), now);
}

TEST(JdnReader, RefusesASceneThatTakesMoreMemoryThanItMayAndSaysHowMuch) {
    constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;
    const std::string text = large(20'000);
    ASSERT_LT(text.size(), 2 * kMebibyte);
    const auto refused = parseJdn(text, "s.jdn", {}, 4 * kMebibyte);
    EXPECT_EQ(refused.status().code(), absl::StatusCode::kResourceExhausted);
    EXPECT_THAT(std::string(refused.status().message()),
                testing::AllOf(HasSubstr("s.jdn: reading it takes about 7 MiB"),
                               HasSubstr("may use 4"), HasSubstr("allow more memory")));
    EXPECT_TRUE(parseJdn(text, "s.jdn", {}, 7 * kMebibyte).ok());
    EXPECT_TRUE(parseJdn(text, "s.jdn").ok());
}

TEST(JdnReader, JoinsObjectsAndGivesThemTheirMaterials) {
    const auto mesh = parseJdn(sample(), "s.jdn");
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->positions.size(), 7U);
    EXPECT_EQ(mesh->positions[0], fabric::Vec3(44.9, 92.9, 0));
    const std::array<std::uint32_t, 3> last = {6, 5, 4};
    ASSERT_EQ(mesh->triangles.size(), 3U);
    EXPECT_EQ(mesh->triangles[2], last);
    EXPECT_EQ(mesh->colours[0], (fabric::Rgba{153, 128, 255, 255}));
    EXPECT_EQ(mesh->colours[4], (fabric::Rgba{204, 204, 204, 255}));
    EXPECT_EQ(mesh->normals[3], glm::vec3(0, 0, 1));
    EXPECT_EQ(mesh->normals[4], glm::vec3(0));
}

/// A corner with other texture coordinates is another vertex, whatever Assimp's v, with v down.
TEST(JdnReader, GivesCornersTheirTextureCoordinates) {
    std::string text = with("Textured Vert = 0 0 0\nTextured Face = 0 0 0\nTextured Face = 0 0 0\n",
                            "Textured Vert = 0.5 0.25 0\nTextured Vert = 3 1 0\n"
                            "Textured Face = 0 1 0\nTextured Face = 1 0 1\n");
    text.replace(text.find("textured vertices = 1"), 21, "textured vertices = 2");
    text.replace(text.find("Transparency = 0"), 16, "Transparency = 0.4");
    const auto mesh = parseJdn(text, "s.jdn");
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_EQ(mesh->textures.size(), 1U);
    EXPECT_EQ(mesh->textures[0].name, "textures\\roof.jpg");
    ASSERT_EQ(mesh->positions.size(), 8U);  // the first corner is there twice
    ASSERT_EQ(mesh->materialOf.size(), 8U);
    const auto placeOf = [&](std::size_t triangle, std::size_t corner) {
        return mesh->textureCoordinates[mesh->triangles[triangle][corner]];
    };
    EXPECT_EQ(placeOf(0, 0), glm::vec2(0.5F, 0.75F));
    EXPECT_EQ(placeOf(0, 1), glm::vec2(3, 0));
    EXPECT_EQ(placeOf(1, 0), glm::vec2(3, 0));
    EXPECT_EQ(mesh->positions[mesh->triangles[1][0]], mesh->positions[mesh->triangles[0][0]]);
    const mesh::Material& material = mesh->materials[mesh->materialOf[0]];
    EXPECT_EQ(material.image, 0);
    EXPECT_TRUE(material.isBlended());
    EXPECT_EQ(mesh->colours[0], (fabric::Rgba{153, 128, 255, 153}));
    EXPECT_EQ(mesh->materials[mesh->materialOf[6]], mesh::Material());
}

TEST(JdnReader, RefusesTextureCoordinatesThatAreNotThere) {
    EXPECT_THAT(messageOf(with("Textured Face = 0 0 0", "Textured Face = 0 1 0")),
                HasSubstr("found 1, expected a vertex from 0 to 0"));
    EXPECT_THAT(messageOf(with("Textured Face = 0 0 0\n", "")),
                HasSubstr("found 1 lines Textured Face, expected 2"));
}

TEST(JdnReader, HasTheLights) {
    const auto mesh = parseJdn(sample(), "s.jdn");
    ASSERT_TRUE(mesh.ok());
    EXPECT_THAT(mesh->lights.distant, testing::IsEmpty());
    EXPECT_THAT(mesh->lights.points, testing::ElementsAre(fabric::PointLight{
                                         {-54, 455, 0}, {1, 1, 1}, fabric::kMostReachMetres}));

    const auto distant = parseJdn(with("Type = 2", "Type = 1"), "s.jdn");
    ASSERT_TRUE(distant.ok() && distant->lights.distant.size() == 1);
    const fabric::Vec3 toOrigin = glm::normalize(fabric::Vec3(54, -455, 0));
    EXPECT_LT(glm::distance(distant->lights.distant[0].direction, toOrigin), 1e-12);

    std::string text = with("Intensity = 1", "Intensity = 0.5");
    const std::string direction = "Direction = 0 0 0";
    text.replace(text.find("Type = 2"), 8, "Type = 1");
    text.replace(text.find(direction), direction.size(), "Direction = 0 0 -3");
    const auto directed = parseJdn(text, "s.jdn");
    ASSERT_TRUE(directed.ok());
    EXPECT_THAT(directed->lights.distant,
                testing::ElementsAre(fabric::DirectionalLight{{0, 0, -1}, {0.5, 0.5, 0.5}}));
}

TEST(JdnReader, CountsLightsThatAreNone) {
    const auto notesOf = [](const std::string& text) {
        const auto mesh = parseJdn(text, "s.jdn");
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        return mesh->notes;
    };
    using testing::Contains;
    EXPECT_THAT(notesOf(with("Pos = -54", "Pos = nan")), Contains(HasSubstr("left out 1 of 1")));
    EXPECT_THAT(notesOf(with("Colour = 1 1 1", "Colour = red")),
                Contains(HasSubstr("left out 1 of 1")));
    EXPECT_THAT(notesOf(with("Type = 2", "Type = 3")), Contains(HasSubstr("neither 1 nor 2")));
    EXPECT_THAT(notesOf(with("Lights = 1", "Lights = 2")),
                Contains(HasSubstr("found 1 lights, expected 2")));
}

TEST(JdnReader, CountsWhatItDoesNotKnow) {
    const auto mesh = parseJdn(sample(), "s.jdn");
    ASSERT_TRUE(mesh.ok());
    EXPECT_THAT(mesh->notes, testing::ElementsAre(HasSubstr("1 lines with unknown keys, the first "
                                                            "'Wind' in line 38"),
                                                  HasSubstr("1 objects have a material")));
}

TEST(JdnReader, CountsObjectsThatNobodySees) {
    const auto mesh = parseJdn(with("Transparency = 0", "Transparency = 1"), "s.jdn");
    ASSERT_TRUE(mesh.ok());
    EXPECT_EQ(mesh->colours[0].a, 0);
    EXPECT_THAT(mesh->notes, testing::Contains(HasSubstr("1 of 2 objects are not seen")));
    const auto veil = parseJdn(with("Transparency = 0", "Transparency = 0.99"), "s.jdn");
    ASSERT_TRUE(veil.ok());
    EXPECT_THAT(veil->notes, testing::Not(testing::Contains(HasSubstr("not seen"))));
}

TEST(JdnReader, KnowsItsKindByTheFirstLine) {
    EXPECT_TRUE(looksLikeJdn(sample()));
    EXPECT_TRUE(looksLikeJdn("  Number  of Materials=3"));
    EXPECT_FALSE(looksLikeJdn("ply\nformat ascii 1.0\n"));
    EXPECT_FALSE(looksLikeJdn(""));
}

struct Damage {
    const char* name;
    const char* old;
    const char* now;
    const char* says;
};

class JdnDamage : public testing::TestWithParam<Damage> {};

TEST_P(JdnDamage, IsNamedWithItsLine) {
    EXPECT_THAT(messageOf(with(GetParam().old, GetParam().now)),
                testing::AllOf(HasSubstr("s.jdn"), HasSubstr(GetParam().says)));
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, JdnDamage,
    testing::Values(
        Damage{"NegativeCorner", "Face = 0 1 2", "Face = 0 -1 2", "line 27, Face: found -1"},
        Damage{"HugeCorner", "Face = 0 1 2", "Face = 0 2147483647 2", "found 2147483647"},
        Damage{"TwoCorners", "Face = 0 1 2", "Face = 0 1", "three vertices"},
        Damage{"FourCorners", "Face = 0 1 2", "Face = 0 1 2 3", "three vertices"},
        Damage{"NotANumber", "Vert = 1 0 0", "Vert = 1 nan 0", "line 24, Vert: found '1 nan 0'"},
        Damage{"Infinite", "Vert = 1 0 0", "Vert = 1 1e999 0", "finite"},
        Damage{"Words", "Vert = 1 0 0", "Vert = one 0 0", "'one 0 0'"},
        Damage{"MissingVertex", "Vert = 1 0 0\n", "", "found 3 lines Vert, expected 4"},
        Damage{"MissingFace", "Face = 0 2 3\n", "", "found 1 lines Face, expected 2"},
        Damage{"MissingNormal", "Vert Normal = 0 0 1\n", "", "found 3 lines Vert Normal"},
        Damage{"ThreeBillionVertices", "Vertices = 4", "Vertices = 3000000000",
               "found 3000000000, expected at most"},
        Damage{"NegativeCount", "Vertices = 4", "Vertices = -4", "a count"},
        Damage{"MissingObject", "Objects = 2", "Objects = 3", "found 2 objects, expected 3"},
        Damage{"MissingMaterial", "Materials = 1", "Materials = 2", "1 materials, expected 2"},
        Damage{"FewerVerticesThanBefore", "Face = 0 2 3\n", "Face = 0 2 3\nNum Vertices = 3\n",
               "line 29, Num Vertices: found 3, expected 4, as the object said before"},
        Damage{"FewerTexturedVerticesThanBefore", "Textured Face = 0 0 0\n",
               "Textured Face = 0 0 0\nNum textured vertices = 0\n",
               "found 0, expected 1, as the object said before"},
        Damage{"FacesBeforeVertices", "Num   Vertices = 4\r\n", "", "before Num Vertices"}),
    [](const auto& test) { return test.param.name; });

TEST(JdnReader, RefusesWhatHasNoObject) {
    EXPECT_THAT(messageOf(""), HasSubstr("found 0 objects"));
    EXPECT_THAT(messageOf("ply\nformat ascii 1.0"), HasSubstr("found 0 objects"));
    EXPECT_THAT(messageOf("Number of Materials = 0\nNumber of Objects = 1\nMaterial ID = 0\n"
                          "Num Vertices = 0\nNum Faces = 0\n"),
                HasSubstr("no face"));
}

TEST(JdnReader, KeepsItsPromiseWhateverByteIsDamaged) {
    const std::string text = sample();
    for (std::size_t i = 0; i < text.size(); ++i)
        for (const char c : {'\0', '\xFF', '9', '-', '=', '\n', ' '}) {
            std::string damaged = text;
            damaged[i] = c;
            const auto mesh = parseJdn(damaged, "d.jdn");
            if (!mesh.ok()) {
                EXPECT_THAT(std::string(mesh.status().message()), HasSubstr("expected")) << i;
                continue;
            }
            EXPECT_TRUE(mesh->normals.empty() || mesh->normals.size() == mesh->positions.size());
            EXPECT_TRUE(mesh->colours.empty() || mesh->colours.size() == mesh->positions.size());
            for (const auto& triangle : mesh->triangles)
                for (const std::uint32_t corner : triangle)
                    EXPECT_LT(corner, mesh->positions.size()) << i;
        }
}

TEST(JdnReader, StopsWhenCalledOff) {
    std::stop_source stop;
    stop.request_stop();
    EXPECT_EQ(parseJdn(sample(), "s.jdn", {{}, stop.get_token()}).status().code(),
              absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace eyrie::import
