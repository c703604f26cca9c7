// SPDX-License-Identifier: Apache-2.0
// What `eyrie bench --reference` holds pictures against.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "cli/bench/errors_csv.h"
#include "cli/bench/flight_judge.h"
#include "cli/bench/flights.h"
#include "cli/bench/reference.h"
#include "cli/bench/uniform_levels.h"
#include "cli/source_record.h"
#include "fabric/frustum.h"
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
    fs::remove(sourceRecordName(imported_));
    const absl::Status unknown = find().status();
    EXPECT_TRUE(absl::IsNotFound(unknown)) << unknown;
    EXPECT_THAT(unknown.ToString(), testing::HasSubstr("--source"));
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
    EXPECT_THAT(refused.ToString(), testing::HasSubstr("--reference-memory"));
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
    EXPECT_THAT(refused.ToString(), testing::HasSubstr("701 of it for 24 frames"));
    EXPECT_THAT(refused.ToString(), testing::HasSubstr("--reference-frames"));
}

TEST(JudgedFrames, TakeMoreTheMoreAreKeptButNoMoreThanArePlayed) {
    const std::uint64_t one = neededBytes({640, 360, 24, 1});
    EXPECT_EQ(neededBytes({640, 360, 24, 24}) - one, 23U * 640 * 360 * 20);
    EXPECT_EQ(neededBytes({640, 360, 24, 1000}), neededBytes({640, 360, 24, 24}));
    EXPECT_EQ(neededBytes({1280, 720, 24, 1}), 4 * one);
    EXPECT_EQ(neededBytes({640, 360, 24, 6, 3}) - neededBytes({640, 360, 24, 6}),
              3U * 6 * 640 * 360 * 8)
        << "pictures that three runs keep";
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

TEST(JudgedFrames, AreOneOfEachPartOfTheFlight) {
    for (const int played : {1, 5, 6, 7, 24, 120, 1000})
        for (const int count : {1, 4, 6, 7, 1000}) {
            const std::vector<int> frames = judgedFrames({.played = played, .judged = count});
            const int parts = std::min(played, count);
            ASSERT_EQ(frames.size(), static_cast<std::size_t>(parts));
            for (int i = 0; i < parts; ++i) {
                EXPECT_GE(frames[static_cast<std::size_t>(i)], i * played / parts);
                EXPECT_LT(frames[static_cast<std::size_t>(i)], (i + 1) * played / parts);
            }
        }
}

/// Of which every second is of another kind: turned back, or far away.
TEST(JudgedFrames, OfTheWorstFlightAreOfShotsOfBothKinds) {
    const fabric::Flight flight = worst(fabric::Box{{0, 0, 0}, {10, 10, 5}});
    for (const int played : {12, 24, 48, 60, 120, 240}) {
        std::array<int, 6> seen{};  // of each third, even and odd
        for (const int frame : judgedFrames({.played = played, .judged = 6})) {
            const double seconds = flight.seconds() * frame / (played - 1);
            const int shot = std::min(static_cast<int>(seconds / 0.5), 23);
            ++seen.at(static_cast<std::size_t>(shot / 8 * 2 + shot % 2));
        }
        EXPECT_GT(seen[0] + seen[2] + seen[4], 0) << played;
        EXPECT_GT(seen[1] + seen[3] + seen[5], 0) << played;
        if (played >= 24) {
            EXPECT_THAT(seen, testing::Each(1)) << played;
        }
    }
}

/// A plane whose pictures have it `lift` higher.
class LiftedPlane final : public PictureSource {
public:
    explicit LiftedPlane(float lift) : drawn_(grid(7 + lift)) {}

    static std::shared_ptr<truth::TerrainRayCaster> source() {
        return std::make_shared<truth::TerrainRayCaster>(grid(7));
    }

    absl::StatusOr<coordinator::RenderedFrame> draw(
        const coordinator::FrameRequest& request) override {
        coordinator::RenderedFrame frame;
        frame.image = fabric::makeImage({0, 0, request.width, request.height}, {}, true);
        const auto view =
            truth::castView(truth::Pinhole(request.camera, request.width, request.height), drawn_);
        for (std::size_t i = 0; i < view.hits.size(); ++i)
            frame.image.depth[i] = static_cast<float>(fabric::kNearMetres / view.hits[i].first);
        return frame;
    }
    fabric::SceneInfo sceneInfo() const override { return {}; }

private:
    static truth::HeightGrid grid(float height) {
        return {.columns = 65, .rows = 65, .heights = std::vector<float>(65 * 65, height)};
    }
    const truth::TerrainRayCaster drawn_;
};

/// A picture of 320 x 180 that was asked for and, of the lifted plane, drawn at `width` x `height`
/// with some promise in its own pixels, held against the plane.
FrameError judged(int width, int height, double promisedPixels) {
    const auto plane = LiftedPlane::source();
    ReferenceScene scene{{{{plane, nullptr}, "plane.eyt"}},
                         std::make_shared<truth::PlacedSurfaces>(
                             std::vector<truth::PlacedSurface>{{plane, fabric::Mat4(1)}})};
    const fabric::Flight flight{
        {{0, {.eye = {32, -60, 30}, .target = {32, -32, 7}, .fovYDegrees = 20}}}};
    FlightJudge judge(std::move(scene), flight, {320, 180, 1, 1}, {});
    LiftedPlane pictures(0.25F);
    coordinator::FrameRequest request;
    request.camera = flight.keys[0].camera;
    request.width = width;
    request.height = height;
    std::vector<coordinator::RenderedFrame> shown{pictures.draw(request).value()};
    shown[0].statistics.tauAchievedPixels = promisedPixels;
    shown[0].statistics.budget = {.milliseconds = 33, .tauPixels = 3};
    request.width = 320;
    request.height = 180;
    const auto measured = judge.judge(std::move(shown), pictures, request, [] {}, {});
    EXPECT_TRUE(measured.ok()) << measured.status();
    return measured.ok() ? measured->frames.at(0) : FrameError{};
}

TEST(FlightJudge, HoldsASmallerPictureAgainstItsPromiseInPixelsOfTheSizeAskedFor) {
    const FrameError whole = judged(320, 180, 100);
    const FrameError half = judged(160, 90, 50);
    EXPECT_GT(whole.maxPixels, 2);
    EXPECT_EQ(half.compared, 160U * 90);
    EXPECT_NEAR(half.maxPixels, whole.maxPixels, 0.02 * whole.maxPixels);
    EXPECT_NEAR(half.p50Pixels, whole.p50Pixels, 0.02 * whole.p50Pixels);
    EXPECT_EQ(whole.stretch, 1);
    EXPECT_EQ(half.stretch, 2);
    EXPECT_EQ(half.promisedPixels, 100);
    EXPECT_EQ(half.drawnTauPixels, 3) << "which the frame time came to";
    const double own = half.maxPixels / 2;
    EXPECT_TRUE(keepsPromise(judged(160, 90, 1.01 * own)));
    EXPECT_FALSE(keepsPromise(judged(160, 90, 0.9 * own)));
    EXPECT_FALSE(keepsPromise(judged(320, 180, 1.01 * own))) << "twice as many of its own pixels";
}

TEST(FlightJudge, AFrameThatShowsNothingDidNotComeClosestToItsPromise) {
    const auto plane = LiftedPlane::source();
    ReferenceScene scene{{{{plane, nullptr}, "plane.eyt"}},
                         std::make_shared<truth::PlacedSurfaces>(
                             std::vector<truth::PlacedSurface>{{plane, fabric::Mat4(1)}})};
    const fabric::Camera away{.eye = {32, -60, 30}, .target = {32, -120, 60}, .fovYDegrees = 20};
    const fabric::Camera there{.eye = {32, -60, 30}, .target = {32, -32, 7}, .fovYDegrees = 20};
    FlightJudge judge(std::move(scene), fabric::Flight{{{0, away}, {1, there}}},
                      {.width = 160, .height = 90, .played = 2, .judged = 2}, {});
    LiftedPlane pictures(0.25F);
    coordinator::FrameRequest request;
    request.width = 160;
    request.height = 90;
    const auto measured = judge.judge(pictures, pictures, request, [] {}, {});
    ASSERT_TRUE(measured.ok()) << measured.status();
    EXPECT_TRUE(isEmpty(measured->frames.at(0)));
    EXPECT_EQ(measured->worst.at(0).error.seconds, 1);
}

/// The second is drawn where it is, but for a hole.
TEST(FlightJudge, AFrameWithHolesIsWorseThanOneThatComesNearItsPromise) {
    const auto plane = LiftedPlane::source();
    ReferenceScene scene{{{{plane, nullptr}, "plane.eyt"}},
                         std::make_shared<truth::PlacedSurfaces>(
                             std::vector<truth::PlacedSurface>{{plane, fabric::Mat4(1)}})};
    const fabric::Camera there{.eye = {32, -60, 30}, .target = {32, -32, 7}, .fovYDegrees = 20};
    FlightJudge judge(std::move(scene), fabric::Flight{{{0, there}, {1, there}}},
                      {.width = 160, .height = 90, .played = 2, .judged = 2}, {});
    LiftedPlane lifted(0.25F);
    LiftedPlane exact(0);
    coordinator::FrameRequest request;
    request.camera = there;
    request.width = 160;
    request.height = 90;
    std::vector<coordinator::RenderedFrame> shown{lifted.draw(request).value(),
                                                  exact.draw(request).value()};
    for (coordinator::RenderedFrame& frame : shown) frame.statistics.tauAchievedPixels = 2;
    for (std::size_t row = 40; row < 50; ++row)
        std::fill_n(shown[1].image.depth.begin() + static_cast<std::ptrdiff_t>(row * 160 + 75), 10,
                    0.0F);
    const auto measured = judge.judge(std::move(shown), exact, request, [] {}, {});
    ASSERT_TRUE(measured.ok()) << measured.status();
    EXPECT_TRUE(keepsPromise(measured->frames.at(0)));
    EXPECT_GT(measured->frames[0].maxPixels, 1);
    EXPECT_LT(measured->frames.at(1).maxPixels, 0.1);
    EXPECT_EQ(measured->frames[1].holes, 100U);
    EXPECT_EQ(measured->worst.at(0).error.seconds, 1);
}

/// Tells at which tau it was asked for pictures.
class TauPictures final : public PictureSource {
public:
    absl::StatusOr<coordinator::RenderedFrame> draw(
        const coordinator::FrameRequest& request) override {
        taus.push_back(request.tauPixels);
        return exact_.draw(request);
    }
    fabric::SceneInfo sceneInfo() const override { return {}; }

    std::vector<double> taus;

private:
    LiftedPlane exact_{0};
};

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

TEST(FlightJudge, ComparesColoursWithTheFinestWhicheverRunComesFirst) {
    const auto plane = LiftedPlane::source();
    ReferenceScene scene{{{{plane, nullptr}, "plane.eyt"}},
                         std::make_shared<truth::PlacedSurfaces>(
                             std::vector<truth::PlacedSurface>{{plane, fabric::Mat4(1)}})};
    const fabric::Camera there{.eye = {32, -60, 30}, .target = {32, -32, 7}, .fovYDegrees = 20};
    FlightJudge judge(
        std::move(scene), fabric::Flight{{{0, there}}},
        {.width = 160, .height = 90, .played = 1, .judged = 1, .finestTauPixels = 0.01}, {});
    LiftedPlane pictures(0.25F);
    TauPictures finest;
    for (const double tau : {1.0, 0.01}) {
        coordinator::FrameRequest request;
        request.width = 160;
        request.height = 90;
        request.tauPixels = tau;
        ASSERT_TRUE(judge.judge(pictures, finest, request, [] {}, {}).ok());
    }
    EXPECT_THAT(finest.taus, testing::ElementsAre(0.01)) << "drawn once, for both";
}

std::vector<BenchRun> runWith(double maxPixels, double promisedPixels) {
    BenchRun run;
    run.label = "2 px";
    run.tauPixels = 2;
    run.measured.emplace();
    run.measured->frames.push_back({.promisedPixels = 1, .maxPixels = 0.25});
    run.measured->frames.push_back(
        {.seconds = 7, .promisedPixels = promisedPixels, .maxPixels = maxPixels});
    return {run};
}

TEST(CheckPromises, NamesTheFrameThatBreaksItsOwn) {
    EXPECT_TRUE(checkPromises(runWith(1.5, 1.5)).ok());
    EXPECT_TRUE(checkPromises(runWith(90, std::numeric_limits<double>::infinity())).ok());
    const absl::Status broken = checkPromises(runWith(1.6, 1.5));
    EXPECT_EQ(broken.code(), absl::StatusCode::kInternal);
    EXPECT_THAT(broken.ToString(), testing::HasSubstr("second 7.000"));
    EXPECT_THAT(broken.ToString(), testing::HasSubstr("broken at 2 px, second 7.000"));
    std::vector<BenchRun> seenThrough = runWith(1.5, 1.5);
    seenThrough[0].measured->frames[0].holes = 3;
    EXPECT_THAT(checkPromises(seenThrough).ToString(), testing::HasSubstr("3 pixels are empty"));
}

TEST(ErrorsCsv, HasALineAFrameAndIsNothingWithoutAReference) {
    EXPECT_EQ(errorsCsv({BenchRun{}}), "");
    const std::string csv = errorsCsv(runWith(1.25, 1.5));
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
    EXPECT_THAT(csv, testing::HasSubstr("\n2 px,2,0,7.000,1.5,0,0,1.25,"));
}

}  // namespace
}  // namespace eyrie::cli::bench
