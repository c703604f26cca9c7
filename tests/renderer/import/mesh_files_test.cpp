// SPDX-License-Identifier: Apache-2.0
// Real mesh files, many of them broken: what each must give. Counts are the files' own, as other
// programs read them (shared/data/README.md), or were looked at one by one.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/mesh_reader.h"
#include "renderer/import/pack_mesh.h"
#include "renderer/mesh/vertex_packing.h"
#include "tests/renderer/import/mesh_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

namespace fs = std::filesystem;

const std::string kData = EYRIE_SOURCE_DIR "/../shared/data/";

struct Sample {
    const char* name;
    std::uint64_t triangles;  // stored; 0: refused
    std::uint64_t leftOut = 0;
    const char* says = "";  // when refused
};

const std::vector<Sample> kHard = {
    {"assimp_invalid.off", 0, 0, "none with any area"},
    {"assimp_malformed.obj", 0, 0, "Invalid face index"},
    {"cgal_ALSTOM_TEST4.off", 2033},
    {"cgal_b9.ply", 0, 0, "zero faces"},
    {"cgal_blobby-shuffled.off", 4048},
    {"cgal_boeing.off", 2564},
    {"cgal_colored_tetra.ply", 4},
    {"cgal_couplingdown.off", 3714},
    {"cgal_cube-ouvert.off", 10},
    {"cgal_cylinder_locally_refined.off", 16442},
    {"cgal_degtri_sliding.off", 4, 4},
    {"cgal_ellipe0.003.off", 3108},
    {"cgal_fold.off", 12},
    {"cgal_hole.off", 40},
    {"cgal_in.off", 2},
    {"cgal_mech-holes-shark.off", 10192},
    {"cgal_negative.off", 6},
    {"cgal_oblong-shuffled.off", 838},
    {"cgal_polygon_mesh.off", 32245},
    {"cgal_quint_tris.off", 20},
    {"cgal_refined_elephant.off.zst", 88928},
    {"cgal_star.off", 24},
    {"cgal_tetra_intersected_by_triangle.off", 5},
    {"draco_deg_faces.obj", 3, 1},
    {"draco_degenerate_mesh.obj", 0, 0, "none with any area"},
    {"draco_empty_name.obj", 1},
    {"draco_eof_test.obj", 1},
    {"draco_extra_vertex.obj", 3},
    {"draco_multiple_isolated_triangles.obj", 5},
    {"draco_non_manifold_wrap.obj", 12},
    {"draco_octagon_preserved.obj", 6},
    {"draco_test_wrong_attribute_mapping.obj", 1},
    {"draco_triangle_with_degenerate_tex_coords.obj", 1},
    {"libigl_TinyTorus.obj", 48},
    {"libigl_cube_with_fold.ply", 48},
    {"libigl_degenerated.obj", 24},
    {"libigl_marching_tets_output.obj", 4926},
    {"libigl_truck.obj", 4770},
    {"libigl_two-boxes-bad-self-union.ply", 708},
    {"meshlab_block.off", 4272},
    {"meshlab_trim-star.off", 10384},
    {"sponza_crytek_truncated.obj.zst", 33663},
    {"trimesh_busted.STL", 3878},
    {"trimesh_jacked.obj", 12},
    {"trimesh_nancolor.obj", 12},
    {"trimesh_negative_indices.obj", 12},
    {"trimesh_not_convex.obj", 96},
    {"trimesh_origin_inside.STL", 28},
    {"trimesh_soup.stl", 100},
    {"trimesh_two_objects.obj", 16},
    {"trimesh_wallhole.obj", 57, 9},
};

/// The file itself, or in `folder` what it is packed from.
std::string unpacked(const std::string& path, const test::TemporaryFolder& folder) {
    if (!path.ends_with(".zst"))
        return path;
    const std::string name = folder.file(fs::path(path).stem().string());
    test::writeFile(name, test::contentOf(path));
    return name;
}

class MeshFiles : public testing::TestWithParam<Sample> {};

TEST_P(MeshFiles, GiveTheirTrianglesOrAReason) {
    const test::TemporaryFolder folder;
    const std::string path = kData + "hard/mesh/" + GetParam().name;
    ASSERT_TRUE(fs::exists(path)) << "missing test data: " << path;
    auto mesh = readMesh(unpacked(path, folder));
    PackCounts counts;
    const auto packed = mesh.ok() ? packMesh(*std::move(mesh), counts)
                                  : absl::StatusOr<mesh::PackedMesh>(mesh.status());
    if (GetParam().triangles == 0) {
        ASSERT_EQ(packed.status().code(), absl::StatusCode::kInvalidArgument);
        EXPECT_THAT(std::string(packed.status().message()), testing::HasSubstr(GetParam().says));
        return;
    }
    ASSERT_TRUE(packed.ok()) << packed.status();
    EXPECT_EQ(packed->triangles.size(), GetParam().triangles);
    EXPECT_EQ(counts.degenerateTriangles + counts.duplicateTriangles, GetParam().leftOut);
}

INSTANTIATE_TEST_SUITE_P(OfManyPrograms, MeshFiles, testing::ValuesIn(kHard));

TEST(MeshFiles, CoverEveryHardFile) {
    std::set<std::string> covered;
    for (const Sample& sample : kHard) covered.insert(sample.name);
    for (const auto& entry : fs::directory_iterator(kData + "hard/mesh"))
        EXPECT_TRUE(covered.contains(entry.path().filename().string())) << entry.path();
}

struct Soup {
    const char* archive;
    const char* unpack;  // in an empty folder; {} is the archive
    const char* name;
    std::uint64_t triangles;
    std::uint64_t leftOut;
    double heightMetres;
};

class Soups : public testing::TestWithParam<Soup> {};

TEST_P(Soups, StandUprightWithAllTheirTriangles) {
    const test::TemporaryFolder folder;
    const std::string archive = kData + "scenes/" + GetParam().archive;
    ASSERT_TRUE(fs::exists(archive)) << "missing test data: " << archive;
    std::string command = GetParam().unpack;
    command.replace(command.find("{}"), 2, "'" + archive + "'");
    test::outputOf("cd '" + folder.file("") + "' && " + command);
    auto mesh = readMesh(folder.file(GetParam().name));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->colours.size(), mesh->positions.size());
    PackCounts counts;
    const auto packed = packMesh(*std::move(mesh), counts);
    ASSERT_TRUE(packed.ok()) << packed.status();
    EXPECT_EQ(packed->triangles.size(), GetParam().triangles);
    EXPECT_EQ(counts.degenerateTriangles + counts.duplicateTriangles, GetParam().leftOut);
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const std::uint64_t position : packed->positions) {
        const double z = packed->lattice.metres(mesh::unpackPosition(position)).z;
        low = std::min(low, z);
        high = std::max(high, z);
    }
    EXPECT_NEAR(high - low, GetParam().heightMetres, 0.01 * GetParam().heightMetres);
}

constexpr const char* kTracks = "torcs_24tracks_geometry_acc.tar.xz";

INSTANTIATE_TEST_SUITE_P(
    Scenes, Soups,
    testing::Values(Soup{kTracks, "tar -xJf {}", "street-1/street-1.acc", 25506, 2, 126.1},
                    Soup{kTracks, "tar -xJf {}", "spring/spring.acc", 62875, 0, 198.6},
                    Soup{"Ifc2x3_Duplex_Architecture.ifc.zst", "zstd -qdo x.ifc {}", "x.ifc", 26686,
                         69, 8.18},
                    Soup{"LittlestTokyo.glb", "cp {} x.glb", "x.glb", 141415, 387, 599}));

TEST(Soups, AreTheSameHouseAsObjAsOnItsSide) {
    const test::TemporaryFolder folder;
    const std::string archive = kData + "scenes/duplex_architecture_obj.tar.zst";
    ASSERT_TRUE(fs::exists(archive)) << "missing test data: " << archive;
    test::outputOf("tar --zstd -C '" + folder.file("") + "' -xf '" + archive + "'");
    const auto mesh = readMesh(folder.file("duplex.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    std::set<std::uint32_t> colours;
    double low = 0, high = 0;
    for (std::size_t i = 0; i < mesh->positions.size(); ++i) {
        colours.insert(mesh::packColour(mesh->colours[i]));
        low = std::min(low, mesh->positions[i].y);
        high = std::max(high, mesh->positions[i].y);
    }
    EXPECT_NEAR(high - low, 8.18, 0.01);  // an OBJ does not say which way is up
    EXPECT_GT(colours.size(), 8U);        // of 16 materials
}

}  // namespace
}  // namespace eyrie::import
