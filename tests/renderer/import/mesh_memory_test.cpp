// SPDX-License-Identifier: Apache-2.0
// What importing a mesh takes in memory, and what is done or said where that is too much.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_import_parts.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::HasSubstr;

TEST(MeshImport, ThatWouldTakeMoreMemoryThanItMayGoesByPartsOrSaysWhatItTakes) {
    const test::TemporaryFolder folder;
    const MeshImportOptions little{.memoryBytes = kLeastMeshMemory};
    // What fits is known from the header: the first does, but not beside the program. Of their
    // faces one has corners.
    for (const std::uintmax_t faces : {3'000'000, 5'000'000}) {
        test::writeFile(folder.file("m.ply"),
                        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
                        "property float y\nproperty float z\nelement face " +
                            std::to_string(faces) +
                            "\nproperty list uchar int vertex_indices\nend_header\n" +
                            std::string(12, '\0') + '\4');
        std::filesystem::resize_file(folder.file("m.ply"), faces + 500);
        const auto parted = importMesh({folder.file("m.ply")}, folder.file("m.eym"), little);
        EXPECT_THAT(
            std::string(parted.status().message()),
            testing::AllOf(HasSubstr("m.ply"), HasSubstr("found 4"), HasSubstr("triangulate")))
            << faces;
    }
    MeshImportOptions orienting = little;
    orienting.pack.orients = true;
    const auto refused = importMesh({folder.file("m.ply")}, folder.file("m.eym"), orienting);
    EXPECT_EQ(refused.status().code(), absl::StatusCode::kResourceExhausted);
    EXPECT_THAT(std::string(refused.status().message()),
                testing::AllOf(HasSubstr("m.ply"), HasSubstr("310 MiB"), HasSubstr("may use 256"),
                               HasSubstr("leave that out")));
    test::writeFile(folder.file("m.obj"), "v 0 0 0\n");
    std::filesystem::resize_file(folder.file("m.obj"), std::uint64_t{300} << 20);
    const auto whole = importMesh({folder.file("m.obj")}, folder.file("m.eym"), little);
    EXPECT_EQ(whole.status().code(), absl::StatusCode::kResourceExhausted);
    EXPECT_THAT(std::string(whole.status().message()),
                testing::AllOf(HasSubstr("m.obj"), HasSubstr("301 MiB"), HasSubstr("PLY")));
    EXPECT_THAT(folder.names(), testing::UnorderedElementsAre("m.ply", "m.obj"));
}

/// The header of one of faces of so many corners says little of its triangles.
TEST(MeshImport, AdvisesToTriangulateAPlyWhoseFacesHaveManyCorners) {
    constexpr int kCorners = 64;
    constexpr int kFaces = 75'000;
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 64\nproperty float x\nproperty float y\n"
        "property float z\nelement face 75000\nproperty list uchar uchar vertex_indices\n"
        "end_header\n";
    std::string face = "64";
    for (int i = 0; i < kCorners; ++i) {
        const double angle = 2 * std::numbers::pi * i / kCorners;
        text += std::to_string(std::cos(angle)) + ' ' + std::to_string(std::sin(angle)) + " 0\n";
        face += ' ' + std::to_string(i);
    }
    for (int i = 0; i < kFaces; ++i) text += face + '\n';
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.ply"), text);
    const auto report =
        importMesh({folder.file("m.ply")}, folder.file("m.eym"), {.memoryBytes = kLeastMeshMemory});
    EXPECT_EQ(report.status().code(), absl::StatusCode::kResourceExhausted);
    EXPECT_THAT(std::string(report.status().message()),
                testing::AllOf(HasSubstr("m.ply"), HasSubstr("may use 256"),
                               HasSubstr("triangulate it"), testing::Not(HasSubstr("convert"))));
}

TEST(MeshImport, KnowsThatTrianglesWhichShareNoCornersTakeMoreMemory) {
    constexpr std::uint64_t kTriangles = 2'000'000;
    constexpr std::uint64_t kFileBytes = 98'000'000;
    // Measured: 652 MiB, of which about 160 are for the program and its buffers.
    EXPECT_GT(importBytes(kTriangles, 3 * kTriangles, kFileBytes, {}), std::uint64_t{492} << 20);
    EXPECT_LT(importBytes(kTriangles, kTriangles / 2, kFileBytes, {}), std::uint64_t{256} << 20);
    constexpr std::uint64_t kMemory = std::uint64_t{1} << 30;
    EXPECT_LT(trianglesAtOnce(kMemory, kTriangles, 3 * kTriangles, {}),
              trianglesAtOnce(kMemory, kTriangles, kTriangles / 2, {}) / 2);
}

TEST(MeshImport, KnowsThatTexturedTrianglesTakeMoreMemory) {
    constexpr std::uint64_t kTriangles = 500'000;
    // Measured: 175 MiB, of which about 55 are for the program; 24 are the file.
    EXPECT_GT(importBytes(kTriangles, 300'000, std::uint64_t{24} << 20, {}, true),
              std::uint64_t{115} << 20);
    EXPECT_LT(importBytes(kTriangles, 300'000, std::uint64_t{24} << 20, {}),
              std::uint64_t{64} << 20);
}

/// One colour, in runs of 128 texels: two megabytes.
std::string largestTga() {
    std::string file("\0\0\12\0\0\0\0\0\0\0\0\0\0\x20\0\x20\x18\x20", 18);
    constexpr int kRuns = 8192 * 8192 / 128;
    for (int i = 0; i < kRuns; ++i) file += "\xFF\x10\x20\x30";
    return file;
}

TEST(MeshImport, RefusesTexturesThatTakeMoreMemoryThanItMay) {
    const test::TemporaryFolder folder;
    std::string materials, mesh = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 1\n";
    for (const std::string name : {"a", "b", "c"}) {
        test::writeFile(folder.file(name + ".tga"), largestTga());
        materials += "newmtl " + name + "\nmap_Kd " + name + ".tga\n";
        mesh += "usemtl " + name + "\nf 1/1 2/2 3/1\n";
    }
    test::writeFile(folder.file("m.mtl"), materials);
    test::writeFile(folder.file("m.obj"), mesh);
    const auto report =
        importMesh({folder.file("m.obj")}, folder.file("m.eym"), {.memoryBytes = kLeastMeshMemory});
    EXPECT_EQ(report.status().code(), absl::StatusCode::kResourceExhausted);
    EXPECT_THAT(std::string(report.status().message()),
                testing::AllOf(HasSubstr("m.obj"), HasSubstr("its 3 textures takes about 641 MiB"),
                               HasSubstr("may use 256"), HasSubstr("allow more")));
}

}  // namespace
}  // namespace eyrie::import
