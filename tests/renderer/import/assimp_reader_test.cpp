// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_reader.h"

#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/gltf_chunks.h"
#include "tests/renderer/import/assimp_files.h"
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

TEST(AssimpReader, SaysWhereCoordinatesLoseWhatOneSees) {
    const test::TemporaryFolder folder;
    const auto notesAt = [&](double x, const std::string& name) {
        test::writeFile(folder.file(name),
                        fmt::format("OFF\n3 1 0\n{} 0 0\n{} 0 0\n{} 1 0\n3 0 1 2\n", x, x + 1, x));
        const auto mesh = readWithAssimp(folder.file(name));
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        return mesh.ok() ? mesh->notes : std::vector<std::string>();
    };
    EXPECT_THAT(notesAt(10, "m.off"), IsEmpty());
    EXPECT_THAT(notesAt(5e5, "m.off"),
                ElementsAre(testing::AllOf(HasSubstr("by up to 0.21 m"), HasSubstr("PLY"))));
}

TEST(AssimpReader, CountsMaterialsThatEmitMoreThanTheyReflect) {
    const test::TemporaryFolder folder;
    const auto notesWith = [&](const std::string& emitted) {
        std::string ac = test::kAc3d;
        ac.replace(ac.find("emis 0 0 0"), 10, "emis " + emitted);
        return test::notesOfFile(folder.file("m.ac"), ac);
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
    EXPECT_THAT(test::notesOfFile(folder.file("m.3ds"), threeDsOf(9)),
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
        return test::notesOfFile(folder.file("m.dxf"), text);
    };
    EXPECT_THAT(notesOf(dxfOfABlock(0, "0\nEOF\n")), IsEmpty());
    EXPECT_THAT(notesOf(dxfOfABlock(90, "0\nEOF\n")),
                ElementsAre(HasSubstr("1 blocks are not put as the file has them")));
    EXPECT_THAT(notesOf(dxfOfABlock(0, "")), ElementsAre(HasSubstr("did not encounter DXF EOF")));
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
