// SPDX-License-Identifier: Apache-2.0
// How exactly an imported mesh keeps its source's positions.
#include <array>
#include <bit>
#include <cstdint>
#include <set>

#include <gtest/gtest.h>

#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_synth.h"
#include "renderer/mesh/eym_format.h"
#include "tests/renderer/import/ply_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

TEST(MeshImport, StoresTinyDetailsBesideHugeDistancesWithinTheStatedError) {
    const test::TemporaryFolder folder;
    TriangleMesh source = test::tetrahedron();
    source.positions = {{1e-6, 0, 0}, {1e12, 0, 0}, {0, 1e12, 1e-6}, {0, 0, 1e6}};
    const auto report = importMesh(source, folder.file("m.eym"));
    ASSERT_TRUE(report.ok()) << report.status();
    EXPECT_NEAR(mesh::EymFile::open(folder.file("m.eym"))->bounds().max.x, 1e12,
                report->errorMetres);
}

TEST(MeshImport, WithFewerBitsMakesASmallerFileWithWhatItRoundsInTheBound) {
    const test::TemporaryFolder folder;
    const TriangleMesh source = synthesizeMesh(20000, 3);
    const auto fine = importMesh(source, folder.file("fine.eym"));
    const auto coarse =
        importMesh(source, folder.file("coarse.eym"), {.pack = {.latticeBits = 12}});
    ASSERT_TRUE(fine.ok() && coarse.ok()) << fine.status() << coarse.status();
    EXPECT_LT(coarse->bytes, fine->bytes * 3 / 4);
    EXPECT_EQ(coarse->stepMetres, fine->stepMetres * 512);
    const auto file = mesh::EymFile::open(folder.file("coarse.eym"));
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_EQ(file->lattice().stepMetres, coarse->stepMetres);
    for (const mesh::Node& node : file->nodes())
        EXPECT_GE(static_cast<double>(node.errorMetres), file->lattice().errorMetres());
    EXPECT_EQ(
        importMesh(source, folder.file("none.eym"), {.pack = {.latticeBits = 22}}).status().code(),
        absl::StatusCode::kInvalidArgument);
}

TEST(MeshImport, LosslessKeepsEverySourcePositionOfAFloatFileToTheBit) {
    const test::TemporaryFolder folder;
    TriangleMesh source = synthesizeMesh(20000, 3);
    for (fabric::Vec3& p : source.positions)
        for (int axis = 0; axis < 3; ++axis) {
            // g++ 12 leaves out rounding to float and back where it vectorises it.
            const volatile float rounded = static_cast<float>(p[axis]);
            p[axis] = static_cast<double>(rounded);
        }
    const auto without = importMesh(source, folder.file("m.eym"));
    const auto report = importMesh(source, folder.file("m.eym"), {.pack = {.keepsExact = true}});
    ASSERT_TRUE(without.ok() && report.ok()) << report.status();
    EXPECT_LT(report->bytes, without->bytes + 6 * report->vertices);  // half of three floats
    const auto file = mesh::EymFile::open(folder.file("m.eym"));
    ASSERT_TRUE(file.ok() && file->hasExactPositions()) << file.status();
    using Bits = std::array<std::uint64_t, 3>;
    const auto bits = [](const fabric::Vec3& p) {
        return std::bit_cast<Bits>(std::array{p.x, p.y, p.z});
    };
    std::set<Bits> expected, found;
    for (const auto& triangle : source.triangles)
        for (const std::uint32_t corner : triangle) expected.insert(bits(source.positions[corner]));
    for (std::uint32_t node = 0; node < file->nodes().size(); ++node) {
        if (!file->nodes()[node].isLeaf())
            continue;
        const auto exact = file->exactPositions(node);
        ASSERT_TRUE(exact.ok()) << exact.status();
        for (const fabric::Vec3& p : *exact) found.insert(bits(p));
    }
    EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace eyrie::import
