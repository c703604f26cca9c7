// SPDX-License-Identifier: Apache-2.0
// Real PLY files of many programs: what each must give. Counts are the files' own.
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/pack_mesh.h"
#include "renderer/import/ply_reader.h"
#include "tests/renderer/import/mesh_text.h"

namespace eyrie::import {
namespace {

const std::string kData = EYRIE_SOURCE_DIR "/../shared/data/";

struct Sample {
    const char* path;
    std::uint64_t triangles;  // 0: refused
    std::uint64_t vertices;   // of the packed mesh
    const char* says;         // when refused
};

constexpr const char* kPoints = "zero faces";

const std::vector<Sample> kSamples = {
    {"hard/ply/assimp_crash-30d6d0f7.ply", 0, 0, "end_header"},
    {"hard/ply/assimp_cube.ply", 12, 8, ""},
    {"hard/ply/assimp_cube_binary.ply", 12, 8, ""},
    {"hard/ply/assimp_cube_binary_header_with_RN_newline.ply", 12, 8, ""},
    {"hard/ply/assimp_cube_uv.ply", 12, 24, ""},
    {"hard/ply/assimp_empty.ply", 0, 0, "empty"},
    {"hard/ply/assimp_float-color.ply", 1, 3, ""},
    {"hard/ply/assimp_issue623.ply", 0, 0, kPoints},
    {"hard/ply/assimp_points.ply", 0, 0, kPoints},
    {"hard/ply/assimp_pond.0_pointsonly.ply.zst", 0, 0, kPoints},
    {"hard/ply/cgal_building_points.ply.zst", 0, 0, kPoints},
    {"hard/ply/draco_Box.ply", 12, 24, ""},
    {"hard/ply/draco_cube_att.ply", 12, 24, ""},
    {"hard/ply/draco_cube_quads.ply", 12, 8, ""},
    {"hard/ply/draco_delim_test.ply", 12, 24, ""},
    {"hard/ply/draco_float_inf_point_cloud.ply", 0, 0, kPoints},
    {"hard/ply/draco_float_two_att_point_cloud.ply", 0, 0, kPoints},
    {"hard/ply/draco_int_point_cloud.ply", 0, 0, kPoints},
    {"hard/ply/draco_point_cloud_test_pos_norm.ply", 0, 0, kPoints},
    {"hard/ply/draco_test_extra_whitespace.ply", 1, 3, ""},
    {"hard/ply/draco_test_generic.ply", 224, 114, ""},
    {"hard/ply/draco_test_pos_color_ascii.ply", 224, 114, ""},
    {"hard/ply/happly_platonic_shelf.ply", 80, 50, ""},
    {"hard/ply/happly_platonic_shelf_ascii.ply", 80, 50, ""},
    {"hard/ply/happly_platonic_shelf_big_endian.ply", 80, 50, ""},
    {"hard/ply/igea_tristrips_intcount.ply.zst", 268686, 134345, ""},
    {"hard/ply/meshlab_T.ply", 36, 20, ""},
    {"hard/ply/meshlab_TextureDouble.ply", 4, 8, ""},
    {"hard/ply/meshlab_many_small_holes.ply", 3524, 2004, ""},
    {"hard/ply/meshlab_non_manif_hole.ply", 755, 432, ""},
    {"hard/ply/pepper_multitexture.ply.zst", 29956, 14980, ""},
    {"hard/ply/rply_input.ply", 1, 3, ""},
    {"hard/ply/stanford_bun045_rangegrid.ply.zst", 0, 0, "range_grid (204800)"},
    {"hard/ply/trimesh_BoxTextured.ply", 12, 24, ""},
    {"hard/ply/trimesh_cube_blender_uv.ply", 12, 24, ""},
    {"hard/ply/trimesh_mirror.ply", 286, 143, ""},
    {"hard/ply/trimesh_multi.ply", 2, 4, ""},
    {"hard/ply/trimesh_octagonal_pocket.ply", 3262, 1631, ""},
    {"hard/ply/trimesh_plane.ply", 2, 4, ""},
    {"hard/ply/trimesh_plane_tri.ply", 2, 4, ""},
    {"hard/ply/trimesh_ply_points_ascii.ply", 0, 0, kPoints},
    {"hard/ply/trimesh_ply_points_bin.ply", 0, 0, kPoints},
    {"hard/ply/trimesh_points_ascii_with_lists.ply", 0, 0, kPoints},
    {"hard/ply/trimesh_points_emptyascii.ply", 0, 0, kPoints},
    {"hard/ply/trimesh_points_emptyface.ply", 0, 0, kPoints},
    {"hard/ply/trimesh_reference.ply", 1610, 845, ""},
    {"meshes/bun_zipper.ply.zst", 69451, 34834, ""},
    {"meshes/dragon_vrip_res4.ply.gz", 11102, 5203, ""},
    {"meshes/horse_97k_bigendian.ply.zst", 96966, 48485, ""},
    {"meshes/rockerArm.ply.zst", 80354, 40177, ""},
    {"meshes/laurana_rangemap_lato000.ply.zst", 86766, 44269, ""},
};

class PlyFiles : public testing::TestWithParam<Sample> {};

TEST_P(PlyFiles, GiveTheirTrianglesOrAReason) {
    const std::string path = kData + GetParam().path;
    ASSERT_TRUE(std::filesystem::exists(path)) << "missing test data: " << path;
    auto mesh = parsePly(test::contentOf(path), path);
    if (GetParam().triangles == 0) {
        ASSERT_EQ(mesh.status().code(), absl::StatusCode::kInvalidArgument);
        EXPECT_THAT(std::string(mesh.status().message()), testing::HasSubstr(GetParam().says));
        return;
    }
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->triangles.size(), GetParam().triangles);
    mesh->images.resize(mesh->textures.size());  // as if they had been loaded
    PackCounts counts;
    const auto packed = packMesh(*std::move(mesh), counts, {.normals = NormalSource::File});
    ASSERT_TRUE(packed.ok()) << packed.status();
    EXPECT_EQ(packed->triangles.size() + counts.duplicateTriangles, GetParam().triangles);
    EXPECT_EQ(packed->positions.size(), GetParam().vertices);
}

INSTANTIATE_TEST_SUITE_P(OfManyPrograms, PlyFiles, testing::ValuesIn(kSamples));

TEST(PlyFiles, CoverEveryHardFile) {
    std::set<std::string> covered;
    for (const Sample& sample : kSamples) covered.insert(sample.path);
    for (const auto& entry : std::filesystem::directory_iterator(kData + "hard/ply")) {
        const std::string name = entry.path().filename().string();
        EXPECT_TRUE(name.ends_with(".png") || covered.contains("hard/ply/" + name)) << name;
    }
}

}  // namespace
}  // namespace eyrie::import
