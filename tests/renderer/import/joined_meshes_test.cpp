// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/joined_meshes.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/renderer/import/ply_text.h"
#include "tests/renderer/import/small_models.h"
#include "tests/renderer/import/tga_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::HasSubstr;

/// Writes OBJ files of one triangle each, of which each begins at another x, from 0 on.
std::vector<std::string> writeObjs(const test::TemporaryFolder& folder, std::size_t count) {
    std::vector<std::string> paths;
    for (std::size_t i = 0; i < count; ++i) {
        paths.push_back(folder.file(fmt::format("{}.obj", i)));
        test::writeFile(paths.back(), fmt::format("v {0} 0 0\nv {0} 1 0\nv {0} 0 1\nf 1 2 3\n", i));
    }
    return paths;
}

TEST(JoinedMeshes, AreOfFilesOfAnyFormatInTheirOrder) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("a.ply"),
                    test::plyOf(test::tetrahedron(), test::Encoding::LittleEndian));
    test::writeFile(folder.file("b.OBJ"), test::kObj);
    test::writeFile(folder.file("m.mtl"), test::kMtl);
    test::writeFile(folder.file("c.jdn"), test::kJdn);
    const std::vector<std::string> paths = {folder.file("a.ply"), folder.file("b.OBJ"),
                                            folder.file("c.jdn")};
    const auto mesh = readMeshes(paths);
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_EQ(mesh->triangles.size(), 6U);
    ASSERT_EQ(mesh->colours.size(), mesh->positions.size());
    const auto& [a, b, c] = mesh->triangles[4];
    EXPECT_EQ(mesh->positions[a], fabric::Vec3(5, 0, 0));
    EXPECT_EQ(mesh->colours[a], (fabric::Rgba{255, 0, 0, 255}));
    EXPECT_EQ(mesh->colours[0], (fabric::Rgba{204, 204, 204, 255}));
    EXPECT_EQ(mesh->positions[mesh->triangles[5][1]], fabric::Vec3(1, 0, 0));
    EXPECT_TRUE(mesh->notes.size() == 1 && mesh->notes[0].starts_with(paths[2]));
}

TEST(JoinedMeshes, NameTheFileThatCannotBeRead) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("a.ply"), test::plyOf(test::tetrahedron(), test::Encoding::Ascii));
    test::writeFile(folder.file("b.obj"), "nothing\n");
    const std::vector<std::string> paths = {folder.file("a.ply"), folder.file("b.obj")};
    const auto mesh = readMeshes(paths);
    EXPECT_EQ(mesh.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(mesh.status().message()), HasSubstr("b.obj"));
}

TEST(JoinedMeshes, HaveTheMaterialsOfAllFiles) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("a.ply"),
                    test::plyOf(test::tetrahedron(), test::Encoding::LittleEndian));
    test::writeFile(folder.file("m.obj"), test::kTexturedObj);
    test::writeFile(folder.file("m.mtl"), test::kTexturedMtl);
    test::writeFile(folder.file("tiles.tga"), test::tgaOf(1, 1, {{9, 8, 7, 255}}));
    const std::vector<std::string> paths = {folder.file("a.ply"), folder.file("m.obj"),
                                            folder.file("m.obj")};
    const auto mesh = readMeshes(paths);
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_EQ(mesh->materialOf.size(), mesh->positions.size());
    ASSERT_EQ(mesh->textureCoordinates.size(), mesh->positions.size());
    ASSERT_EQ(mesh->images.size(), 2U);
    EXPECT_EQ(mesh->materials[mesh->materialOf[0]], mesh::Material());
    const std::uint32_t last = mesh->triangles[mesh->triangles.size() - 4][0];
    EXPECT_EQ(mesh->materials[mesh->materialOf[last]], (mesh::Material{.image = 1}));
}

TEST(JoinedMeshes, AreInOrderWhateverFilesAreReadSideBySide) {
    constexpr std::size_t kFiles = 40;
    const test::TemporaryFolder folder;
    const std::vector<std::string> paths = writeObjs(folder, kFiles);
    for (const std::uint64_t memoryBytes : {std::uint64_t{0}, std::uint64_t{1} << 30}) {
        std::vector<double> shares;
        const ImportControl control{
            [&](std::string_view, double share) { shares.push_back(share); }, {}};
        const auto mesh = readMeshes(paths, control, {.memoryBytes = memoryBytes});
        ASSERT_TRUE(mesh.ok()) << mesh.status();
        ASSERT_EQ(mesh->triangles.size(), kFiles);
        for (std::size_t i = 0; i < kFiles; ++i)
            EXPECT_EQ(mesh->positions[mesh->triangles[i][0]].x, static_cast<double>(i));
        EXPECT_TRUE(std::ranges::is_sorted(shares)) << testing::PrintToString(shares);
        EXPECT_DOUBLE_EQ(shares.back(), 1);
    }
}

TEST(JoinedMeshes, TellOfTheFirstFileThatCannotBeRead) {
    const test::TemporaryFolder folder;
    const std::vector<std::string> paths = writeObjs(folder, 20);
    std::string slow = "v 0 0 0\nv 0 1 0\nv 0 0 1\n";
    for (int i = 0; i < 20'000; ++i) slow += "f 1 2 3\n";
    test::writeFile(paths[5], slow + "v 1\nf 1 2 999999\n");
    for (const std::size_t i : {6U, 7U, 12U}) test::writeFile(paths[i], "nothing\n");
    const std::string wrong = std::string(readMesh(paths[5]).status().message());
    for (int repeat = 0; repeat < 5; ++repeat)
        EXPECT_EQ(std::string(readMeshes(paths).status().message()), wrong);
}

TEST(JoinedMeshes, TakeNoMoreTogetherThanTheyMay) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("a.ply"),
                    test::plyOf(test::tetrahedron(), test::Encoding::LittleEndian));
    constexpr std::uint64_t kOfTwo = 400;  // four positions and four triangles are 144
    const std::vector<std::string> paths(3, folder.file("a.ply"));
    const auto two = readMeshes(std::span(paths).first(2), {}, {.memoryBytes = kOfTwo});
    EXPECT_TRUE(two.ok()) << two.status();
    const auto three = readMeshes(paths, {}, {.memoryBytes = kOfTwo});
    EXPECT_EQ(three.status().code(), absl::StatusCode::kResourceExhausted);
    EXPECT_THAT(std::string(three.status().message()), HasSubstr("with it the files take"));
}

TEST(JoinedMeshes, AreNotReadToTheirEndWhenTheyAreCalledOff) {
    const test::TemporaryFolder folder;
    const std::vector<std::string> paths = writeObjs(folder, 40);
    std::stop_source stop;
    const ImportControl control{[&](std::string_view, double share) {
                                    if (share > 0.2)
                                        stop.request_stop();
                                    EXPECT_LT(share, 0.9);
                                },
                                stop.get_token()};
    EXPECT_EQ(readMeshes(paths, control).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace eyrie::import
