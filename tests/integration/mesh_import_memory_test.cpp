// SPDX-License-Identifier: Apache-2.0
// Imports of meshes as people run them: how much memory they take.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/peak_memory.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

constexpr std::int64_t kMemory = std::int64_t{256} << 20;

template <typename T>
void put(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

class MeshImportProcess : public testing::Test {
protected:
    test::Peak peakOfImport(const std::vector<std::string>& files) const {
        std::vector<std::string> words{"import", "mesh"};
        words.insert(words.end(), files.begin(), files.end());
        for (const char* word : {"--memory", "256M", "--quiet", "-o"}) words.emplace_back(word);
        words.push_back(folder_.path("m.eym"));
        return test::peakOf(test::eyrieCommand(words));
    }

    test::TemporaryFolder folder_;
};

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // those take their own
TEST_F(MeshImportProcess, StaysWithinItsMemoryByParts) {
    const std::string ply = folder_.path("ball.ply");
    ASSERT_TRUE(test::succeeded({"synth", "mesh", "--size", "3000000", "-o", ply, "--quiet"}));
    const test::Peak peak = peakOfImport({ply});
    EXPECT_EQ(peak.status, 0);
    EXPECT_LE(peak.bytes, kMemory);
}

/// 10 million corners in 20 MB: half a gigabyte of triangles and arrays that grow.
TEST_F(MeshImportProcess, RefusesPolygonsBeforeTheyTakeMoreThanItMay) {
    std::string ply =
        "ply\nformat binary_little_endian 1.0\nelement vertex 5000\nproperty float x\n"
        "property float y\nproperty float z\nelement face 2000\n"
        "property list int ushort vertex_indices\nend_header\n";
    for (int i = 0; i < 5000; ++i) {  // on a parabola: all of it is convex
        put(ply, static_cast<float>(i));
        put(ply, static_cast<float>(i) * static_cast<float>(i) / 5000);
        put(ply, 0.0F);
    }
    for (int face = 0; face < 2000; ++face) {
        put(ply, 5000);
        for (int i = 0; i < 5000; ++i) put(ply, static_cast<std::uint16_t>(i));
    }
    const test::Peak peak = peakOfImport({folder_.write("polygons.ply", ply)});
    EXPECT_EQ(peak.status, 1);
    EXPECT_LE(peak.bytes, kMemory);
}

/// 32 files of 7.5 MB, together less than it may take; their meshes are half as much
/// again as that.
TEST_F(MeshImportProcess, RefusesFilesThatTogetherTakeMoreThanItMay) {
    constexpr std::uint32_t kTriangles = 150'000;
    std::string stl(80, ' ');
    put(stl, kTriangles);
    for (std::uint32_t i = 0; i < kTriangles; ++i) {
        for (int k = 0; k < 3; ++k) put(stl, 0.0F);  // the normal
        for (int corner = 0; corner < 3; ++corner) {
            put(stl, static_cast<float>(i % 1000) + (corner == 1 ? 1.0F : 0.0F));
            put(stl, static_cast<float>(i / 1000) + (corner == 2 ? 1.0F : 0.0F));
            put(stl, 0.0F);
        }
        put(stl, std::uint16_t{0});
    }
    std::vector<std::string> files{folder_.write("0.stl", stl)};
    for (int i = 1; i < 32; ++i) {
        files.push_back(folder_.path(std::to_string(i) + ".stl"));
        std::filesystem::create_hard_link(files[0], files.back());
    }
    const test::Peak peak = peakOfImport(files);
    EXPECT_EQ(peak.status, 1);
    EXPECT_LE(peak.bytes, 2 * kMemory) << "arrays are copied while they grow";
}
#endif

}  // namespace
}  // namespace eyrie
