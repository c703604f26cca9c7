// SPDX-License-Identifier: Apache-2.0
// What belongs to the source of a mesh.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/mesh_reader.h"
#include "renderer/mesh/eym_format.h"
#include "tests/renderer/import/small_models.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::HasSubstr;

TEST(MeshSourceHash, IsThatOfALoneFileAndCountsItsCompany) {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("m.obj");
    test::writeFile(path, test::kObj);
    const std::vector<std::string> paths = {path};
    const auto alone = meshSourceHash(paths);
    ASSERT_TRUE(alone.ok()) << alone.status();
    EXPECT_EQ(*alone, *mesh::contentHash(path));
    test::writeFile(folder.file("m.mtl"), test::kMtl);
    const std::uint64_t red = *meshSourceHash(paths);
    test::writeFile(folder.file("m.mtl"), "newmtl red\nKd 0 1 0\n");
    const std::uint64_t green = *meshSourceHash(paths);
    EXPECT_TRUE(red != *alone && green != *alone && red != green);
    test::writeFile(folder.file("m.mtl"), "newmtl red\nmap_Kd m.png\n");
    const std::uint64_t untextured = *meshSourceHash(paths);
    test::writeFile(folder.file("m.png"), "a");
    EXPECT_NE(untextured, *meshSourceHash(paths));
    test::writeFile(folder.file("m.mtl"), "newmtl red\nmap_Kd -s 2 2 2 m.png\n");
    const std::uint64_t scaled = *meshSourceHash(paths);
    test::writeFile(folder.file("m.png"), "b");
    EXPECT_NE(scaled, *meshSourceHash(paths));
    test::writeFile(folder.file("m.mtl"), "newmtl red\nmap_kd m.png\n");
    const std::uint64_t lowerCase = *meshSourceHash(paths);
    test::writeFile(folder.file("m.png"), "c");
    EXPECT_NE(lowerCase, *meshSourceHash(paths));
}

TEST(MeshSourceHash, CountsTexturesOfPly) {
    const test::TemporaryFolder folder;
    const std::vector<std::string> paths = {folder.file("m.ply")};
    test::writeFile(paths[0], test::kTexturedPly);
    const std::uint64_t alone = *meshSourceHash(paths);
    EXPECT_EQ(alone, *mesh::contentHash(paths[0]));
    test::writeFile(folder.file("m_A.png"), "a");
    const std::uint64_t with = *meshSourceHash(paths);
    test::writeFile(folder.file("m_A.png"), "b");
    EXPECT_TRUE(with != alone && with != *meshSourceHash(paths));
}

TEST(MeshSourceHash, CountsBuffersOfGltf) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.gltf"), R"({"buffers": [{"uri" : "m.bin"}]})");
    const std::vector<std::string> paths = {folder.file("m.gltf")};
    test::writeFile(folder.file("m.bin"), "a");
    const std::uint64_t before = *meshSourceHash(paths);
    test::writeFile(folder.file("m.bin"), "b");
    EXPECT_NE(before, *meshSourceHash(paths));
}

TEST(MeshSourceHash, CountsTexturesThatAreNamedAnyhow) {
    const test::TemporaryFolder folder;
    const auto expectCounted = [&](const std::string& name, std::string_view text) {
        SCOPED_TRACE(text);
        const std::vector<std::string> paths = {folder.file(name)};
        test::writeFile(paths[0], std::string(text));
        test::writeFile(folder.file("a wall.PNG"), "a");
        const std::uint64_t before = *meshSourceHash(paths);
        test::writeFile(folder.file("a wall.PNG"), "b");
        EXPECT_NE(before, *meshSourceHash(paths));
    };
    using namespace std::string_view_literals;
    expectCounted("m.dae", "<init_from>./maps/a%20wall.png</init_from>");
    expectCounted("m.x3d", R"(<ImageTexture url='"a wall.png" "http://b.c/wall.png"'/>)");
    expectCounted("m.x3d", R"(<ImageTexture url="&quot;a wall.png&quot;"/>)");
    expectCounted("m.fbx", R"(RelativeFilename: "..\maps\a wall.png")");
    expectCounted("m.fbx", "\x10RelativeFilenameS\x0A\0\0\0a wall.PNG\0\0"sv);
    expectCounted("m.3ds", "\x00\xA3\x11\0\0\0a wall.png\0\x51\xA3"sv);
    expectCounted("m.glb", R"({"images":[{"uri":"a%20wall.png"}]})");
    const std::vector<std::string> paths = {folder.file("m.dae")};
    for (const std::string_view text : {"", ".", ".png", ">.png", "a wall.pn", "a wall.pngs"}) {
        test::writeFile(paths[0], std::string(text));
        EXPECT_EQ(*meshSourceHash(paths), *mesh::contentHash(paths[0])) << text;
    }
}

TEST(MeshSource, IsToldByItsName) {
    for (const char* name : {"a.ply", "a.PLY", "a.jdn", "a.Obj", "x/a.glb", "a.acc", "a.IFC"})
        EXPECT_TRUE(isMeshSource(name)) << name;
    for (const char* name : {"a.tif", "a", "ply", "a.tif.gz", "a.ter", "a.obj/x"})
        EXPECT_FALSE(isMeshSource(name)) << name;
    EXPECT_THAT(meshSourceEndings(), HasSubstr(".glb"));
}

}  // namespace
}  // namespace eyrie::import
