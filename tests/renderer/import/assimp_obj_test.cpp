// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/assimp_reader.h"
#include "renderer/import/obj_text.h"
#include "tests/renderer/import/assimp_files.h"
#include "tests/renderer/import/mesh_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

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

TEST(AssimpReader, SaysWhatObjsHaveThatIsNoPolygon) {
    const test::TemporaryFolder folder;
    const auto notesOf = [&](const std::string& text) {
        return test::notesOfFile(folder.file("m.obj"), text);
    };
    const std::string face = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    EXPECT_THAT(notesOf(face), IsEmpty());
    EXPECT_THAT(notesOf(face + "cstype bezier\nsurf 0 1 0 1 1 2 3\nend\n"),
                ElementsAre(HasSubstr("left out 1 free-form surfaces")));
}

TEST(AssimpReader, SaysThatSmoothingGroupsOfAnObjAreLeftOutWhereNothingElseHasItsEdges) {
    const test::TemporaryFolder folder;
    const auto notesOf = [&](const std::string& begin, const std::string& between) {
        return test::notesOfFile(
            folder.file("m.obj"),
            begin + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + between + "v 0 0 1\nf 1 4 2\n");
    };
    for (const char* group : {"", "s 1\n", "s 1 \r\n"})
        EXPECT_THAT(notesOf(group, group), IsEmpty()) << group;
    for (const auto& [first, second] :
         {std::pair("s 1\n", "s 2\r\n"), {"s off\n", ""}, {"s 0\n", "s 1\n"}}) {
        EXPECT_THAT(notesOf(first, second), ElementsAre(HasSubstr("its smoothing groups")));
        EXPECT_THAT(notesOf(std::string("vn 0 0 1\n") + first, second), IsEmpty());
    }
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
    EXPECT_THAT(test::notesOfFile(folder.file("m.obj"), objOf("0 2 0")),
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
    EXPECT_THAT(test::notesOfFile(path, objOf("0 0.5 1 1")), IsEmpty());
    EXPECT_THAT(test::notesOfFile(path, objOf("0 0.5 1 0.2")),
                ElementsAre(HasSubstr("the opacity of 1 vertices")));
}

TEST(ObjForAssimp, TakesABackslashBeforeACommentForNoNumber) {
    EXPECT_EQ(objForAssimp("v 0 0 0 1 1 \\# c\n"), "v 0 0 0 \n");
    EXPECT_EQ(objForAssimp("v 0 0 0 1 1 1\\\\# c\n"), "v 0 0 0 1 1 1\n");
}

TEST(ObjForAssimp, LeavesAsTheyAreFilesThatAreReadRightly) {
    EXPECT_FALSE(objForAssimp("# .5\no a .5 # b\nv 0.5 -.5 1.\nvn 0 0 1\nf 1 2 3\n"));
    EXPECT_FALSE(objForAssimp(""));
    EXPECT_FALSE(objForAssimp("f 1 2\\\n 3\n")) << "which goes on";
    EXPECT_EQ(objForAssimp("v .5 .5 1\r\to .5\rvt .1 # .1\r"), "v 0.5 0.5 1\ro .5\rvt 0.1 \r");
    EXPECT_FALSE(objForAssimp("mtllib a b.MTL\nmtllib a.mtl\nmtllib c.x d.x\n"));
}

}  // namespace
}  // namespace eyrie::import
