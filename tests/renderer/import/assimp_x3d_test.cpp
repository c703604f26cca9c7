// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/assimp_reader.h"
#include "renderer/import/x3d_caveats.h"
#include "renderer/import/x3d_text.h"
#include "tests/renderer/import/assimp_files.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A square that is seen from the side that z of the file points to, by such a tag of a shape and
/// a node of its geometry.
std::string x3dOf(const std::string& shape, const std::string& geometry) {
    return fmt::format(
        "<?xml version=\"1.0\"?><X3D><Scene><Shape{}><{}><Coordinate "
        "point='0 0 0, 1 0 0, 1 1 0, 0 1 0'/><Color color='1 0 0, 0 1 0, 0 0 1, 0 0 0'/></{}>"
        "</Shape></Scene></X3D>",
        shape, geometry, geometry.substr(0, geometry.find(' ')));
}

TEST(AssimpReader, TurnsFacesOfX3dWhoseCornersGoClockwise) {
    const test::TemporaryFolder folder;
    for (const char* geometry : {"IndexedFaceSet ccw='false' coordIndex='3,2,1,0'",
                                 "IndexedFaceSet ccw='false' coordIndex='3 2 1 -1 3 1 0 -1' "
                                 "colorIndex='3 2 1 -1 3 1 0 -1'",
                                 "IndexedFaceSet coordIndex='0 1 2 3 -1'",
                                 "IndexedFaceSet ccw='true' coordIndex='0 1 2 3'",
                                 "IndexedTriangleSet ccw='false' index='2 1 0 3 2 0'",
                                 "IndexedTriangleSet index='0 1 2 0 2 3'"}) {
        test::writeFile(folder.file("m.x3d"), x3dOf("", geometry));
        const auto mesh = readWithAssimp(folder.file("m.x3d"));
        ASSERT_TRUE(mesh.ok()) << geometry << mesh.status();
        EXPECT_THAT(mesh->notes, IsEmpty()) << geometry;
        ASSERT_EQ(mesh->triangles.size(), 2U) << geometry;
        for (const auto& [a, b, c] : mesh->triangles) {
            const auto normal = glm::cross(mesh->positions[b] - mesh->positions[a],
                                           mesh->positions[c] - mesh->positions[a]);
            EXPECT_EQ(normal, fabric::Vec3(0, -1, 0)) << geometry;
            for (const std::uint32_t corner : {a, b, c}) {
                const bool isRed = mesh->positions[corner] == fabric::Vec3(0);
                const fabric::Rgba colour = mesh->colours.at(corner);
                EXPECT_EQ(colour == (fabric::Rgba{255, 0, 0, 255}), isRed) << geometry;
            }
        }
    }
}

TEST(AssimpReader, HasShapesOfX3dWithoutAMaterialPlain) {
    const test::TemporaryFolder folder;
    const auto shapeOf = [](int x, const std::string& appearance) {
        return fmt::format(
            "<Shape>{}<IndexedFaceSet coordIndex='0 1 2 -1'><Coordinate "
            "point='{} 0 0 9 1 0 9 0 1'/></IndexedFaceSet></Shape>",
            appearance, x);
    };
    const std::string red = "<Appearance><Material diffuseColor='1 0 0'/></Appearance>";
    const auto coloursOf = [&](const std::string& appearance) {
        test::writeFile(folder.file("m.x3d"), "<?xml version='1.0'?><X3D><Scene>" +
                                                  shapeOf(0, appearance) + shapeOf(1, "") +
                                                  "</Scene></X3D>");
        const auto mesh = readWithAssimp(folder.file("m.x3d"));
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        std::vector<fabric::Rgba> colours;
        for (std::size_t i = 0; mesh.ok() && i < mesh->colours.size(); ++i)
            if (mesh->positions[i].x < 9)
                colours.push_back(mesh->colours[i]);
        return colours;
    };
    EXPECT_THAT(coloursOf(red), testing::UnorderedElementsAre(fabric::Rgba{255, 0, 0, 255},
                                                              fabric::Rgba{204, 204, 204, 255}));
    EXPECT_THAT(coloursOf(""), IsEmpty());
}

TEST(AssimpReader, CountsWhatX3dHidesAndTrianglesThatAreSeenFromBehind) {
    const test::TemporaryFolder folder;
    const auto notesOf = [&](const std::string& shape, const std::string& geometry) {
        return test::notesOfFile(folder.file("m.x3d"), x3dOf(shape, geometry));
    };
    EXPECT_THAT(notesOf(" visible='true'", "IndexedFaceSet coordIndex='0 1 2 3'"), IsEmpty());
    EXPECT_THAT(notesOf(" visible='false'", "IndexedFaceSet coordIndex='0 1 2 3'"),
                ElementsAre(HasSubstr("shows 1 nodes, too, that are not to be seen")));
    EXPECT_THAT(notesOf("", "TriangleSet ccw = \"false\""),
                ElementsAre(HasSubstr("1 TriangleSets have their back in front")));
    EXPECT_THAT(notesOf("", "TriangleSet ccw='true'"), IsEmpty());
}

/// As of many that name one by USE, or that do not end: some milliseconds, where it was minutes.
TEST(X3dForAssimp, LooksAtEachByteAFewTimesHoweverManyShapesThereAre) {
    std::string x3d = "<Appearance><Material/></Appearance>";
    for (int i = 0; i < 200'000; ++i) x3d += i % 2 == 0 ? "<Shape USE='a'/>" : "<Shape>";
    EXPECT_GT(x3dForAssimp(x3d).size(), x3d.size());
    std::string comment = "<!-- ";
    for (int i = 0; i < 500'000; ++i) comment += " ccw='false'";
    EXPECT_THAT(x3dCaveats(comment + " -->"), IsEmpty());
}

/// Each set may say in a few bytes that it has as many vertices as the file has bytes.
TEST(X3dForAssimp, HasNoMoreVerticesInStripsThanTheFileHasBytes) {
    std::string x3d;
    for (int i = 0; i < 1000; ++i) x3d += "<TriangleStripSet stripCount='30000'>";
    EXPECT_LT(x3dForAssimp(x3d).size(), 8 * x3d.size());
}

}  // namespace
}  // namespace eyrie::import
