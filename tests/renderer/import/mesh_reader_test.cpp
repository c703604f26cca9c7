// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/mesh_reader.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/renderer/import/ply_text.h"
#include "tests/renderer/import/small_models.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::HasSubstr;

TEST(MeshReader, BelievesTheContentMoreThanTheName) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("ply.stl"),
                    test::plyOf(test::tetrahedron(), test::Encoding::Ascii));
    test::writeFile(folder.file("jdn.obj"), test::kJdn);
    EXPECT_EQ(readMesh(folder.file("ply.stl"))->triangles.size(), 4U);
    EXPECT_EQ(readMesh(folder.file("jdn.obj"))->triangles.size(), 1U);
}

TEST(MeshReader, SaysWhatUnpacksAMeshThatIsPacked) {
    const test::TemporaryFolder folder;
    for (const auto& [name, unpacker] :
         {std::pair("dragon.ply.gz", "(gunzip)"), std::pair("a.OBJ.ZST", "(unzstd)")}) {
        EXPECT_TRUE(isMeshSource(name)) << "and no raster";
        test::writeFile(folder.file(name), "\x1f\x8b");
        const absl::Status refused = readMesh(folder.file(name)).status();
        EXPECT_TRUE(absl::IsInvalidArgument(refused)) << refused;
        EXPECT_THAT(std::string(refused.message()),
                    testing::AllOf(HasSubstr(name), HasSubstr(unpacker)));
    }
    EXPECT_FALSE(isMeshSource("dem.tif.gz")) << "GDAL reads that";
    EXPECT_FALSE(isMeshSource("heights.zip"));
}

TEST(MeshReader, StopsReadingAtTheMemoryThatItMayUse) {
    const test::TemporaryFolder folder;
    std::string text;
    for (int i = 1; i <= 100'000; ++i) {
        const std::string number = std::to_string(i);
        text += "v " + number + " 0 0\nv 0 " + number + " 0\nv 0 0 1\nf -1 -2 -3\n";
    }
    test::writeFile(folder.file("m.obj"), text);
    EXPECT_TRUE(readMesh(folder.file("m.obj")).ok());
    EXPECT_TRUE(readMesh(folder.file("m.obj"), {}, {.memoryBytes = 1ULL << 30}).ok());
    const auto mesh = readMesh(folder.file("m.obj"), {}, {.memoryBytes = 16ULL << 20});
    ASSERT_FALSE(mesh.ok());
#if defined(__SANITIZE_ADDRESS__)
    // It ends the process where memory runs out, which looks like a crash.
    EXPECT_THAT(std::string(mesh.status().message()), HasSubstr("m.obj"));
#else
    EXPECT_EQ(mesh.status().code(), absl::StatusCode::kResourceExhausted);
    EXPECT_THAT(
        std::string(mesh.status().message()),
        testing::AllOf(HasSubstr("m.obj"), HasSubstr("the 16 MB"), HasSubstr("allow more memory")));
#endif
}

TEST(MeshReader, HandsTheMemoryThatItMayUseToTheReaderOfJdn) {
    const test::TemporaryFolder folder;
    std::string text =
        "Number of Materials = 0\nNumber of Lights = 0\nNumber of Objects = 1\nMaterial ID = 0\n"
        "Num Vertices = 20000\nNum Faces = 1\n";
    for (int i = 0; i < 20'000; ++i) text += "Vert = 0 0 0\n";
    test::writeFile(folder.file("m.jdn"), text + "Face = 0 1 2\n");
    EXPECT_TRUE(readMesh(folder.file("m.jdn")).ok());
    const auto mesh = readMesh(folder.file("m.jdn"), {}, {.memoryBytes = 1ULL << 20});
    EXPECT_EQ(mesh.status().code(), absl::StatusCode::kResourceExhausted);
    EXPECT_THAT(std::string(mesh.status().message()),
                testing::AllOf(HasSubstr("m.jdn: reading it takes about 3 MiB")));
}

TEST(MeshReader, SaysNamesOfFilesInUtf8WithoutControlCharacters) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), test::kTexturedObj);
    const auto expectSaid = [&](const std::string& name, const std::string& said) {
        test::writeFile(folder.file("m.mtl"), "newmtl tiles\nmap_Kd " + name + "\n");
        EXPECT_THAT(readMesh(folder.file("m.obj"))->notes,
                    testing::Contains(HasSubstr("'" + said + "' is not there")));
    };
    expectSaid("D\xe4 cher.png", "D\\xe4 cher.png");
    expectSaid("D\xc3\xa4 cher.png", "D\xc3\xa4 cher.png");
    expectSaid("\x1b[2J\xc2\x9b.png", "\\x1b[2J\\xc2\\x9b.png");

    test::writeFile(folder.file("m.gltf"), R"({"buffers":[{"uri":"\u001b[2J","byteLength":4}],
"bufferViews":[{"buffer":0,"byteLength":4}],"accessors":[{"bufferView":0,"componentType":5120}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})");
    const absl::Status refused = readMesh(folder.file("m.gltf")).status();
    EXPECT_THAT(std::string(refused.message()), HasSubstr("'\\x1b[2J'"));
}

}  // namespace
}  // namespace eyrie::import
