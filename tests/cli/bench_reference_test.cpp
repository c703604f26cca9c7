// SPDX-License-Identifier: Apache-2.0
// What `eyrie bench --reference` holds pictures against.
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "cli/bench/flight_judge.h"
#include "cli/bench/flights.h"
#include "cli/bench/reference.h"
#include "cli/bench/resident_memory.h"
#include "cli/bench/uniform_levels.h"
#include "cli/source_record.h"
#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_synth.h"
#include "renderer/import/ply_writer.h"
#include "renderer/truth/source_files.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::cli::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kPlenty = std::uint64_t{1} << 30;

class ReferenceSources : public testing::Test {
protected:
    void SetUp() override {
        fs::create_directory(folder_.path("from"));
        source_ = writeBall("from/ball.ply", 1);
        imported_ = folder_.path("ball.eym");
        ASSERT_TRUE(import::importMesh({source_}, imported_, {}, {}).ok());
        ASSERT_TRUE(recordSources(imported_, {source_}).ok());
        scene_.objects.push_back({.name = "ball", .path = imported_});
    }

    std::string writeBall(const std::string& name, std::uint64_t seed) const {
        EXPECT_TRUE(import::writePly(import::synthesizeMesh(2000, seed), folder_.path(name)).ok());
        return folder_.path(name);
    }

    absl::StatusOr<std::vector<FoundSource>> find(const std::vector<std::string>& given = {},
                                                  std::uint64_t memory = kPlenty) const {
        return findSources(scene_, given, {memory}, {});
    }
    std::string foundFile(const std::vector<std::string>& given = {}) const {
        const auto found = find(given);
        return found.ok() ? found->at(0).files.at(0) : found.status().ToString();
    }

    test::TemporaryFolder folder_;
    std::string source_;
    std::string imported_;
    fabric::Scene scene_;
};

TEST_F(ReferenceSources, AreWhereTheyWereImportedFromOrBesideOrWhereOneSays) {
    EXPECT_EQ(foundFile(), source_);
    fs::rename(source_, folder_.path("ball.ply"));
    EXPECT_EQ(foundFile(), folder_.path("ball.ply"));
    fs::create_directory(folder_.path("elsewhere"));
    fs::rename(folder_.path("ball.ply"), folder_.path("elsewhere/ball.ply"));
    EXPECT_EQ(foundFile({folder_.path("elsewhere/ball.ply")}), folder_.path("elsewhere/ball.ply"));
    fs::remove(sourceRecordName(imported_));
    EXPECT_EQ(foundFile({folder_.path("elsewhere/ball.ply")}), folder_.path("elsewhere/ball.ply"));
}

/// Two imports of one file name each, and one of both, all moved.
TEST_F(ReferenceSources, OfOneNameAreToldByTheirHashAndTakenInTheirOrder) {
    for (const char* name : {"a", "b", "moved", "moved/a", "moved/b"})
        fs::create_directory(folder_.path(name));
    const std::vector<std::string> from{writeBall("a/ball.ply", 3), writeBall("b/ball.ply", 4)};
    const std::vector<std::string> moved{folder_.path("moved/a/ball.ply"),
                                         folder_.path("moved/b/ball.ply")};
    const std::vector<std::vector<std::string>> sources{{from[0]}, {from[1]}, from};
    scene_.objects.clear();
    for (const auto& files : sources) {
        const std::string imported =
            folder_.path(fmt::format("import {}.eym", scene_.objects.size()));
        ASSERT_TRUE(import::importMesh(files, imported, {}, {}).ok());
        ASSERT_TRUE(recordSources(imported, files).ok());
        scene_.objects.push_back({.name = "ball", .path = imported});
    }
    for (std::size_t i = 0; i < from.size(); ++i) fs::rename(from[i], moved[i]);
    const auto expectFound = [&] {
        const auto found = find(moved);
        ASSERT_TRUE(found.ok()) << found.status();
        EXPECT_EQ(found->at(0).files, std::vector{moved[0]});
        EXPECT_EQ(found->at(1).files, std::vector{moved[1]});
        EXPECT_EQ(found->at(2).files, moved);
    };
    expectFound();
    for (const fabric::SceneObject& object : scene_.objects)
        fs::remove(sourceRecordName(object.path));
    expectFound();
    const std::string other = writeBall("other.ply", 5);
    const absl::Status refused = find({moved[1], other}).status();
    EXPECT_TRUE(absl::IsInvalidArgument(refused)) << refused;
    EXPECT_THAT(refused.ToString(), testing::HasSubstr("nor is " + other));
}

TEST_F(ReferenceSources, ThatAreNowhereAreNamed) {
    fs::remove(source_);
    const absl::Status gone = find().status();
    EXPECT_TRUE(absl::IsNotFound(gone)) << gone;
    EXPECT_THAT(gone.ToString(), testing::HasSubstr(source_));
    // What is after the comma the API leaves out (coordinator/api/bench_order.cpp).
    EXPECT_THAT(gone.ToString(),
                testing::HasSubstr("put it there, or name the source's files with --source"));
    fs::remove(sourceRecordName(imported_));
    const absl::Status unknown = find().status();
    EXPECT_TRUE(absl::IsNotFound(unknown)) << unknown;
    EXPECT_THAT(unknown.ToString(),
                testing::HasSubstr("import it again, or name the source's files with --source"));
}

TEST_F(ReferenceSources, ThatAreNamedButAreOfNothingShownAreRefused) {
    const absl::Status missing = find({folder_.path("from/nowhere/ball.ply")}).status();
    EXPECT_TRUE(absl::IsNotFound(missing)) << missing;
    const absl::Status other = find({writeBall("other.ply", 2)}).status();
    EXPECT_TRUE(absl::IsInvalidArgument(other)) << other;
    EXPECT_THAT(other.ToString(), testing::HasSubstr("other.ply"));
    EXPECT_THAT(other.ToString(), testing::HasSubstr("imported: ball.ply"));
}

TEST_F(ReferenceSources, ThatHaveChangedAreRefusedWithBothHashes) {
    const auto before = truth::inspectSource(fabric::ObjectKind::Mesh, {source_});
    writeBall("from/ball.ply", 2);
    const auto after = truth::inspectSource(fabric::ObjectKind::Mesh, {source_});
    ASSERT_TRUE(before.ok() && after.ok());
    const absl::Status refused = find().status();
    EXPECT_TRUE(absl::IsInvalidArgument(refused)) << refused;
    EXPECT_THAT(refused.ToString(), testing::HasSubstr(fmt::format("{:016x}", before->hash)));
    EXPECT_THAT(refused.ToString(), testing::HasSubstr(fmt::format("{:016x}", after->hash)));
    EXPECT_THAT(refused.ToString(),
                testing::HasSubstr("import it again, or name what it was with --source"));
    writeBall("ball.ply", 1);
    EXPECT_EQ(foundFile(), folder_.path("ball.ply")) << "what it was lies beside the import";
}

/// While a flight is played there is time enough.
TEST_F(ReferenceSources, ThatChangeBeforeTheyAreReadAreRefusedWithBothHashes) {
    const auto found = find();
    ASSERT_TRUE(found.ok()) << found.status();
    EXPECT_TRUE(readSources(scene_, *found).ok());
    writeBall("from/ball.ply", 2);
    const auto after = truth::inspectSource(fabric::ObjectKind::Mesh, {source_});
    ASSERT_TRUE(after.ok());
    const absl::Status refused = readSources(scene_, *found).status();
    EXPECT_TRUE(absl::IsInvalidArgument(refused)) << refused;
    EXPECT_THAT(refused.ToString(), testing::HasSubstr(source_));
    EXPECT_THAT(refused.ToString(), testing::HasSubstr(fmt::format("{:016x}", (*found)[0].hash)));
    EXPECT_THAT(refused.ToString(), testing::HasSubstr(fmt::format("{:016x}", after->hash)));
}

TEST_F(ReferenceSources, OfTerrainsAreReadWithTheirHash) {
    const std::string path = folder_.path("dem.asc");
    std::ofstream(path) << "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2\n3 4\n";
    const auto facts = truth::inspectSource(fabric::ObjectKind::Terrain, {path});
    ASSERT_TRUE(facts.ok()) << facts.status();
    const auto source = truth::readSource(fabric::ObjectKind::Terrain, {path});
    ASSERT_TRUE(source.ok()) << source.status();
    EXPECT_EQ(source->hash, facts->hash);
}

/// Its heights, and a quarter of them for uniform decimation.
TEST_F(ReferenceSources, OfTerrainsTakeMemoryForALevelOfUniformDecimation) {
    const std::string path = folder_.path("dem.asc");
    std::ofstream(path) << "ncols 64\nnrows 64\nxllcorner 0\nyllcorner 0\ncellsize 10\n"
                        << [] {
                               std::string posts;
                               for (int i = 0; i < 64 * 64; ++i) posts += "7 ";
                               return posts;
                           }();
    const auto facts = truth::inspectSource(fabric::ObjectKind::Terrain, {path});
    ASSERT_TRUE(facts.ok()) << facts.status();
    EXPECT_GE(facts->neededBytes, truth::TerrainRayCaster::bytesFor(64 * 64) +
                                      truth::TerrainRayCaster::bytesFor(32 * 32));
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // those keep what is freed
/// Heights that GDAL reads past its own cache.
TEST_F(ReferenceSources, OfTerrainsAreReadInTheMemoryThatTheyAreSaidToTake) {
    const std::string path = folder_.path("dem.bil");
    std::ofstream(folder_.path("dem.hdr"))
        << "ncols 4096\nnrows 8192\nnbits 32\npixeltype float\nbyteorder I\nlayout bil\n"
           "ulxmap 0\nulymap 0\nxdim 10\nydim 10\n";
    std::ofstream(path).close();
    fs::resize_file(path, std::uintmax_t{4096} * 8192 * sizeof(float));
    const auto facts = truth::inspectSource(fabric::ObjectKind::Terrain, {path});
    ASSERT_TRUE(facts.ok()) << facts.status();
    resetPeakResidentBytes();
    const std::uint64_t before = peakResidentBytes();
    const auto source = truth::readSource(fabric::ObjectKind::Terrain, {path});
    ASSERT_TRUE(source.ok()) << source.status();
    EXPECT_LE(peakResidentBytes() - before, facts->neededBytes);
}
#endif

/// Of more rows than are read at once, in files from the north down and from the south up; here
/// they begin in the south.
TEST_F(ReferenceSources, OfTerrainsHaveEachPostWhereItIs) {
    constexpr int kRows = 600;
    std::string posts;
    for (int row = 0; row < kRows; ++row) posts += fmt::format("{} {}\n", row, -row);
    std::ofstream(folder_.path("down.asc"))
        << "ncols 2\nnrows 600\nxllcorner 0\nyllcorner 0\ncellsize 10\n"
        << posts;
    std::ofstream(folder_.path("up.vrt"))
        << R"(<VRTDataset rasterXSize="2" rasterYSize="600">)"
           R"(<GeoTransform>0, 10, 0, 0, 0, 10</GeoTransform>)"
           R"(<VRTRasterBand dataType="Float32" band="1"><SimpleSource>)"
           R"(<SourceFilename relativeToVRT="1">down.asc</SourceFilename>)"
           R"(</SimpleSource></VRTRasterBand></VRTDataset>)";
    for (const bool isUp : {false, true}) {
        const auto source = truth::readSource(fabric::ObjectKind::Terrain,
                                              {folder_.path(isUp ? "up.vrt" : "down.asc")});
        ASSERT_TRUE(source.ok()) << source.status();
        std::vector<float> expected;
        for (int row = 0; row < kRows; ++row) {
            const auto height = static_cast<float>(isUp ? row : kRows - 1 - row);
            expected.insert(expected.end(), {height, -height});
        }
        EXPECT_EQ(source->terrain->grid().heights, expected) << (isUp ? "up" : "down");
    }
}

TEST_F(ReferenceSources, OfGltfTakeMemoryForTheirBuffers) {
    const std::string path = folder_.path("big.gltf");
    std::ofstream(path) << R"({"asset":{"version":"2.0"},"images":[{"uri":"sky.png"}],)"
                        << R"("buffers":[{"uri":"big.bin","byteLength":100000}]})";
    std::ofstream(folder_.path("big.bin")) << std::string(100'000, '\0');
    std::ofstream(folder_.path("sky.png")) << std::string(500'000, '\0');
    const auto facts = truth::inspectSource(fabric::ObjectKind::Mesh, {path});
    ASSERT_TRUE(facts.ok()) << facts.status();
    EXPECT_GE(facts->neededBytes, 8U * 100'000);
    EXPECT_LT(facts->neededBytes, 8U * 500'000) << "images are not kept";
}

TEST_F(ReferenceSources, ThatMemoryCannotHoldAreRefusedWithWhatTheyTake) {
    const absl::Status refused = find({}, 100 << 10).status();
    EXPECT_TRUE(absl::IsResourceExhausted(refused)) << refused;
    EXPECT_THAT(refused.ToString(), testing::HasSubstr("may use 100.0 KiB; allow more with "
                                                       "--reference-memory"));
    const auto facts = truth::inspectSource(fabric::ObjectKind::Mesh, {source_});
    ASSERT_TRUE(facts.ok());
    EXPECT_GT(facts->neededBytes, fs::file_size(source_));
    EXPECT_TRUE(find({}, facts->neededBytes).ok());
    EXPECT_FALSE(find({}, facts->neededBytes - 1).ok());
    scene_.objects.push_back(scene_.objects[0]);
    EXPECT_TRUE(find({}, facts->neededBytes).ok()) << "two of the same are read once";
}

TEST_F(ReferenceSources, AreRefusedWithTheFramesThatTheyLeaveNoMemoryFor) {
    const auto facts = truth::inspectSource(fabric::ObjectKind::Mesh, {source_});
    ASSERT_TRUE(facts.ok());
    constexpr std::uint64_t kFrames = std::uint64_t{700} << 20;
    const auto withLimit = [&](std::uint64_t limit) {
        return findSources(scene_, {}, {limit, kFrames, "24 frames"}, {}).status();
    };
    EXPECT_TRUE(withLimit(kFrames + facts->neededBytes).ok());
    const absl::Status refused = withLimit(kFrames + facts->neededBytes - 1);
    EXPECT_TRUE(absl::IsResourceExhausted(refused)) << refused;
    EXPECT_THAT(refused.ToString(), testing::HasSubstr("700.0 MiB of it for 24 frames"));
    EXPECT_THAT(refused.ToString(), testing::HasSubstr("--reference-frames"));
}

/// From inside one may see through a ball that is drawn from outside only.
TEST_F(ReferenceSources, OfAnObjectOfOneSideMayBeSeenThroughFromBehind) {
    scene_.objects.push_back(scene_.objects[0]);
    scene_.objects[1].singleSided = true;
    scene_.objects[1].worldFromObject = glm::translate(fabric::Mat4(1), fabric::Vec3(10, 0, 0));
    const auto found = find();
    ASSERT_TRUE(found.ok()) << found.status();
    const auto reference = readSources(scene_, *found);
    ASSERT_TRUE(reference.ok()) << reference.status();
    const auto rangeFrom = [&](double x, double z) {
        return reference->surface->hitRange({{x, 0, z}, {0, 0, -1}});
    };
    for (const double x : {0.0, 10.0}) EXPECT_EQ(rangeFrom(x, 100).first, rangeFrom(x, 100).last);
    EXPECT_LT(rangeFrom(0, 0).last, 100);
    EXPECT_EQ(rangeFrom(10, 0).first, rangeFrom(0, 0).first);
    EXPECT_EQ(rangeFrom(10, 0).last, truth::kNoHit);
}

/// Turned by the import, what is a front in the file is none in the picture.
TEST_F(ReferenceSources, WhoseTrianglesTheImportTurnedMayBeSeenThroughFromEitherSide) {
    const std::string path = folder_.path("inside out.obj");
    std::ofstream(path) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                           "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";
    for (const bool orients : {false, true}) {
        scene_.objects = {
            {.name = "oriented", .path = folder_.path("oriented.eym"), .singleSided = true}};
        import::MeshImportOptions options;
        options.pack.orients = orients;
        ASSERT_TRUE(import::importMesh({path}, scene_.objects[0].path, options, {}).ok());
        const auto found = find({path});
        ASSERT_TRUE(found.ok()) << found.status();
        const auto reference = readSources(scene_, *found);
        ASSERT_TRUE(reference.ok()) << reference.status();
        const auto range = reference->surface->hitRange({{0.1, 0.1, 0.1}, {0, 0, -1}});
        EXPECT_NEAR(range.first, 0.1, 1e-6);
        if (orients) {
            EXPECT_EQ(range.last, truth::kNoHit);
        } else {
            EXPECT_NEAR(range.last, 0.1, 1e-6);
        }
    }
}

TEST_F(ReferenceSources, StandWhereTheSceneHasThem) {
    scene_.objects.push_back(scene_.objects[0]);
    scene_.objects[1].worldFromObject = glm::translate(fabric::Mat4(1), fabric::Vec3(10, 0, 0));
    const auto found = find();
    ASSERT_TRUE(found.ok()) << found.status();
    const auto reference = readSources(scene_, *found);
    ASSERT_TRUE(reference.ok()) << reference.status();
    EXPECT_EQ(reference->objects[0].source.mesh, reference->objects[1].source.mesh);
    const auto hitAt = [&](double x) {
        return reference->surface->hitRange({{x, 0, 100}, {0, 0, -1}}).first;
    };
    EXPECT_LT(hitAt(0), 100);
    EXPECT_NEAR(hitAt(10), hitAt(0), 1e-9);
    EXPECT_EQ(hitAt(5), truth::kNoHit);
}

/// What an image or a veil leaves of a triangle, the truth does not know.
TEST_F(ReferenceSources, SayWhichTrianglesMayBeSeenThrough) {
    std::ofstream(folder_.path("veil.mtl")) << "newmtl wall\nKd 1 1 1\nnewmtl veil\nd 0.5\n";
    const std::string path = folder_.path("veil.obj");
    std::ofstream(path) << "mtllib veil.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\n"
                           "v 0 1 1\nusemtl wall\nf 1 2 3\nusemtl veil\nf 4 5 6\n";
    const auto source = truth::readSource(fabric::ObjectKind::Mesh, {path});
    ASSERT_TRUE(source.ok()) << source.status();
    const auto range = source->mesh->hitRange({{0.2, 0.2, 5}, {0, 0, -1}});
    EXPECT_NEAR(range.first, 4, 1e-12);
    EXPECT_NEAR(range.last, 5, 1e-12);
}

TEST_F(ReferenceSources, DecimatedUniformlyAreWorseTheFewerTrianglesTheyHave) {
    const auto reference = readSources(scene_, *find());
    ASSERT_TRUE(reference.ok()) << reference.status();
    const std::vector<fabric::Camera> cameras{
        {.eye = {4, 0, 0}, .target = {0, 0, 0}, .fovYDegrees = 40},
        {.eye = {0, -4, 1}, .target = {0, 0, 0}, .fovYDegrees = 40}};
    int done = 0;
    const auto levels = uniformLevels(*reference, cameras, 640, 360, 1e9, [&] { ++done; }, {});
    ASSERT_TRUE(levels.ok()) << levels.status();
    ASSERT_GE(levels->size(), 4U);
    EXPECT_EQ(done, static_cast<int>(levels->size()));
    EXPECT_LE(levels->front().trianglesWhole, 1100);
    EXPECT_GE(levels->front().trianglesWhole, 500);
    for (std::size_t i = 1; i < levels->size(); ++i)
        EXPECT_LT((*levels)[i].triangles, (*levels)[i - 1].triangles);
    EXPECT_GT(levels->front().p99Pixels, 0.1);
    EXPECT_GT(levels->back().p99Pixels, 3 * levels->front().p99Pixels);
    for (const UniformLevel& level : *levels) {
        EXPECT_GE(level.maxPixels, level.p99Pixels);
        EXPECT_EQ(level.triangles, level.trianglesWhole) << "both cameras see all of it";
    }
    // Twice the picture's height is twice the pixels.
    const auto large = uniformLevels(*reference, cameras, 1280, 720, 0, [] {}, {});
    ASSERT_TRUE(large.ok());
    EXPECT_NEAR(large->front().p99Pixels, 2 * levels->front().p99Pixels, 1e-9);
    const auto until =
        uniformLevels(*reference, cameras, 640, 360, (*levels)[1].p99Pixels * 0.99, [] {}, {});
    ASSERT_TRUE(until.ok());
    EXPECT_EQ(until->size(), 2U) << "the last is the first beyond";
}

TEST_F(ReferenceSources, DecimatedUniformlyHaveTrianglesOutOfView) {
    scene_.objects.push_back(scene_.objects[0]);
    scene_.objects[1].worldFromObject = glm::translate(fabric::Mat4(1), fabric::Vec3(0, -100, 0));
    const auto reference = readSources(scene_, *find());
    ASSERT_TRUE(reference.ok()) << reference.status();
    const fabric::Camera away{.eye = {0, -4, 0}, .target = {0, 0, 0}, .fovYDegrees = 40};
    const fabric::Camera both{.eye = {100, -50, 0}, .target = {0, -50, 0}, .fovYDegrees = 90};
    const auto levels = uniformLevels(*reference, std::vector{away, both}, 640, 360, 0, [] {}, {});
    ASSERT_TRUE(levels.ok()) << levels.status();
    ASSERT_FALSE(levels->empty());
    EXPECT_EQ(levels->front().triangles, 0.75 * levels->front().trianglesWhole)
        << "half of them in one picture, all in the other";
}

TEST(UniformLevels, OfAPlaneHaveNoError) {
    const auto plane = std::make_shared<truth::TerrainRayCaster>(
        truth::HeightGrid{.columns = 65, .rows = 65, .heights = std::vector<float>(65 * 65, 7)});
    ReferenceScene scene{{{{plane, nullptr}, "plane.eyt"}},
                         std::make_shared<truth::PlacedSurfaces>(
                             std::vector<truth::PlacedSurface>{{plane, fabric::Mat4(1)}})};
    const std::vector<fabric::Camera> cameras{
        {.eye = {32, -100, 60}, .target = {32, -32, 0}, .fovYDegrees = 40}};
    const auto levels = uniformLevels(scene, cameras, 320, 180, 1, [] {}, {});
    ASSERT_TRUE(levels.ok());
    EXPECT_TRUE(levels->empty());
}

TEST_F(ReferenceSources, AreComparedInColourAtTheLeastTauOfAllRuns) {
    auto flight = NamedFlight::read("orbit");
    ASSERT_TRUE(flight.ok()) << flight.status();
    RunPlan plan{imported_, *std::move(flight), {{1}, {0.01}, {4}}, {0}, {}, {}};
    plan.pictures.quiet = true;
    plan.pictures.drawing.cache.folder = folder_.path("cache");
    const auto reference = planReference(plan, {}, {});
    ASSERT_TRUE(reference.ok()) << reference.status();
    EXPECT_EQ(reference->frames.finestTauPixels, 0.01);
    plan.asked.resize(1);
    EXPECT_EQ(planReference(plan, {}, {})->frames.finestTauPixels, kFinestTauPixels);
    plan.progressJson = true;
    EXPECT_EQ(progressStyle(plan), ProgressBar::Style::Json) << "quiet or not";
}

TEST(ControlGroup, HasLeftWhatItHoldsOfFiles) {
    const test::TemporaryFolder folder;
    const std::string root = folder.path("") + "/";
    EXPECT_EQ(leftInControlGroup(root), std::numeric_limits<std::uint64_t>::max());
    folder.write("memory.max", "max\n");
    folder.write("memory.current", "4000\n");
    EXPECT_EQ(leftInControlGroup(root), std::numeric_limits<std::uint64_t>::max());
    folder.write("memory.max", "5000\n");
    EXPECT_EQ(leftInControlGroup(root), 1000U);
    folder.write("memory.stat", "anon 100\ninactive_file 3000\nactive_file 500\n");
    EXPECT_EQ(leftInControlGroup(root), 4000U);
    const test::TemporaryFolder first;
    std::filesystem::create_directory(first.path("memory"));
    first.write("memory/memory.limit_in_bytes", "5000\n");
    first.write("memory/memory.usage_in_bytes", "4000\n");
    first.write("memory/memory.stat", "inactive_file 1\ntotal_inactive_file 500\n");
    EXPECT_EQ(leftInControlGroup(first.path("") + "/"), 1500U);
}

}  // namespace
}  // namespace eyrie::cli::bench
