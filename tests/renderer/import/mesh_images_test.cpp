// SPDX-License-Identifier: Apache-2.0
// Textures of meshes: which are found, which can be read.
#include <array>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

#include "renderer/import/mesh_reader.h"
#include "renderer/import/sgi_image.h"
#include "renderer/import/texture_files.h"
#include "renderer/mesh/eym_format.h"
#include "tests/renderer/import/small_models.h"
#include "tests/renderer/import/tga_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::HasSubstr;

TEST(MeshImages, ReadsTexturesAndCountsThoseThatAreMissing) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), test::kTexturedObj);
    test::writeFile(folder.file("m.mtl"), test::kTexturedMtl);
    test::writeFile(folder.file("tiles.TGA"), test::tgaOf(2, 1, {{9, 8, 7, 255}, {1, 2, 3, 0}}));
    test::writeFile(folder.file("broken.png"), "\x89PNG\r\n\x1a\n and no more");
    const auto mesh = readMesh(folder.file("m.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_THAT(mesh->notes, testing::ElementsAre(HasSubstr(
                                 "2 of 3 textures cannot be read, and their materials have their "
                                 "colour alone: 'lost.png' is not there")));
    ASSERT_EQ(mesh->images.size(), 1U);
    EXPECT_EQ(mesh->images[0].shape.width, 2U);
    EXPECT_TRUE(mesh->images[0].shape.hasAlpha());
    ASSERT_EQ(mesh->triangles.size(), 4U);
    const auto materialOf = [&](std::size_t triangle) {
        return mesh->materials[mesh->materialOf[mesh->triangles[triangle][0]]];
    };
    const auto colourOf = [&](std::size_t triangle) {
        return mesh->colours[mesh->triangles[triangle][0]];
    };
    EXPECT_EQ(materialOf(0), (mesh::Material{.image = 0, .alphaCutoff = 0.5F}));
    EXPECT_EQ(colourOf(0), (fabric::Rgba{255, 255, 255, 255})) << "not black";
    EXPECT_EQ(mesh->textureCoordinates[mesh->triangles[0][0]], glm::vec2(0.25F, 1));
    EXPECT_EQ(materialOf(1), mesh::Material());
    EXPECT_EQ(colourOf(1), (fabric::Rgba{255, 0, 0, 255}));
    EXPECT_EQ(materialOf(2), (mesh::Material{.flags = mesh::kIsBlended}));
    EXPECT_EQ(colourOf(2), (fabric::Rgba{0, 0, 255, 102}));
    EXPECT_EQ(materialOf(3), mesh::Material());
    EXPECT_EQ(colourOf(3), (fabric::Rgba{0, 255, 0, 255}));
}

TEST(MeshImages, SaysWhereTextureCoordinatesAreFartherThanCanBeKept) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.mtl"),
                    "newmtl tiles\nmap_Kd tiles.tga\nnewmtl pane\nKd 0 0 1\n");
    test::writeFile(folder.file("tiles.tga"), test::tgaOf(1, 1, {{9, 8, 7, 255}}));
    const auto notesOf = [&](const std::string& place) {
        test::writeFile(folder.file("m.obj"),
                        "mtllib m.mtl\nv 5 0 0\nv 6 0 0\nv 5 1 0\nvt 0 0\nvt 1 0\nvt " + place +
                            "\nusemtl tiles\nf 1/1 2/2 3/3\nusemtl pane\nf 1/1 3/3 2/2\n");
        return readMesh(folder.file("m.obj"))->notes;
    };
    EXPECT_THAT(notesOf("-16383 16384"), testing::IsEmpty());
    EXPECT_THAT(notesOf("0 -20000"), testing::ElementsAre(HasSubstr("1 of 6 vertices")));
}

/// As of images of 32 bits whose last eight mean nothing.
TEST(MeshImages, TakesImagesOfWhichNothingShowsForOpaque) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), test::kTexturedObj);
    test::writeFile(folder.file("m.mtl"), "newmtl tiles\nmap_Kd a.tga\n");
    std::string image = test::tgaOf(2, 1, {{9, 8, 7, 0}, {1, 2, 3, 0}});
    image[17] = 0x20;
    test::writeFile(folder.file("a.tga"), image);
    const auto mesh = readMesh(folder.file("m.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_EQ(mesh->images.size(), 1U);
    EXPECT_FALSE(mesh->images[0].shape.hasAlpha());
    EXPECT_EQ(mesh->materials[mesh->materialOf[0]], (mesh::Material{.image = 0}));
    EXPECT_THAT(mesh->notes, testing::Contains(HasSubstr("1 of 1 textures have no opacity")));
}

TEST(MeshImages, LoadsTheTexturesOfAPlyAndKeepsItsColoursWhereOneIsMissing) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.ply"), test::kTexturedPly);
    test::writeFile(folder.file("m_A.PNG"), test::tgaOf(1, 1, {{9, 8, 7, 255}}));
    const auto mesh = readMesh(folder.file("m.ply"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_THAT(mesh->notes,
                testing::ElementsAre(HasSubstr("1 of 2 textures cannot be read, and their "
                                               "materials have their colour alone: 'lost.png'")));
    ASSERT_EQ(mesh->images.size(), 1U);
    ASSERT_EQ(mesh->triangles.size(), 2U);
    const std::uint32_t textured = mesh->triangles[0][0], lost = mesh->triangles[1][2];
    EXPECT_EQ(mesh->materials[mesh->materialOf[textured]], (mesh::Material{.image = 0}));
    EXPECT_EQ(mesh->colours[textured], (fabric::Rgba{255, 255, 255, 255}));
    EXPECT_EQ(mesh->materials[mesh->materialOf[lost]], mesh::Material());
    EXPECT_EQ(mesh->colours[lost], (fabric::Rgba{255, 0, 0, 255}));
}

TEST(MeshImages, ShowsATextureInFullWhereNothingElseHasAColour) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("w.tga"), test::tgaOf(1, 1, {{9, 8, 7, 255}}));
    test::writeFile(folder.file("m.x3d"),
                    R"(<?xml version="1.0"?><X3D profile="Interchange" version="3.3"><Scene><Shape>
<Appearance><ImageTexture url='"w.tga"'/></Appearance>
<IndexedFaceSet coordIndex="0 1 2 -1" texCoordIndex="0 1 2 -1">
<Coordinate point="0 0 0 1 0 0 0 1 0"/><TextureCoordinate point="0 0 1 0 0 1"/>
</IndexedFaceSet></Shape></Scene></X3D>)");
    const auto mesh = readMesh(folder.file("m.x3d"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_THAT(mesh->colours, testing::Each(fabric::Rgba{255, 255, 255, 255}));
    EXPECT_EQ(mesh->colours.size(), mesh->positions.size());
}

TEST(MeshImages, LoadsBothImagesOfATexturedPlyOfMeshLab) {
    const test::TemporaryFolder folder;
    const std::string data = EYRIE_SOURCE_DIR "/../shared/data/hard/ply/";
    for (const auto& [name, from] : {std::pair("TextureDouble.ply", "meshlab_TextureDouble.ply"),
                                     {"TextureDouble_A.png", "TextureDouble_A.png"},
                                     {"TextureDouble_B.png", "TextureDouble_B.png"}}) {
        ASSERT_TRUE(std::filesystem::exists(data + from)) << "missing test data: " << data << from;
        std::filesystem::copy_file(data + from, folder.file(name));
    }
    const auto mesh = readMesh(folder.file("TextureDouble.ply"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_THAT(mesh->notes, testing::IsEmpty());
    ASSERT_EQ(mesh->images.size(), 2U);
    EXPECT_EQ(mesh->images[1].shape.width, 512U);
    EXPECT_EQ(mesh->positions.size(), 8U) << "no seams within a square";
    EXPECT_EQ(mesh->materials[mesh->materialOf[0]].image, 0);
    EXPECT_EQ(mesh->materials[mesh->materialOf[7]].image, 1);
}

/// Noise, which no block of 4 x 4 texels has room for; of small images each texel has one.
TEST(MeshImages, SaysHowMuchTexturesLoseByCompression) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), test::kTexturedObj);
    test::writeFile(folder.file("m.mtl"), "newmtl tiles\nmap_Kd a.tga\n");
    const auto notesOf = [&](int side, unsigned most) {
        std::mt19937 random(3);
        std::vector<fabric::Rgba> texels(static_cast<std::size_t>(side * side));
        for (fabric::Rgba& texel : texels)
            texel = {static_cast<std::uint8_t>(random() % most),
                     static_cast<std::uint8_t>(random() % most),
                     static_cast<std::uint8_t>(random() % most), 255};
        test::writeFile(folder.file("a.tga"), test::tgaOf(side, side, texels));
        return readMesh(folder.file("m.obj"))->notes;
    };
    EXPECT_THAT(notesOf(96, 256),
                testing::Contains(HasSubstr("1 of 1 textures lose more than 10 of 255 (RMS)")));
    EXPECT_THAT(notesOf(96, 16), testing::Not(testing::Contains(HasSubstr("lose"))));
    EXPECT_THAT(notesOf(64, 256), testing::Not(testing::Contains(HasSubstr("lose"))));
}

TEST(MeshImages, RefusesTexturesOfAbsurdSize) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), test::kTexturedObj);
    test::writeFile(folder.file("m.mtl"), "newmtl tiles\nKd 0 0 1\nmap_Kd a.tga\n");
    std::string large = test::tgaOf(1, 1, {{9, 8, 7, 255}});
    large[13] = large[15] = '\x7F';
    test::writeFile(folder.file("a.tga"), large);
    const auto mesh = readMesh(folder.file("m.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_THAT(mesh->notes, testing::Contains(HasSubstr("'a.tga' has 32513 x 32513 texels, "
                                                         "more than 8192 a side")));
    EXPECT_EQ(mesh->colours[0], (fabric::Rgba{0, 0, 255, 255}));
}

/// A BMP of 64 x 64 grey texels of three bytes.
std::string bmpOf64() {
    std::string file(54, '\0');
    file[0] = 'B', file[1] = 'M', file[10] = 54, file[14] = 40;
    file[18] = file[22] = 64, file[26] = 1, file[28] = 24;
    return file + std::string(std::size_t{64} * 64 * 3, '\x40');
}

/// Longer than what stb_image reads ahead and hardly longer, and in runs.
TEST(MeshImages, CallsImagesThatAreCutOffDamaged) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), test::kTexturedObj);
    std::string runs = test::tgaOf(64, 64, {});
    runs[2] = 10;
    for (int i = 0; i < 32; ++i)
        runs +=
            "\xFF"
            "bgra";
    const std::string coded = "newmtl tiles\nmap_Kd a.";
    const auto notesOf = [&](const std::string& ending, const std::string& image) {
        test::writeFile(folder.file("m.mtl"), coded + ending);
        test::writeFile(folder.file("a." + ending), image);
        return readMesh(folder.file("m.obj"))->notes;
    };
    for (const auto& [ending, image] :
         {std::pair("tga", test::tgaOf(64, 64, std::vector<fabric::Rgba>(64 * 64))),
          {"tga", test::tgaOf(6, 5, std::vector<fabric::Rgba>(6 * 5))},
          {"tga", runs},
          {"bmp", bmpOf64()}}) {
        EXPECT_THAT(notesOf(ending, image),
                    testing::Not(testing::Contains(HasSubstr("a." + std::string(ending)))));
        EXPECT_THAT(notesOf(ending, image + "more"),
                    testing::Not(testing::Contains(HasSubstr("damaged"))));
        for (const std::size_t length : {image.size() - 1, image.size() - 100, image.size() / 2})
            EXPECT_THAT(notesOf(ending, image.substr(0, length)),
                        testing::Contains(HasSubstr(
                            fmt::format("'a.{}' is damaged (it ends too early)", ending))))
                << length;
    }
}

/// Of 40 x 24 texels, as the baseline of JPEG.
std::string jpegOf() {
    std::array<std::uint8_t, 40 * 24 * 3> texels{};
    for (std::size_t i = 0; i < texels.size(); ++i)
        texels[i] = static_cast<std::uint8_t>(i * i % 251);
    std::string file;
    const auto append = [](void* to, void* bytes, int size) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(bytes),
                                              static_cast<std::size_t>(size));
    };
    stbi_write_jpg_to_func(append, &file, 40, 24, 3, texels.data(), 80);
    return file;
}

TEST(MeshImages, TellsJpegsThatLackTheirEndFromThoseThatLackMore) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), test::kTexturedObj);
    test::writeFile(folder.file("m.mtl"), "newmtl tiles\nmap_Kd a.jpg\n");
    const std::string whole = jpegOf();
    const auto read = [&](const std::string& image) {
        test::writeFile(folder.file("a.jpg"), image);
        const auto mesh = readMesh(folder.file("m.obj"));
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        return mesh.ok() ? *mesh : TriangleMesh{};
    };
    const std::size_t end = whole.size() - 2;
    const TriangleMesh mesh = read(whole);
    ASSERT_EQ(mesh.images.size(), 1U);
    EXPECT_EQ(read(whole.substr(0, end)).images, mesh.images);
    EXPECT_EQ(read(whole + "more").images, mesh.images);
    for (const std::size_t length : {end - 1, end - 20, whole.size() / 2, std::size_t{300}}) {
        const TriangleMesh cut = read(whole.substr(0, length));
        EXPECT_THAT(cut.images, testing::IsEmpty()) << length;
        EXPECT_THAT(cut.notes,
                    testing::Contains(HasSubstr("'a.jpg' is damaged (it ends too early)")))
            << length;
    }
}

/// An SGI image of 3 x 2 texels with alpha, rows from the bottom, one channel after the other.
std::string sgiOf(bool isCoded) {
    std::string file(512, '\0');
    file[0] = 1, file[1] = '\xDA', file[2] = isCoded ? 1 : 0, file[3] = 1;
    file[5] = 3, file[7] = 3, file[9] = 2, file[11] = 4;
    const std::string rows = "abcdefghijklmnopqrstuvwx";
    if (!isCoded)
        return file + rows;
    for (int row = 0; row < 8; ++row) file += {0, 0, 2, static_cast<char>(64 + 4 * row)};
    file += std::string(32, '\0');  // lengths, which are not needed
    for (std::size_t row = 0; row < 8; ++row)
        file += row == 0 ? "\3a" + std::string(2, '\0') : "\x83" + rows.substr(3 * row, 3);
    return file;
}

TEST(SgiImage, HasItsRowsFromTheBottom) {
    for (const bool isCoded : {false, true}) {
        const std::string file = sgiOf(isCoded);
        const auto bytes = std::as_bytes(std::span(file));
        mesh::ImageShape shape;
        ASSERT_TRUE(looksLikeSgi(bytes));
        const auto texels = decodeSgi(bytes, shape);
        ASSERT_TRUE(texels.ok()) << texels.status();
        ASSERT_EQ(texels->size(), 6U);
        EXPECT_EQ(shape.width, 3U);
        EXPECT_EQ((*texels)[0], (fabric::Rgba{'d', 'j', 'p', 'v'}));
        EXPECT_EQ((*texels)[5], (fabric::Rgba{std::uint8_t(isCoded ? 'a' : 'c'), 'i', 'o', 'u'}));
        for (std::size_t length = 0; length + 2 < file.size(); ++length)
            EXPECT_FALSE(decodeSgi(bytes.first(length), shape).ok()) << length;
    }
}

TEST(FindTexture, TakesNamesAsTheyStandBeforeItTakesThemForUris) {
    const test::TemporaryFolder folder;
    const std::string source = folder.file("m.gltf");
    test::writeFile(folder.file("a b.png"), "");
    EXPECT_EQ(findTexture("a%20b.png", source), folder.file("a b.png"));
    EXPECT_EQ(findTexture("maps/A%20b.PNG", source), folder.file("a b.png"));
    test::writeFile(folder.file("a%20b.png"), "");
    EXPECT_EQ(findTexture("a%20b.png", source), folder.file("a%20b.png"));
    for (const char* name : {"a%2", "a%", "a%zzb.png", "a%00 b.png", "%2f", "a%2Gb.png"})
        EXPECT_EQ(findTexture(name, source), "") << name;
}

}  // namespace
}  // namespace eyrie::import
