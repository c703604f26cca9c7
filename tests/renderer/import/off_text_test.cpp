// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/off_text.h"

#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/assimp_reader.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TriangleMesh read(const std::string& off) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.off"), off);
    const auto mesh = readWithAssimp(folder.file("m.off"));
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    return mesh.ok() ? *mesh : TriangleMesh{};
}

/// A triangle with the rest of its vertices' lines.
std::string offOf(const std::string& marks, const std::string& rest) {
    return marks + "OFF\n3 1 0\n0 0 0 " + rest + "\n1 0 0 " + rest + "\n0 1 0 " + rest +
           "\n3 0 1 2\n";
}

TEST(OffForAssimp, HasTheColoursOfVertices) {
    EXPECT_THAT(read(offOf("", "")).colours, IsEmpty());
    for (const char* rest : {"1 .5 0 1", "1.0 0.5 0", "255 128 0 255", "255 128 0# three\r"})
        EXPECT_THAT(read(offOf("C", rest)).colours, Each(fabric::Rgba{255, 128, 0, 255})) << rest;
    EXPECT_THAT(read(offOf("C", "1 0 0 .5")).colours, Each(fabric::Rgba{255, 0, 0, 128}));
}

TEST(OffForAssimp, HasTheColoursOfVerticesBehindTheirNormals) {
    for (const char* rest : {"0 0 -1 1 .5 0", "0 0 -1 255 128 0 255"}) {
        const TriangleMesh mesh = read(offOf("CN", rest));
        EXPECT_THAT(mesh.colours, Each(fabric::Rgba{255, 128, 0, 255})) << rest;
        EXPECT_THAT(mesh.normals, Each(glm::vec3(0, 0, -1))) << rest;
    }
}

TEST(OffForAssimp, HasWhatVerticesHaveWhereItsHeaderNamesThatInAnotherOrder) {
    for (const char* kind : {"STC", "CST"})
        for (const char* rest : {"1 .5 0 .25 .75", "1 .5 0 1 .25 .75", "255 128 0 .25 .75 # 1"})
            EXPECT_THAT(read(offOf(kind, rest)).colours, Each(fabric::Rgba{255, 128, 0, 255}))
                << kind << rest;
    EXPECT_THAT(read(offOf("NST", "0 0 -1 .25 .75")).normals, Each(glm::vec3(0, 0, -1)));
}

TEST(OffForAssimp, TellsNormalsFromColoursByTheirLength) {
    for (const char* rest : {"0.6 0 -0.8 1 .5 0", "0.6 0 -0.8 255 128 0 255", "1 .5 0 1 0.6 0 -0.8",
                             "255 128 0 255 0.6 0 -0.8 # MeshLab's", "255 128 0 0.6 0 -0.8\r"}) {
        const TriangleMesh mesh = read(offOf("NC", rest));
        EXPECT_THAT(mesh.colours, Each(fabric::Rgba{255, 128, 0, 255})) << rest;
        EXPECT_THAT(mesh.normals, Each(glm::vec3(0.6F, 0, -0.8F))) << rest;
        EXPECT_THAT(mesh.notes, Not(testing::Contains(HasSubstr("opacity")))) << rest;
    }
    EXPECT_THAT(read(offOf("NC", "0 0 1 1 0 0")).normals, Each(glm::vec3(0, 0, 1)))
        << "which may be either";
    EXPECT_THAT(offCaveats(offOf("NC", "1 .5 0 .5 0 0 -1")),
                ElementsAre(HasSubstr("the opacity of 3 vertices")));
    EXPECT_FALSE(offForAssimp(offOf("NC", "1 1 1 1 0 0 -3"))) << "neither";
    EXPECT_FALSE(offForAssimp(offOf("NC", "0 0 1 1"))) << "too few";
}

TEST(OffCaveats, CountOpacitiesBehindNormals) {
    for (const char* opaque : {"", "1", "1.0 # .5"})
        EXPECT_THAT(read(offOf("CN", std::string("0 0 1 1 .5 0 ") + opaque)).notes, IsEmpty());
    EXPECT_THAT(read(offOf("CN", "0 0 1 1 .5 0 .25")).notes,
                ElementsAre(HasSubstr("left out the opacity of 3 vertices")));
    EXPECT_THAT(read(offOf("C", "1 .5 0 .25")).notes,
                ElementsAre(HasSubstr("3 vertices are not opaque, which is left out")));
    EXPECT_THAT(read(offOf("C", "1 .5 0 1")).notes, IsEmpty());
}

TEST(OffForAssimp, LeavesAsTheyAreFilesThatAreReadRightly) {
    EXPECT_FALSE(offForAssimp(""));
    EXPECT_FALSE(offForAssimp("COFF\n"));
    EXPECT_FALSE(offForAssimp(offOf("", "1 1 1")));
    EXPECT_FALSE(offForAssimp(offOf("C", "1 1 1 1")));
    EXPECT_EQ(offForAssimp("# .\nCOFF 2 1 0 # 1 1 1 1 1 1\n\n1 2 3 4 5 6 # 7\n1 2 3 4 5 6"),
              "# .\nCOFF 2 1 0 # 1 1 1 1 1 1\n\n1 2 3 4 5 6 1 # 7\n1 2 3 4 5 6 1");
}

TEST(OffCaveats, CountColoursOfFacesLargeFacesAndWhatIsBehindThem) {
    EXPECT_THAT(read(offOf("", "") + "\n # end\n\n").notes, IsEmpty());
    EXPECT_THAT(read("3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").notes, IsEmpty()) << "no header";
    const std::string two = "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 ";
    EXPECT_THAT(read(two + "255 0 0\n3 2 1 0\n").notes,
                ElementsAre(HasSubstr("left out the colours of 1 faces")));
    EXPECT_THAT(read(two + "\n10 0 1 2 0 1 2 0 1 2 0\n").notes,
                ElementsAre(HasSubstr("left out 1 faces of more than 9 corners")));
    EXPECT_THAT(read(two + "\n3 2 1 0\n3 1 2 0\n3 2 0 1\n").notes,
                ElementsAre(HasSubstr("left out 2 lines behind the 2 faces")));
}

}  // namespace
}  // namespace eyrie::import
