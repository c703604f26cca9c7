// SPDX-License-Identifier: Apache-2.0
// Material files of OBJ.
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/mesh_reader.h"
#include "renderer/import/obj_textures.h"
#include "tests/renderer/import/small_models.h"
#include "tests/renderer/import/tga_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::HasSubstr;

TEST(ObjMaterials, OfALineAreNamedOnce) {
    EXPECT_THAT(librariesOfObj("mtllib a.mtl b c.mtl\n# mtllib d.mtl\nv 0 0 0\nmtllib e.mtl"),
                testing::ElementsAre("a.mtl", "b c.mtl", "e.mtl"));
    std::string line;
    for (int i = 0; i < 50'000; ++i) line += "mtllib ";
    EXPECT_LE(librariesOfObj(line).size(), 1U);
}

TEST(ObjMaterials, ReadsAnObjWithoutItsMaterials) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), test::kObj);
    const auto mesh = readMesh(folder.file("m.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->triangles.size(), 1U);
}

TEST(ObjMaterials, NamesMaterialFilesThatAreMissing) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), test::kObj);
    const auto mesh = readMesh(folder.file("m.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_TRUE(mesh->materials.empty());
    EXPECT_THAT(mesh->notes, testing::ElementsAre(HasSubstr("1 of 1 material files are missing, "
                                                            "and what they define is plain: "
                                                            "'m.mtl'")));
}

/// The colour of kObj with another name for its material file, and what is said.
fabric::Rgba colourWithLibrary(const test::TemporaryFolder& folder, const std::string& name,
                               std::vector<std::string>& notes) {
    std::string obj = test::kObj;
    test::writeFile(folder.file("m.obj"), obj.replace(obj.find("m.mtl"), 5, name));
    const auto mesh = readMesh(folder.file("m.obj"));
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    notes = mesh.ok() ? mesh->notes : notes;
    return mesh.ok() ? mesh->colours.at(0) : fabric::Rgba{};
}

TEST(ObjMaterials, TakesMaterialFilesWithNextToNothingInThem) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("a.obj"), "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (const char* content : {"", "\n", "# none\n", "# nothing\n", "newmtl\n"}) {
        test::writeFile(folder.file("a.mtl"), content);
        const auto mesh = readMesh(folder.file("a.obj"));
        ASSERT_TRUE(mesh.ok()) << mesh.status();
        EXPECT_EQ(mesh->triangles.size(), 1U);
    }
}

TEST(ObjMaterials, FindsMaterialFilesAsItFindsTextures) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("a model.mtl"), test::kMtl);
    for (const char* name : {"a model.mtl", "A Model.MTL", "a%20model.mtl", "a model.mtl ",
                             "maps\\a model.mtl", "C:\\maps\\a model.mtl"}) {
        std::vector<std::string> notes;
        EXPECT_EQ(colourWithLibrary(folder, name, notes), (fabric::Rgba{255, 0, 0, 255})) << name;
        EXPECT_THAT(notes, testing::IsEmpty()) << name;
    }
}

TEST(ObjMaterials, TakesSeveralMaterialFilesOfALine) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("a model.mtl"), "newmtl a\nKd 1 0 0\n");
    test::writeFile(folder.file("b.MTL"), "newmtl b\nKd 0 1 0\n");
    test::writeFile(folder.file("m.obj"),
                    "mtllib  a model.mtl  b.MTL \nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"
                    "usemtl b\nf 1 2 3\n");
    const std::vector<std::string> paths = {folder.file("m.obj")};
    const auto mesh = readMesh(paths[0]);
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_THAT(mesh->notes, testing::IsEmpty());
    EXPECT_EQ(mesh->colours[mesh->triangles[0][0]], (fabric::Rgba{255, 0, 0, 255}));
    EXPECT_EQ(mesh->colours[mesh->triangles[1][0]], (fabric::Rgba{0, 255, 0, 255}));
    const std::uint64_t before = *meshSourceHash(paths);
    test::writeFile(folder.file("b.MTL"), "newmtl b\nKd 0 0 1\n");
    EXPECT_NE(before, *meshSourceHash(paths));
}

TEST(ObjMaterials, TakesMaterialsHoweverTheirFileBegins) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), test::kTexturedObj);
    test::writeFile(folder.file("a.tga"), test::tgaOf(1, 1, {{9, 8, 7, 255}}));
    for (const char* begin :
         {"", "  ", "\t", "\xef\xbb\xbf ", "\n \r\n  ", "map_Kd b.tga\nKd 0 0 1\n"}) {
        test::writeFile(folder.file("m.mtl"),
                        std::string(begin) + "newmtl tiles\n  map_Kd a.tga\n  Kd 1 0 0\n");
        const auto mesh = readMesh(folder.file("m.obj"));
        ASSERT_TRUE(mesh.ok()) << begin << ": " << mesh.status();
        EXPECT_EQ(mesh->images.size(), 1U) << begin;
        EXPECT_EQ(mesh->colours[0], (fabric::Rgba{255, 0, 0, 255})) << begin;
    }
}

TEST(ObjMaterials, TakesOneNumberForAllThreeAndPassesHalosOver) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), test::kTexturedObj);
    for (const char* opacity : {"", "d -halo 1\n"}) {
        test::writeFile(folder.file("m.mtl"),
                        std::string("newmtl tiles\r\n") + opacity + "Kd 1  # white\nKs .5\n");
        const auto mesh = readMesh(folder.file("m.obj"));
        ASSERT_TRUE(mesh.ok()) << opacity << mesh.status();
        EXPECT_EQ(mesh->colours[0], (fabric::Rgba{255, 255, 255, 255})) << opacity;
    }
}

TEST(ObjVertices, GoOnWithTheNextLineBehindABackslash) {
    const test::TemporaryFolder folder;
    for (const char* end : {"\\\n", "\\\r\n"}) {
        test::writeFile(folder.file("m.obj"),
                        fmt::format("# C:\\a\\\nv 0 0 {0}0 1 0 0\nv 1 0 0 {0} 1 0 0\n"
                                    "v 0 1 0 1 0 0\nf 1 2 {0}3\n",
                                    end));
        const auto mesh = readMesh(folder.file("m.obj"));
        ASSERT_TRUE(mesh.ok()) << mesh.status();
        ASSERT_EQ(mesh->positions.size(), 3U);
        for (const fabric::Rgba& colour : mesh->colours)
            EXPECT_EQ(colour, (fabric::Rgba{255, 0, 0, 255}));
    }
}

TEST(ObjMaterials, TakesTheMaterialFileOfAnObjsOwnNameForOneThatIsMissingAndSaysSo) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.mtl"), test::kMtl);
    std::vector<std::string> notes;
    EXPECT_EQ(colourWithLibrary(folder, "lost.mtl", notes), (fabric::Rgba{255, 0, 0, 255}));
    EXPECT_THAT(notes, testing::ElementsAre("1 of 1 material files are missing, and 'm.mtl' is "
                                            "read in their place: 'lost.mtl'"));
    const std::vector<std::string> paths = {folder.file("m.obj")};
    const std::uint64_t red = *meshSourceHash(paths);
    test::writeFile(folder.file("m.mtl"), "newmtl red\nKd 0 1 0\n");
    EXPECT_NE(red, *meshSourceHash(paths));
}

TEST(ObjMaterials, ShowsTexturesOfAnObjInFullWhereNoColourIsGiven) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), test::kTexturedObj);
    test::writeFile(folder.file("a.tga"), test::tgaOf(1, 1, {{9, 8, 7, 255}}));
    for (const auto& [kd, level] : {std::pair("", 255), {"Kd 0.2 0.2 0.2\n", 51}}) {
        test::writeFile(folder.file("m.mtl"), std::string("newmtl tiles\r\nmap_Kd a.tga\r\n") + kd);
        const auto mesh = readMesh(folder.file("m.obj"));
        ASSERT_TRUE(mesh.ok()) << mesh.status();
        EXPECT_EQ(mesh->images.size(), 1U);
        const auto shown = static_cast<std::uint8_t>(level);
        EXPECT_EQ(mesh->colours[0], (fabric::Rgba{shown, shown, shown, 255}));
    }
}

TEST(ObjMaterials, FindsTexturesBesideTheObjAndThenBesideTheMaterialFile) {
    const test::TemporaryFolder folder;
    std::string obj = test::kTexturedObj;
    test::writeFile(folder.file("m.obj"), obj.replace(obj.find("m.mtl"), 5, "looks\\m.mtl"));
    std::filesystem::create_directories(folder.file("looks/maps"));
    test::writeFile(folder.file("looks/m.mtl"),
                    "newmtl tiles\nmap_Kd maps\\A.tga\nnewmtl lost\nmap_Kd lost.tga\n"
                    "newmtl pane\nnewmtl broken\n");
    const std::vector<std::string> paths = {folder.file("m.obj")};
    const auto readWith = [&](const char* image, std::uint8_t red) {
        test::writeFile(folder.file(image), test::tgaOf(1, 1, {{red, 0, 0, 255}}));
        const auto mesh = readMesh(paths[0]);
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        EXPECT_THAT(mesh->notes, testing::ElementsAre(HasSubstr("1 of 2 textures cannot be read, "
                                                                "and their materials have their "
                                                                "colour alone: 'lost.tga'")));
        EXPECT_EQ(mesh->images.size(), 1U);
        return static_cast<int>(mesh->images.at(0).shape.meanColour & 0xFF);
    };
    const std::uint64_t without = *meshSourceHash(paths);
    EXPECT_EQ(readWith("looks/a.tga", 5), 5) << "by its last part, in whatever case";
    EXPECT_EQ(readWith("looks/maps/A.tga", 10), 10);
    const std::uint64_t beside = *meshSourceHash(paths);
    EXPECT_NE(beside, without);
    EXPECT_EQ(readWith("A.tga", 20), 20);
    EXPECT_NE(*meshSourceHash(paths), beside) << "of what is read now";
}

TEST(ObjMaterials, LeavesColoursOutThatAreGivenOtherwiseThanByRedGreenAndBlue) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), test::kTexturedObj);
    test::writeFile(folder.file("a.tga"), test::tgaOf(1, 1, {{9, 8, 7, 255}}));
    test::writeFile(folder.file("m.mtl"),
                    "newmtl tiles\nKd  xyz 0.1 0.2 0.3 # CIE\n  Ka spectral a.rfl\nKs xyz .5\n"
                    "Tf spectral a.rfl 2\nmap_Kd a.tga\nnewmtl lost\nKd spectral a.rfl\n"
                    "newmtl pane\nKd 0 0 1\nKa xyz 1\nnewmtl broken\n");
    const auto mesh = readMesh(folder.file("m.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_THAT(mesh->notes, testing::ElementsAre(HasSubstr("the colours of 2 materials")));
    EXPECT_EQ(mesh->colours[mesh->triangles[0][0]], (fabric::Rgba{255, 255, 255, 255}));
    EXPECT_EQ(mesh->colours[mesh->triangles[2][0]], (fabric::Rgba{0, 0, 255, 255}));
}

TEST(ObjMaterials, CountsMaterialsThatNoFileDefines) {
    const test::TemporaryFolder folder;
    const auto notesOf = [&](const std::string& mtl) {
        test::writeFile(folder.file("m.obj"),
                        "# mtllib lost.mtl\nmtllib m.mtl\nv 0 0 0\nv 1 0 0\n"
                        "v 0 1 0\nf 1 2 3\nusemtl a\nf 1 2 3\n"
                        "usemtl my wall \nf 1 2 3\n");
        test::writeFile(folder.file("m.mtl"), mtl);
        return readMesh(folder.file("m.obj"))->notes;
    };
    EXPECT_THAT(notesOf("newmtl a\n"),
                testing::ElementsAre("1 materials are used that no material file defines, and what "
                                     "has them is plain: 'my wall'"));
    for (const char* mtl :
         {"newmtl a\nKd 1 0 0\nnewmtl my wall\n", "newmtl a\rKd 1 0 0\rnewmtl my wall\r",
          "\xef\xbb\xbfnewmtl a\r\nKd 1 0 0\r\nnewmtl\tmy wall \r\n"})
        EXPECT_THAT(notesOf(mtl), testing::IsEmpty()) << mtl;
}

}  // namespace
}  // namespace eyrie::import
