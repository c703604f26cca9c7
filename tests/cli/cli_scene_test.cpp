// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include "cli/data_cache.h"
#include "cli/placement.h"
#include "cli/scene_files.h"
#include "cli/text_file.h"
#include "fabric/status.h"
#include "renderer/import/geotiff_writer.h"
#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_synth.h"
#include "renderer/import/ply_writer.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/terrain/eyt_format.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kPosts = 200;

/// A slope that rises to the east, with its south-west post at (500000, 5200000).
std::string writeSlope(const test::TemporaryFolder& folder, int metresPerPost = 10) {
    terrain::HeightGrid grid{.columns = kPosts,
                             .rows = kPosts,
                             .heights = {},
                             .origin = {500000, 5200000},
                             .perColumn = {30, 0},
                             .perRow = {0, 30}};
    for (int j = 0; j < kPosts; ++j)
        for (int i = 0; i < kPosts; ++i)
            grid.heights.push_back(static_cast<float>(metresPerPost * i));
    const std::string path = folder.path("slope.tif");
    EXPECT_TRUE(import::writeGeoTiff(grid, path).ok());
    return path;
}

std::string writeBall(const test::TemporaryFolder& folder, std::uint64_t seed = 1) {
    const std::string path = folder.path("ball.ply");
    EXPECT_TRUE(import::writePly(import::synthesizeMesh(2000, seed), path).ok());
    return path;
}

class SceneFiles : public testing::Test {
protected:
    absl::StatusOr<fabric::Scene> assemble(const std::vector<std::string>& paths) {
        ASSIGN_OR_RETURN(NamedScene named, assembleScene(paths, cache_, notes_));
        asNamed_ = std::move(named.asNamed);
        return std::move(named.scene);
    }
    /// Each has its record beside it.
    std::size_t importsKept() const {
        const fs::path imports = folder_.path() / "imports";
        return fs::exists(imports)
                   ? static_cast<std::size_t>(std::count_if(
                         fs::directory_iterator(imports), fs::directory_iterator(),
                         [](const auto& entry) { return entry.path().extension() != ".source"; }))
                   : 0;
    }

    test::TemporaryFolder folder_;
    DataCache cache_{folder_.path() / "imports", ProgressBar::Style::Quiet, {}};
    std::vector<std::string> notes_;
    fabric::Scene asNamed_;  ///< what was assembled last
};

TEST(DataFileOf, TellsFilesByTheirEndingInAnyCase) {
    EXPECT_EQ(dataFileOf("a/b.json"), DataFile::Scene);
    EXPECT_EQ(dataFileOf("b.eyt"), DataFile::Terrain);
    EXPECT_EQ(dataFileOf("b.eym"), DataFile::Mesh);
    EXPECT_EQ(dataFileOf("B.PLY"), DataFile::MeshSource);
    EXPECT_EQ(dataFileOf("b.Obj"), DataFile::MeshSource);
    EXPECT_EQ(dataFileOf("b.tif.gz"), DataFile::TerrainSource);
}

TEST_F(SceneFiles, AnObjIsImportedAgainWhenItsMaterialsChange) {
    const std::string obj = folder_.path("m.obj");
    std::ofstream(obj) << "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    std::ofstream(folder_.path("m.mtl")) << "newmtl a\nKd 1 0 0\n";
    const auto red = cache_.dataFor(obj, fabric::ObjectKind::Mesh);
    ASSERT_TRUE(red.ok()) << red.status();
    EXPECT_EQ(*cache_.dataFor(obj, fabric::ObjectKind::Mesh), *red);
    std::ofstream(folder_.path("m.mtl")) << "newmtl a\nKd 0 1 0\n";
    EXPECT_NE(*cache_.dataFor(obj, fabric::ObjectKind::Mesh), *red);
}

TEST_F(SceneFiles, ASourceIsImportedOnceForTheSameContent) {
    const std::string ball = writeBall(folder_);
    const auto first = cache_.dataFor(ball, fabric::ObjectKind::Mesh);
    ASSERT_TRUE(first.ok()) << first.status();
    const auto made = fs::last_write_time(*first);
    fs::copy_file(ball, folder_.path("copy.ply"));
    const auto second = cache_.dataFor(folder_.path("copy.ply"), fabric::ObjectKind::Mesh);
    ASSERT_TRUE(second.ok()) << second.status();
    EXPECT_EQ(*second, *first);
    EXPECT_EQ(fs::last_write_time(*second), made);
}

TEST_F(SceneFiles, ChangedContentIsImportedAnew) {
    const auto first = cache_.dataFor(writeBall(folder_, 1), fabric::ObjectKind::Mesh);
    const auto second = cache_.dataFor(writeBall(folder_, 2), fabric::ObjectKind::Mesh);
    ASSERT_TRUE(first.ok() && second.ok());
    EXPECT_NE(*first, *second);
    EXPECT_EQ(importsKept(), 2U);
}

/// SRTM's files say by their names alone where they lie.
TEST_F(SceneFiles, TheSameHeightsElsewhereAreAnotherImport) {
    const std::string heights(std::size_t{2} * 1201 * 1201, '\1');
    std::vector<std::string> imports;
    for (const char* name : {"N00E006.hgt", "N00E007.hgt"}) {
        std::ofstream(folder_.path(name)) << heights;
        const auto made = cache_.dataFor(folder_.path(name), fabric::ObjectKind::Terrain);
        ASSERT_TRUE(made.ok()) << made.status();
        imports.push_back(*made);
    }
    EXPECT_NE(imports[0], imports[1]);
}

TEST_F(SceneFiles, ADamagedImportIsMadeAgain) {
    const std::string ball = writeBall(folder_);
    const auto data = cache_.dataFor(ball, fabric::ObjectKind::Mesh);
    ASSERT_TRUE(data.ok());
    fs::resize_file(*data, 100);
    ASSERT_TRUE(cache_.dataFor(ball, fabric::ObjectKind::Mesh).ok());
    EXPECT_TRUE(mesh::EymFile::open(*data).ok());
}

/// As where a source was another one for as long as it was imported.
TEST_F(SceneFiles, AnImportOfOtherContentThanItsNameSaysIsMadeAgain) {
    const std::string ball = writeBall(folder_);
    const std::string larger = folder_.path("larger.ply");
    ASSERT_TRUE(import::writePly(import::synthesizeMesh(4000, 1), larger).ok());
    const auto small = cache_.dataFor(ball, fabric::ObjectKind::Mesh);
    const auto large = cache_.dataFor(larger, fabric::ObjectKind::Mesh);
    ASSERT_TRUE(small.ok() && large.ok());
    const std::uint64_t triangles = mesh::EymFile::open(*small)->triangleCount();
    fs::copy_file(*large, *small, fs::copy_options::overwrite_existing);
    const auto again = cache_.dataFor(ball, fabric::ObjectKind::Mesh);
    ASSERT_TRUE(again.ok()) << again.status();
    EXPECT_EQ(mesh::EymFile::open(*again)->triangleCount(), triangles);
}

TEST_F(SceneFiles, WhatAKilledImportLeftIsClearedAway) {
    fs::create_directory(folder_.path("imports"));
    const std::string left = folder_.write("imports/a.eym.partial-0123456789abcdef", "half");
    ASSERT_TRUE(cache_.dataFor(writeBall(folder_), fabric::ObjectKind::Mesh).ok());
    EXPECT_FALSE(fs::exists(left));
    EXPECT_EQ(importsKept(), 1U);
}

/// As on another machine, or in another container, where process ids are others.
TEST_F(SceneFiles, WhatALivingImportWritesStaysThoughNoProcessHereIsKnownForIt) {
    fs::create_directory(folder_.path("imports"));
    const std::string written = folder_.write("imports/b.eym.partial-0000000040000000", "half");
    const int fd = open(written.c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_EQ(flock(fd, LOCK_EX | LOCK_NB), 0);
    ASSERT_TRUE(cache_.dataFor(writeBall(folder_), fabric::ObjectKind::Mesh).ok());
    EXPECT_TRUE(fs::exists(written));
    close(fd);
}

TEST_F(SceneFiles, ASourceThatCannotBeImportedLeavesNothingInTheCache) {
    const std::string wrong = folder_.write("wrong.ply", "ply\nnonsense\n");
    EXPECT_TRUE(absl::IsInvalidArgument(cache_.dataFor(wrong, fabric::ObjectKind::Mesh).status()));
    EXPECT_EQ(importsKept(), 0U);
}

TEST_F(SceneFiles, AMeshIsImportedWithinTheMemoryThatItMayTake) {
    const std::string ball = writeBall(folder_);
    const std::string large = folder_.write("large.obj", "v 0 0 0\n");
    fs::resize_file(large, import::kLeastMeshMemory + 1);
    DataCache cache(folder_.path("imports"), ProgressBar::Style::Quiet, {}, {},
                    import::kLeastMeshMemory);
    EXPECT_TRUE(cache.dataFor(ball, fabric::ObjectKind::Mesh).ok());
    const absl::Status refused = cache.dataFor(large, fabric::ObjectKind::Mesh).status();
    EXPECT_TRUE(absl::IsResourceExhausted(refused)) << refused;
    EXPECT_THAT(refused.ToString(), testing::HasSubstr("eyrie import mesh --memory"));
}

TEST_F(SceneFiles, PathsStartAtTheSceneFilesFolder) {
    writeBall(folder_);
    fs::create_directory(folder_.path("scenes"));
    const std::string scene = folder_.write(
        "scenes/a.json", R"({"objects":[{"mesh":"../ball.ply"}],"background":[1,0,0]})");
    const auto read = readSceneFile(scene);
    ASSERT_TRUE(read.ok()) << read.status();
    EXPECT_EQ(read->objects.front().path, folder_.path("ball.ply"));
    const auto assembled = assemble({scene});
    ASSERT_TRUE(assembled.ok()) << assembled.status();
    EXPECT_EQ(fs::path(assembled->objects.front().path).extension(), ".eym");
    EXPECT_EQ(assembled->background, (fabric::Rgba{255, 0, 0, 255}));
}

TEST_F(SceneFiles, WhatLiesAtAnAddressIsNotLookedForInTheirFolder) {
    const std::string scene =
        folder_.write("a.json", R"({"objects":[{"terrain":"https://a.example/dem.tif",)"
                                R"("imagery":["https://a.example/ground.tif","ground.tif"]}]})");
    const auto read = readSceneFile(scene);
    ASSERT_TRUE(read.ok()) << read.status();
    EXPECT_EQ(read->objects.front().path, "https://a.example/dem.tif");
    EXPECT_EQ(
        read->objects.front().imagery,
        (std::vector<std::string>{"https://a.example/ground.tif", folder_.path("ground.tif")}));
}

TEST_F(SceneFiles, AddressesThatAreNotReadAreNoFilesThatAreMissing) {
    const std::string scene =
        folder_.write("a.json", R"({"objects":[{"terrain":"S3://bucket/dem.eyt"}]})");
    for (const absl::Status& refused :
         {readSceneFile(scene).status(), assemble({"s3://bucket/dem.eyt"}).status(),
          assemble({"s3://bucket/dem.tif"}).status()}) {
        EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument);
        EXPECT_THAT(refused.ToString(), testing::HasSubstr("write /vsis3/bucket/dem."));
    }
}

/// From a link the system goes up to where its target lies.
TEST_F(SceneFiles, WhatIsNamedByWayOfALinkIsWhatTheSystemTakesItFor) {
    fs::create_directories(folder_.path("far/inner"));
    fs::create_directory_symlink(folder_.path("far/inner"), folder_.path("link"));
    const auto made = cache_.dataFor(writeBall(folder_, 1), fabric::ObjectKind::Mesh);
    ASSERT_TRUE(made.ok()) << made.status();
    fs::copy_file(*made, folder_.path("far/m.eym"));
    std::ofstream(folder_.path("scene.json")) << R"({"objects":[{"mesh":"link/../m.eym"}]})";
    for (const std::string& named : {folder_.path("link/../m.eym"), folder_.path("scene.json")}) {
        for (const bool hasOther : {false, true}) {
            if (hasOther)
                std::ofstream(folder_.path("m.eym")) << "another";
            const auto scene = assemble({named});
            ASSERT_TRUE(scene.ok()) << named << ": " << scene.status();
            EXPECT_TRUE(fs::equivalent(scene->objects.front().path, folder_.path("far/m.eym")));
        }
        fs::remove(folder_.path("m.eym"));
    }
}

TEST_F(SceneFiles, WhatCannotBeDrawnFromAnAddressIsToldWithWhatCan) {
    for (const char* mesh : {"s3://bucket/m.ply", "/vsis3/bucket/m.ply", "https://h/m.obj"})
        EXPECT_THAT(assemble({mesh}).status().ToString(),
                    testing::AllOf(testing::HasSubstr("download or unpack this one"),
                                   testing::HasSubstr("`eyrie import mesh`"),
                                   testing::Not(testing::HasSubstr("write /vsi"))));
    std::ofstream(folder_.path("mesh.json")) << R"({"objects":[{"mesh":"s3://bucket/m.ply"}]})";
    EXPECT_THAT(assemble({folder_.path("mesh.json")}).status().ToString(),
                testing::AllOf(testing::HasSubstr("download or unpack this one"),
                               testing::Not(testing::HasSubstr("write /vsi"))));
    EXPECT_THAT(assemble({"/vsis3/bucket/dem.tif"}).status().ToString(),
                testing::HasSubstr("`eyrie import terrain` makes of this one"));
    EXPECT_THAT(assemble({"s3://bucket/m.eym"}).status().ToString(),
                testing::HasSubstr("write /vsis3/bucket/m.eym"));
}

/// A picture of one colour without a place, which is stretched over the terrain.
void writePixels(const std::string& path, char level) {
    std::ofstream(path, std::ios::binary) << "P6 2 2 255\n" << std::string(12, level);
}

TEST_F(SceneFiles, ATerrainIsImportedWithItsImageryAndAgainWhenThatChanges) {
    writeSlope(folder_);
    writePixels(folder_.path("ground.ppm"), 'a');
    const std::string path = folder_.path("scene.json");
    std::ofstream(path) << R"({"objects":[{"terrain":"slope.tif","imagery":["ground.ppm"]}]})";
    const auto scene = assemble({path});
    ASSERT_TRUE(scene.ok()) << scene.status();
    EXPECT_TRUE(scene->objects[0].imagery.empty());
    const auto file = terrain::EytFile::open(scene->objects[0].path);
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_TRUE((*file)->index().imagery.has_value());
    ASSERT_TRUE(assemble({path}).ok());
    EXPECT_EQ(importsKept(), 1U);
    writePixels(folder_.path("ground.ppm"), 'b');
    ASSERT_TRUE(assemble({path}).ok());
    EXPECT_EQ(importsKept(), 2U);
    ASSERT_TRUE(assemble({folder_.path("slope.tif")}).ok());
    EXPECT_EQ(importsKept(), 3U) << "without imagery it is another terrain";
}

/// A virtual raster of all of another one, of kPosts a side, in UTM.
std::string writeVirtual(const test::TemporaryFolder& folder, const std::string& name,
                         const std::string& of, int zone = 32) {
    return folder.write(
        name,
        fmt::format(R"(<VRTDataset rasterXSize="{0}" rasterYSize="{0}"><SRS>EPSG:326{2}</SRS>)"
                    R"(<GeoTransform>500000, 30, 0, 5200000, 0, -30</GeoTransform>)"
                    R"(<VRTRasterBand dataType="Float32" band="1"><SimpleSource>)"
                    R"(<SourceFilename relativeToVRT="1">{1}</SourceFilename>)"
                    R"(<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>)",
                    kPosts, of, zone));
}

TEST_F(SceneFiles, AVirtualRasterIsImportedAgainWhenWhatItNamesChanges) {
    writeSlope(folder_);
    const std::string inner = writeVirtual(folder_, "inner.vrt", "slope.tif");
    const std::string outer = writeVirtual(folder_, "outer.vrt", "inner.vrt");
    std::vector<std::string> before;
    for (const std::string& path : {inner, outer}) {
        const auto data = cache_.dataFor(path, fabric::ObjectKind::Terrain);
        ASSERT_TRUE(data.ok()) << data.status();
        EXPECT_EQ(*cache_.dataFor(path, fabric::ObjectKind::Terrain), *data);
        before.push_back(*data);
    }
    writeSlope(folder_, 20);
    EXPECT_NE(*cache_.dataFor(inner, fabric::ObjectKind::Terrain), before[0]);
    EXPECT_NE(*cache_.dataFor(outer, fabric::ObjectKind::Terrain), before[1]);
}

TEST_F(SceneFiles, TerrainsOfDifferentCrsAreToldOf) {
    writeSlope(folder_);
    writeVirtual(folder_, "west.vrt", "slope.tif", 32);
    writeVirtual(folder_, "middle.vrt", "slope.tif", 32);
    writeVirtual(folder_, "east.vrt", "slope.tif", 33);
    ASSERT_TRUE(assemble({folder_.write("alike.json", R"({"objects":[{"terrain":"west.vrt"},)"
                                                      R"({"terrain":"middle.vrt"}]})")})
                    .ok());
    EXPECT_THAT(notes_, testing::Not(testing::Contains(testing::HasSubstr("coordinates"))));
    notes_.clear();
    ASSERT_TRUE(assemble({folder_.write("scene.json", R"({"objects":[{"terrain":"west.vrt"},)"
                                                      R"({"terrain":"east.vrt"}]})")})
                    .ok());
    EXPECT_THAT(notes_, testing::Contains(testing::AllOf(
                            testing::HasSubstr("east.vrt is in WGS 84 / UTM zone 33N"),
                            testing::HasSubstr("west.vrt in WGS 84 / UTM zone 32N"))));
}

/// A tenth of a degree of slope.tif, from a longitude at 46 degrees north on.
std::string writeDegrees(const test::TemporaryFolder& folder, const std::string& name,
                         double west) {
    constexpr double kSpacing = 0.1 / kPosts;
    return folder.write(
        name,
        fmt::format(R"(<VRTDataset rasterXSize="{0}" rasterYSize="{0}"><SRS>EPSG:4326</SRS>)"
                    R"(<GeoTransform>{1}, {2}, 0, 46, 0, -{2}</GeoTransform>)"
                    R"(<VRTRasterBand dataType="Float32" band="1"><SimpleSource>)"
                    R"(<SourceFilename relativeToVRT="1">slope.tif</SourceFilename>)"
                    R"(<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>)",
                    kPosts, west, kSpacing));
}

/// UTM zones 32 and 33 meet at 12 degrees.
TEST_F(SceneFiles, RastersThatAreNamedTogetherAreOneTerrainAcrossTheBorderOfTwoZones) {
    writeSlope(folder_);
    const std::string west = writeDegrees(folder_, "west.vrt", 11.9);
    const std::string east = writeDegrees(folder_, "east.vrt", 12);
    const auto scene = assemble({west, writeBall(folder_), east});
    ASSERT_TRUE(scene.ok()) << scene.status();
    ASSERT_EQ(scene->objects.size(), 2U);
    EXPECT_EQ(scene->objects[0].name, "west and 1 more");
    EXPECT_EQ(scene->objects[1].name, "ball");
    const auto file = terrain::EytFile::open(scene->objects[0].path);
    ASSERT_TRUE(file.ok()) << file.status();
    const fabric::Vec3 size = (*file)->index().bounds().size();
    const double degree = 111320 * std::cos(46 * M_PI / 180);
    EXPECT_NEAR(size.x, 0.2 * degree, 0.01 * degree) << "side by side, a little turned";
    EXPECT_THAT(notes_, testing::Contains(testing::AllOf(testing::HasSubstr(west + " and 1 more: "),
                                                         testing::HasSubstr("brought to"))));
    EXPECT_THAT(notes_, testing::Not(testing::Contains(testing::HasSubstr("its own coordinates"))));
}

TEST_F(SceneFiles, RastersThatAreNamedTogetherAreImportedOnceForTheirContentsInTheirOrder) {
    writeSlope(folder_);
    const std::string west = writeDegrees(folder_, "west.vrt", 11.9);
    const std::string east = writeDegrees(folder_, "east.vrt", 12);
    const auto first = cache_.mosaicOf({west, east});
    ASSERT_TRUE(first.ok()) << first.status();
    EXPECT_EQ(*cache_.mosaicOf({west, east}), *first);
    EXPECT_EQ(importsKept(), 1U);
    EXPECT_NE(*cache_.mosaicOf({east, west}), *first) << "where both have data the last one wins";
    EXPECT_NE(*cache_.dataFor(west, fabric::ObjectKind::Terrain), *first);
    writeSlope(folder_, 20);
    EXPECT_NE(*cache_.mosaicOf({west, east}), *first);
}

TEST_F(SceneFiles, RastersThatCannotBeOneTerrainAreRefusedWithWhatShowsThemApart) {
    folder_.write("dem.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n");
    const absl::Status refused = assemble({writeSlope(folder_), folder_.path("dem.asc")}).status();
    EXPECT_TRUE(absl::IsInvalidArgument(refused)) << refused;
    EXPECT_THAT(refused.ToString(),
                testing::AllOf(testing::HasSubstr("dem.asc"), testing::HasSubstr("scene file")));
    EXPECT_EQ(importsKept(), 0U);
}

TEST_F(SceneFiles, ImageryOverAnImportedTerrainIsRefused) {
    const auto scene = assemble({writeSlope(folder_)});
    ASSERT_TRUE(scene.ok()) << scene.status();
    const absl::Status refused =
        cache_.dataFor(scene->objects[0].path, fabric::ObjectKind::Terrain, {"a.tif"}).status();
    EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(refused.ToString(), testing::HasSubstr("a.tif"));
}

TEST_F(SceneFiles, DataAreCalledAlikeHoweverTheirPathsAreSpelt) {
    const auto ball = cache_.dataFor(writeBall(folder_), fabric::ObjectKind::Mesh);
    ASSERT_TRUE(ball.ok()) << ball.status();
    fs::copy_file(*ball, folder_.path("ball.eym"));
    for (const char* name : {"ball.eym", "./ball.eym", "imports/.././ball.eym"}) {
        const auto scene = assemble({(folder_.path() / name).string()});
        ASSERT_TRUE(scene.ok()) << scene.status();
        EXPECT_EQ(scene->objects[0].path, folder_.path("ball.eym")) << name;
    }
}

TEST_F(SceneFiles, AMessageNamesTheSceneFile) {
    const std::string scene = folder_.write("bad.json", R"({"objects":[{"name":"ghost"}]})");
    EXPECT_THAT(std::string(readSceneFile(scene).status().message()),
                testing::AllOf(testing::HasSubstr("bad.json"), testing::HasSubstr("ghost")));
}

TEST_F(SceneFiles, AMeshWithoutTheTerrainsCoordinatesStandsOnItsMiddleAndThatIsSaid) {
    const auto scene = assemble({writeSlope(folder_), writeBall(folder_)});
    ASSERT_TRUE(scene.ok()) << scene.status();
    ASSERT_EQ(scene->objects.size(), 2U);
    const auto mesh = mesh::EymFile::open(scene->objects[1].path);
    ASSERT_TRUE(mesh.ok());
    const fabric::Box placed =
        fabric::transformed(mesh->bounds(), scene->objects[1].worldFromObject);
    const double side = 30 * (kPosts - 1);
    EXPECT_NEAR(placed.centre().x, 500000 + side / 2, 30);
    EXPECT_NEAR(placed.centre().y, 5200000 + side / 2, 30);
    EXPECT_NEAR(placed.min.z, 10 * (kPosts - 1) / 2.0, 10) << "the height of the slope there";
    const fabric::Vec3 size = placed.size();
    EXPECT_NEAR(std::max({size.x, size.y, size.z}), side / 4, 1);
    ASSERT_EQ(notes_.size(), 1U);
    EXPECT_THAT(notes_.front(), testing::HasSubstr("ball"));
    ASSERT_EQ(asNamed_.objects.size(), 2U);
    EXPECT_EQ(asNamed_.objects[1].path, scene->objects[1].path);
    EXPECT_EQ(asNamed_.objects[1].worldFromObject, fabric::Mat4(1)) << "nobody has said so";
}

TEST_F(SceneFiles, WhatIsOddInSourcesAndLeftOutOfThemIsToldWhenTheyAreImported) {
    const std::string obj = folder_.write("m.obj",
                                          "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n"
                                          "usemtl a\nf 1/1 2/1 3/1\nf 1/1 2/1 2/1\n");
    folder_.write("m.mtl", "newmtl a\nmap_Kd none.png\n");
    folder_.write("dem.asc",
                  "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n"
                  "-9999 2 3\n4 5 6\n7 8 9\n");
    const auto scene = assemble({obj, folder_.path("dem.asc")});
    ASSERT_TRUE(scene.ok()) << scene.status();
    using testing::AllOf, testing::Contains, testing::HasSubstr;
    EXPECT_THAT(notes_, Contains(AllOf(HasSubstr("m.obj"), HasSubstr("none.png"))));
    EXPECT_THAT(notes_, Contains(AllOf(HasSubstr("m.obj"), HasSubstr("1 triangles without area"))));
    EXPECT_THAT(notes_, Contains(AllOf(HasSubstr("dem.asc"), HasSubstr("-9999"))));
    notes_.clear();
    ASSERT_TRUE(assemble({obj}).ok());
    EXPECT_THAT(notes_, testing::IsEmpty()) << "nothing is imported now";
}

TEST_F(SceneFiles, AMeshThatSharesTheTerrainsCoordinatesStaysWhereItIs) {
    import::TriangleMesh mesh = import::synthesizeMesh(500, 1);
    for (fabric::Vec3& position : mesh.positions) position += fabric::Vec3(501000, 5201000, 400);
    ASSERT_TRUE(import::writePly(mesh, folder_.path("near.ply")).ok());
    const auto scene = assemble({writeSlope(folder_), folder_.path("near.ply")});
    ASSERT_TRUE(scene.ok()) << scene.status();
    EXPECT_EQ(scene->objects[1].worldFromObject, fabric::Mat4(1.0));
    EXPECT_TRUE(notes_.empty());
}

TEST_F(SceneFiles, AMeshAloneStaysWhereItIs) {
    const auto scene = assemble({writeBall(folder_)});
    ASSERT_TRUE(scene.ok()) << scene.status();
    EXPECT_EQ(scene->objects.front().worldFromObject, fabric::Mat4(1.0));
    EXPECT_EQ(scene->objects.front().name, "ball");
}

TEST_F(SceneFiles, WhatIsMissingIsNotFound) {
    EXPECT_TRUE(absl::IsNotFound(readText(folder_.path("no.json")).status()));
    EXPECT_TRUE(absl::IsNotFound(assemble({folder_.path("no.ply")}).status()));
    EXPECT_TRUE(absl::IsNotFound(assemble({folder_.path("no.eyt")}).status()));
    EXPECT_TRUE(absl::IsInvalidArgument(readText(folder_.path().string()).status()));
}

TEST_F(SceneFiles, TheByteOrderMarkOfEditorsIsNoPartOfTheText) {
    std::ofstream(folder_.path("marked.json")) << "\xEF\xBB\xBF{}";
    const auto text = readText(folder_.path("marked.json"));
    ASSERT_TRUE(text.ok()) << text.status();
    EXPECT_EQ(*text, "{}");
}

TEST_F(SceneFiles, OfWhatHasNoEndNoMoreIsReadThanATextMayHave) {
    const absl::Status status = readText("/dev/zero").status();
    EXPECT_TRUE(absl::IsInvalidArgument(status));
    EXPECT_THAT(std::string(status.message()), testing::StartsWith("/dev/zero: larger than"));
}

TEST(OverlapsInPlan, LooksAtTheGroundPlanAlone) {
    const fabric::Box a{{0, 0, 0}, {1, 1, 1}};
    EXPECT_TRUE(overlapsInPlan(a, {{0.5, 0.5, 90}, {2, 2, 99}}));
    EXPECT_FALSE(overlapsInPlan(a, {{1.5, 0, 0}, {2, 1, 1}}));
    EXPECT_FALSE(overlapsInPlan(a, {{0, -2, 0}, {1, -1, 1}}));
}

}  // namespace
}  // namespace eyrie::cli
