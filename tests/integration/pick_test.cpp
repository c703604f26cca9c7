// SPDX-License-Identifier: Apache-2.0
// What a line of sight meets of the finest data, held against double-precision rays at the source:
// the truth's own, which share no code with it.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_synth.h"
#include "renderer/import/terrain_import.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/mesh/vertex_packing.h"
#include "renderer/pick/picker.h"
#include "renderer/truth/mesh_ray_caster.h"
#include "renderer/truth/terrain_ray_caster.h"
#include "tests/renderer/lod/wall.h"
#include "tests/renderer/terrain/hard_grids.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using fabric::Camera;
using fabric::PickedPoint;
using fabric::Vec2;
using fabric::Vec3;
using pick::Picker;
using test::GridKind;

constexpr int kWidth = 1280;
constexpr int kHeight = 720;

/// Of one kind of view.
struct Tally {
    int picked = 0;
    int missed = 0;               ///< the source, too
    int slipped = 0;              ///< nothing picked, though the source is met
    int mayBeMissed = 0;          ///< picked, but the source may be missed
    std::vector<double> spreads;  ///< farthest - nearest, in pixels' widths

    double medianSpread() {
        std::ranges::sort(spreads);
        return spreads.empty() ? 0 : spreads[spreads.size() / 2];
    }
};

/// An object and its source.
class Pair {
public:
    Pair(std::shared_ptr<const Picker> picker, std::unique_ptr<truth::ReferenceSurface> source,
         double exaggeration = 1)
        : picker_(std::move(picker)), source_(std::move(source)), exaggeration_(exaggeration) {}

    absl::StatusOr<fabric::Picked> pick(const Camera& camera, const Vec2& place) const {
        return picker_->pick({camera, kWidth, kHeight, place, exaggeration_});
    }

    /// Holds the answer for one place against the truth.
    void hold(const Camera& camera, const Vec2& place, Tally& tally) const {
        const auto picked = pick(camera, place);
        ASSERT_TRUE(picked.ok()) << picked.status();
        const truth::Ray ray = truth::Pinhole(camera, kWidth, kHeight).rayThrough(place.x, place.y);
        const auto hits = source_->hitRange(ray);
        const double metresPerT = glm::length(ray.direction);
        if (picked->has_value())
            holdPoint(**picked, hits.first * metresPerT, hits.last * metresPerT, tally);
        else if (hits.last == truth::kNoHit)
            ++tally.missed;
        else
            ++tally.slipped;
    }

    /// The same through a wall, both in the camera's axes: the judge looks through its corners.
    void holdThrough(const test::Wall& wall, const Vec3& eye, const Camera& camera,
                     const Vec2& place, Tally& tally) const {
        fabric::PickRequest request{camera, kWidth, kHeight, place, exaggeration_};
        request.sight = test::sightThrough(wall, eye);
        const auto picked = picker_->pick(request);
        ASSERT_TRUE(picked.ok()) << picked.status();
        const test::Wall inWorld = test::inWorld(camera, wall);
        const truth::Pinhole judge(test::inWorld(camera, eye),
                                   {inWorld.lowerLeft, inWorld.lowerRight, inWorld.upperLeft},
                                   kWidth, kHeight);
        const truth::Ray ray = judge.rayThrough(place.x, place.y);
        const auto hits = source_->hitRange(ray);
        const double metresPerT = glm::length(ray.direction);
        if (!picked->has_value()) {
            ++(hits.last == truth::kNoHit ? tally.missed : tally.slipped);
            return;
        }
        holdPoint(**picked, hits.first * metresPerT, hits.last * metresPerT, tally);
        const Vec3 along = ray.direction / metresPerT;
        const Vec3 from = (*picked)->worldMetres - ray.origin;
        // The judge's corners are rounded where they are in the world.
        const double judgesTurn =
            1e-15 * glm::length(ray.origin) / glm::length(wall.lowerRight - wall.lowerLeft);
        EXPECT_LE(glm::length(glm::cross(from, along)),
                  1e-11 + (1e-11 + judgesTurn) * glm::length(from))
            << "beside the ray";
        // A pixel of the wall, seen from where its point is picked.
        const double pixels =
            (request.sight->frustum.top - request.sight->frustum.bottom) / kHeight;
        EXPECT_NEAR((*picked)->pixelMetres, judge.depth((*picked)->worldMetres) * pixels,
                    (1e-9 + 10 * judgesTurn) * (*picked)->pixelMetres);
    }

    /// Of those readings that there are, one is within the error.
    void holdNearest(const PickedPoint& point) const {
        const auto partner = source_->counterpart(point.worldMetres);
        ASSERT_TRUE(partner.has_value());
        EXPECT_LE(glm::length(*partner - point.worldMetres), point.errorMetres + 1e-9);
    }

private:
    void holdPoint(const PickedPoint& point, double first, double last, Tally& tally) const {
        ++tally.picked;
        // What the judge's own arithmetic, which is the same double precision, may be off by.
        const double rounding = 1e-12 * (point.distanceMetres + glm::length(point.worldMetres));
        const double spread = point.farthestMetres - point.nearestMetres;
        const double slack = rounding * (1 + std::min(spread, 1e6) / point.errorMetres);
        EXPECT_LE(point.nearestMetres, point.distanceMetres + slack);
        EXPECT_GE(point.farthestMetres, point.distanceMetres - slack);
        EXPECT_LE(point.nearestMetres, first + slack) << "error " << point.errorMetres;
        EXPECT_GE(point.farthestMetres, last - slack) << "error " << point.errorMetres;
        holdError(point, rounding);
        if (std::isinf(point.farthestMetres))
            ++tally.mayBeMissed;
        else
            tally.spreads.push_back(spread / point.pixelMetres);
    }

    /// Of terrain each reading of the source is near, of a mesh some point of it.
    void holdError(const PickedPoint& point, double rounding) const {
        const double most = point.errorMetres + rounding;
        const Vec3& p = point.worldMetres;
        if (const auto* terrain = dynamic_cast<const truth::TerrainRayCaster*>(source_.get())) {
            for (const double height : terrain->heightsAt(p.x, p.y))
                EXPECT_LE(std::abs(height - p.z), most);
            return;
        }
        const auto partner = source_->counterpart(p);
        ASSERT_TRUE(partner.has_value());
        EXPECT_LE(glm::length(*partner - p), most);
    }

    std::shared_ptr<const Picker> picker_;
    std::unique_ptr<truth::ReferenceSurface> source_;
    double exaggeration_;
};

std::shared_ptr<const Picker> open(const fabric::SceneObject& object) {
    fabric::Scene scene;
    scene.objects.push_back(object);
    auto picker = Picker::open(scene, {});
    EXPECT_TRUE(picker.ok()) << picker.status();
    return picker.ok() ? *picker : nullptr;
}

Pair terrainPair(const test::TemporaryFolder& folder, const terrain::HeightGrid& grid,
                 double exaggeration = 1) {
    const std::string path = folder.path("terrain.eyt");
    const auto report = import::importTerrain(grid, {"grid", "", 0}, path, {});
    EXPECT_TRUE(report.ok()) << report.status();
    truth::HeightGrid posts{grid.columns, grid.rows,      grid.heights,
                            grid.origin,  grid.perColumn, grid.perRow};
    for (float& height : posts.heights) height = static_cast<float>(height * exaggeration);
    return {open({.name = "terrain", .kind = fabric::ObjectKind::Terrain, .path = path}),
            std::make_unique<truth::TerrainRayCaster>(std::move(posts)), exaggeration};
}

Pair meshPair(const test::TemporaryFolder& folder, import::TriangleMesh mesh,
              const fabric::Mat4& worldFromObject, const import::MeshImportOptions& options = {}) {
    truth::TriangleMesh source{mesh.positions, mesh.triangles};
    for (Vec3& p : source.positions) p = Vec3(worldFromObject * fabric::Vec4(p, 1));
    const std::string path = folder.path("mesh.eym");
    const auto report = import::importMesh(std::move(mesh), path, options);
    EXPECT_TRUE(report.ok()) << report.status();
    return {open({.name = "mesh", .path = path, .worldFromObject = worldFromObject}),
            std::make_unique<truth::MeshRayCaster>(std::move(source))};
}

/// Places all over what a sphere covers of the picture.
std::vector<Vec2> placesAround(const Camera& camera, const Vec3& centre, double radius, int count,
                               std::mt19937& engine) {
    const truth::Pinhole pinhole(camera, kWidth, kHeight);
    const double reach = pinhole.focalPixels() * radius / glm::length(centre - camera.eye);
    const Vec2 middle = pinhole.project(centre).value_or(Vec2(kWidth / 2.0, kHeight / 2.0));
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<Vec2> places;
    while (places.size() < static_cast<std::size_t>(count)) {
        const Vec2 place =
            middle + std::min(reach, 1.0 * kWidth) * Vec2(unit(engine), unit(engine));
        if (place.x >= 0 && place.y >= 0 && place.x <= kWidth && place.y <= kHeight)
            places.push_back(place);
    }
    return places;
}

struct NamedCamera {
    std::string name;
    Camera camera;
};

/// At 1 m, 1 km and 1,000 km from a point of ground, and almost level over it.
std::vector<NamedCamera> camerasOver(const Vec3& ground) {
    const auto from = [&](const Vec3& offset, double fovYDegrees) {
        return Camera{ground + offset, ground, {0, 0, 1}, fovYDegrees};
    };
    return {{"1 m", from({0.6, 0.5, 0.6}, 60)},
            {"1 km", from({500, -600, 620}, 60)},
            {"1,000 km", from({3e5, 4e5, 8.6e5}, 1)},
            {"grazing", from({-900, 700, 2}, 40)}};
}

TEST(HardCase22, PicksOfTerrainAreWhereRaysMeetTheSource) {
    const test::TemporaryFolder folder;
    std::mt19937 engine(22);
    int picked = 0;
    for (const GridKind kind : {GridKind::Smooth, GridKind::Noise, GridKind::Cliff,
                                GridKind::Spikes, GridKind::Checkerboard, GridKind::Plane}) {
        const terrain::HeightGrid grid = test::hardGrid(kind, 161, 150, 5);
        const Pair pair = terrainPair(folder, grid);
        const fabric::Vec2 middle = grid.origin + grid.perColumn * 80.3 + grid.perRow * 70.6;
        const Vec3 ground(middle.x, middle.y, static_cast<double>(grid.at(80, 70)));
        for (const auto& [name, camera] : camerasOver(ground)) {
            Tally tally;
            for (const Vec2& place : placesAround(camera, ground, 600, 420, engine))
                pair.hold(camera, place, tally);
            fmt::print("{} at {}: {} picked, {} missed, {} slipped, {} uncertain, {:.3g} px\n",
                       test::name(kind), name, tally.picked, tally.missed, tally.slipped,
                       tally.mayBeMissed, tally.medianSpread());
            EXPECT_EQ(tally.slipped, 0) << test::name(kind) << " at " << name;
            picked += tally.picked;
        }
    }
    EXPECT_GT(picked, 5000);
}

TEST(HardCase22, PicksOfMeshesAreWhereRaysMeetTheSource) {
    const test::TemporaryFolder folder;
    std::mt19937 engine(23);
    const fabric::Mat4 moved = glm::scale(
        glm::rotate(glm::translate(fabric::Mat4(1), Vec3(5e5, -4.4e6, 120)), 0.7, Vec3(1, 2, 3)),
        Vec3(300));
    const Pair pair =
        meshPair(folder, import::synthesizeMesh(6000, 3), moved, {.leafTriangles = 500});
    const Vec3 centre(moved[3]);
    const auto on = pair.pick({centre + Vec3(0, -2000, 0), centre}, {kWidth / 2.0, kHeight / 2.0});
    ASSERT_TRUE(on.ok() && on->has_value());
    int picked = 0;
    for (const auto& [name, camera] : camerasOver((*on)->worldMetres)) {
        Tally tally;
        for (const Vec2& place : placesAround(camera, centre, 400, 2500, engine))
            pair.hold(camera, place, tally);
        fmt::print("mesh at {}: {} picked, {} missed, {} slipped, {} uncertain, {:.3g} px\n", name,
                   tally.picked, tally.missed, tally.slipped, tally.mayBeMissed,
                   tally.medianSpread());
        EXPECT_EQ(tally.slipped, 0) << name;
        picked += tally.picked;
    }
    EXPECT_GT(picked, 3000);
}

/// Single triangles in a ball: a ray that misses one meets nothing beside it.
import::TriangleMesh confetti(std::uint32_t triangles, std::mt19937& engine){
    std::uniform_real_distribution<double> unit(-1, 1);
const auto point = [&] { return Vec3(unit(engine), unit(engine), unit(engine)); };
import::TriangleMesh mesh;
for (std::uint32_t t = 0; t < triangles; ++t) {
    const Vec3 middle = point();
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(middle + 0.06 * point());
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
}
return mesh;
}  // namespace

/// What rounding moves is a good part of what triangles are wide. Where outlines are within the
/// error of the ray, it may meet what it does not in the source, and the other way round.
TEST(HardCase22, PicksOfRoughlyRoundedMeshesAreWhereRaysMeetTheSource) {
    const test::TemporaryFolder folder;
    std::mt19937 engine(26);
    const NamedCamera cameras[] = {{"beside", {{0, -4, 0.5}, {0, 0, 0}}},
                                   {"inside", {{0.1, 0.2, 0.1}, {1, 1, 0}, {0, 0, 1}, 120}}};
    for (const bool isClosed : {true, false}) {
        const Pair pair =
            meshPair(folder, isClosed ? import::synthesizeMesh(6000, 5) : confetti(1500, engine),
                     fabric::Mat4(1), {.leafTriangles = 500, .pack = {.latticeBits = 10}});
        Tally tally;
        for (const auto& [name, camera] : cameras)
            for (const Vec2& place : placesAround(camera, {0, 0, 0}, 1.1, 900, engine))
                pair.hold(camera, place, tally);
        fmt::print("{}: {} picked, {} missed, {} slipped, {} uncertain, {:.3g} px\n",
                   isClosed ? "ball" : "confetti", tally.picked, tally.missed, tally.slipped,
                   tally.mayBeMissed, tally.medianSpread());
        EXPECT_GT(tally.picked, 300);
        EXPECT_LT(tally.slipped, 60);
        EXPECT_LT(tally.mayBeMissed, tally.picked / 2);
    }
}

TEST(HardCase22, PicksOfExaggeratedTerrainAreWhereRaysMeetTheSource) {
    const test::TemporaryFolder folder;
    std::mt19937 engine(24);
    const terrain::HeightGrid grid = test::hardGrid(GridKind::Smooth, 90, 90, 5);
    const fabric::Vec2 middle = grid.origin + grid.perColumn * 45.0 + grid.perRow * 45.0;
    for (const double exaggeration : {-1.0, 0.125, 4.0}) {
        const Pair pair = terrainPair(folder, grid, exaggeration);
        const Vec3 ground(middle.x, middle.y, static_cast<double>(grid.at(45, 45)) * exaggeration);
        Tally tally;
        for (const auto& [name, camera] : camerasOver(ground))
            for (const Vec2& place : placesAround(camera, ground, 300, 100, engine))
                pair.hold(camera, place, tally);
        EXPECT_EQ(tally.slipped, 0);
        EXPECT_GT(tally.picked, 150);
        const auto level = pair.pick({ground + Vec3(0, -1, 5000), ground}, {640, 360});
        ASSERT_TRUE(level.ok() && level->has_value());
        EXPECT_NEAR(*(*level)->elevationMetres, grid.at(45, 45), 0.1);
    }
}

/// Walls that stand aslant, seen by an eye beside the camera.
TEST(HardCase22, PicksThroughObliqueWallsAreWhereRaysMeetTheSource) {
    const test::TemporaryFolder folder;
    test::Dice dice(27);
    const Pair mesh =
        meshPair(folder, import::synthesizeMesh(6000, 3), fabric::Mat4(1), {.leafTriangles = 500});
    const terrain::HeightGrid grid = test::hardGrid(GridKind::Smooth, 161, 150, 5);
    const Pair terrain = terrainPair(folder, grid);
    const fabric::Vec2 middle = grid.origin + grid.perColumn * 80.3 + grid.perRow * 70.6;
    const Vec3 ground(middle.x, middle.y, static_cast<double>(grid.at(80, 70)));
    Tally ofMesh;
    Tally ofTerrain;
    for (int i = 0; i < 300; ++i) {
        const test::Wall wall = test::randomWall(dice);
        const Vec3 eye = test::randomEye(dice);
        for (int k = 0; k < 8; ++k) {
            const Vec2 place(dice.in(0, kWidth), dice.in(0, kHeight));
            mesh.holdThrough(wall, eye, {dice.direction() * 2.5, {0, 0, 0}}, place, ofMesh);
            const Camera over{ground + Vec3(dice.in(-400, 400), dice.in(-400, 400), 500), ground};
            terrain.holdThrough(wall, eye, over, place, ofTerrain);
        }
    }
    for (const Tally& tally : {ofMesh, ofTerrain}) {
        fmt::print("through walls: {} picked, {} missed, {} slipped, {} uncertain\n", tally.picked,
                   tally.missed, tally.slipped, tally.mayBeMissed);
        EXPECT_EQ(tally.slipped, 0);
        EXPECT_GT(tally.picked, 400);
    }
}

TEST(HardCase22, PicksOfMeshesThatKeepTheirPositionsAreExact) {
    const test::TemporaryFolder folder;
    std::mt19937 engine(25);
    const Pair pair = meshPair(folder, import::synthesizeMesh(4000, 3), fabric::Mat4(1),
                               {.leafTriangles = 500, .pack = {.keepsExact = true}});
    const Camera camera{{0, -3, 0}, {0, 0, 0}};
    Tally tally;
    for (const Vec2& place : placesAround(camera, {0, 0, 0}, 1, 500, engine)) {
        pair.hold(camera, place, tally);
        const auto picked = pair.pick(camera, place);
        ASSERT_TRUE(picked.ok());
        if (picked->has_value()) {
            EXPECT_LT((*picked)->errorMetres, 1e-13);
        }
    }
    EXPECT_EQ(tally.slipped, 0);
    EXPECT_GT(tally.picked, 200);
}

/// From inside a closed mesh every line of sight meets it, also through what triangles share.
TEST(HardCase22, NoPickSlipsThroughAnEdgeOrACornerOfAMesh) {
    const test::TemporaryFolder folder;
    const import::TriangleMesh mesh = import::synthesizeMesh(3000, 7);
    const std::string path = folder.path("ball.eym");
    ASSERT_TRUE(import::importMesh(mesh, path, {.leafTriangles = 200}).ok());
    const auto opened = mesh::EymFile::open(path);
    ASSERT_TRUE(opened.ok());
    const auto picker = open({.name = "ball", .path = path});
    const Vec3 eye(0.01, 0.02, 0.03);
    int picks = 0;
    const auto meet = [&](const Vec3& target) {
        const auto picked = picker->pick({{eye, target}, 100, 100, {50, 50}});
        ASSERT_TRUE(picked.ok()) << picked.status();
        ASSERT_TRUE(picked->has_value()) << target.x << " " << target.y << " " << target.z;
        EXPECT_LE((*picked)->nearestMetres, glm::length(target - eye) + 1e-9);
        ++picks;
    };
    for (std::uint32_t node = 0; node < opened->nodes().size(); ++node) {
        if (!opened->nodes()[node].isLeaf())
            continue;
        const auto leaf = opened->geometry(node);
        ASSERT_TRUE(leaf.ok());
        const auto at = [&](std::size_t k) {
            return opened->lattice().metres(
                mesh::unpackPosition(leaf->positions[leaf->indices[k]]));
        };
        for (std::size_t k = 0; k < leaf->indices.size(); k += 3)
            for (std::size_t c = 0; c < 3; ++c) {
                meet(at(k + c));
                meet((at(k + c) + at(k + (c + 1) % 3)) * 0.5);
            }
    }
    EXPECT_GT(picks, 10'000);
}

TEST(HardCase22, NoPickSlipsThroughAnEdgeOrACornerOfATerrain) {
    const test::TemporaryFolder folder;
    for (const GridKind kind : {GridKind::Smooth, GridKind::Noise, GridKind::Flat}) {
        const terrain::HeightGrid grid = test::hardGrid(kind, 40, 37, 5);
        const Pair pair = terrainPair(folder, grid);
        // Half a post on, too; straight down, and aslant so steeply that no slope is in the way.
        for (int j = 1; j < 2 * 36; ++j)
            for (int i = 1; i < 2 * 39; ++i) {
                const fabric::Vec2 at =
                    grid.origin + grid.perColumn * (i / 2.0) + grid.perRow * (j / 2.0);
                const Vec3 target(at.x, at.y, 0);
                const Vec3 aside = (i + j) % 2 == 0 ? Vec3(0) : Vec3(10, -5, 0);
                const auto picked =
                    pair.pick({target + aside + Vec3(0, 0, 9000), target, {0, 1, 0}}, {640, 360});
                ASSERT_TRUE(picked.ok()) << picked.status();
                ASSERT_TRUE(picked->has_value()) << test::name(kind) << " " << i << " " << j;
                EXPECT_LT((*picked)->farthestMetres, pick::kNowhere) << test::name(kind);
            }
    }
}

/// Straight down at the middle of each cell, and a little beside it: a hole is where no post of the
/// cell is data, ground is where all are; between the two each triangle decides.
TEST(HardCase22, PicksFallThroughHolesOfATerrainAndNothingElse) {
    const test::TemporaryFolder folder;
    terrain::HeightGrid grid = test::hardGrid(GridKind::Smooth, 40, 37, 5);
    std::mt19937 engine(27);
    for (float& height : grid.heights)
        if (engine() % 6 == 0)
            height = terrain::kNodata;
    for (int j = 20; j < 30; ++j)
        for (int i = 25; i < 36; ++i) grid.row(j)[i] = terrain::kNodata;
    const Pair pair = terrainPair(folder, grid);
    int fallen = 0;
    for (int j = 0; j < 36; ++j)
        for (int i = 0; i < 39; ++i) {
            int data = 0;
            for (const int corner : {0, 1, 2, 3})
                data += std::isnan(grid.at(i + corner % 2, j + corner / 2)) ? 0 : 1;
            const fabric::Vec2 at =
                grid.origin + grid.perColumn * (i + 0.55) + grid.perRow * (j + 0.52);
            const Vec3 target(at.x, at.y, 0);
            const auto picked =
                pair.pick({target + Vec3(0, 0, 900), target, {0, 1, 0}}, {640, 360});
            ASSERT_TRUE(picked.ok()) << picked.status();
            fallen += picked->has_value() ? 0 : 1;
            if (data == 0 || data == 4) {
                EXPECT_EQ(picked->has_value(), data == 4) << i << " " << j;
            }
            if (picked->has_value())
                pair.holdNearest(**picked);
        }
    EXPECT_GT(fallen, 100);
}

class PickScene : public testing::Test {
protected:
    /// A square of two triangles, 2 m a side, around a point, facing up or whichever way.
    fabric::SceneObject square(const std::string& name, const fabric::Mat4& worldFromObject) {
        import::TriangleMesh mesh;
        mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        const std::string path = folder_.path(name + ".eym");
        EXPECT_TRUE(import::importMesh(std::move(mesh), path).ok());
        return {.name = name, .path = path, .worldFromObject = worldFromObject};
    }

    absl::StatusOr<fabric::Picked> pick(const fabric::Scene& scene, const Camera& camera,
                                        const Vec2& place = {320, 240}) {
        auto picker = Picker::open(scene, {});
        EXPECT_TRUE(picker.ok()) << picker.status();
        return (*picker)->pick({camera, 640, 480, place});
    }

    static fabric::Mat4 movedTo(const Vec3& by) { return glm::translate(fabric::Mat4(1), by); }

    const Camera down_{{0.3, 0.1, 10}, {0.3, 0.1, 0}, {0, 1, 0}};
    const test::TemporaryFolder folder_;
};

TEST_F(PickScene, GivesTheNearestOfSeveralObjects) {
    fabric::Scene scene;
    scene.objects = {square("low", movedTo({0, 0, 1})), square("high", movedTo({0, 0, 3})),
                     square("aside", movedTo({5, 0, 6}))};
    const auto picked = pick(scene, down_);
    ASSERT_TRUE(picked.ok() && picked->has_value());
    EXPECT_EQ((*picked)->object, 1);
    EXPECT_LT(glm::length((*picked)->worldMetres - Vec3(0.3, 0.1, 3)), 1e-9);
    EXPECT_NEAR((*picked)->distanceMetres, 7, 1e-9);
    EXPECT_NEAR((*picked)->normal.z, 1, 1e-9);
    EXPECT_NEAR((*picked)->pixelMetres, 2 * 7 * std::tan(M_PI / 8) / 480, 1e-9);
    EXPECT_FALSE((*picked)->elevationMetres.has_value());
}

TEST_F(PickScene, MeetsNothingBesideBehindAndInAnEmptyScene) {
    fabric::Scene scene;
    EXPECT_EQ(*pick(scene, down_), fabric::Picked());
    scene.objects = {square("one", movedTo({0, 0, 0}))};
    EXPECT_EQ(*pick(scene, down_, {0, 0}), fabric::Picked());
    EXPECT_EQ(*pick(scene, {{0, 0, 10}, {0, 0, 20}, {0, 1, 0}}), fabric::Picked());
}

TEST_F(PickScene, LeavesBacksOutWhereThePictureDoes) {
    const Camera up{{0.3, 0.1, -10}, {0.3, 0.1, 0}, {0, 1, 0}};
    fabric::Scene scene;
    scene.objects = {square("one", movedTo({0, 0, 0}))};
    const auto back = pick(scene, up);
    ASSERT_TRUE(back.ok() && back->has_value());
    EXPECT_NEAR((*back)->normal.z, -1, 1e-9);
    scene.objects[0].singleSided = true;
    EXPECT_EQ(*pick(scene, up), fabric::Picked());
    EXPECT_TRUE(pick(scene, down_)->has_value());
}

TEST_F(PickScene, RefusesPlacesOutsideThePictureAndWhatIsNoCamera) {
    fabric::Scene scene;
    scene.objects = {square("one", movedTo({0, 0, 0}))};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Vec2& place : {Vec2(-0.01, 5), Vec2(5, 480.01), Vec2(nan, 5), Vec2(5, nan)})
        EXPECT_TRUE(absl::IsInvalidArgument(pick(scene, down_, place).status()));
    Camera bad = down_;
    bad.eye.x = nan;
    EXPECT_TRUE(absl::IsInvalidArgument(pick(scene, bad).status()));
    const auto picker = Picker::open(scene, {});
    EXPECT_TRUE(absl::IsInvalidArgument((*picker)->pick({down_, 0, 480, {0, 0}}).status()));
    EXPECT_TRUE(absl::IsInvalidArgument((*picker)->pick({down_, 640, 480, {1, 1}, nan}).status()));
    scene.objects[0].path = folder_.path("absent.eym");
    EXPECT_TRUE(absl::IsNotFound(Picker::open(scene, {}).status()));
}

TEST_F(PickScene, EndsWhenItsTimeIsOver) {
    fabric::Scene scene;
    scene.objects = {square("one", movedTo({0, 0, 0}))};
    const auto picker = Picker::open(scene, {});
    ASSERT_TRUE(picker.ok());
    EXPECT_TRUE(absl::IsDeadlineExceeded(
        (*picker)->pick({down_, 640, 480, {320, 240}}, Picker::Clock::now()).status()));
}

/// Coarser data do not stand in.
TEST_F(PickScene, NamesThePageThatIsDamaged) {
    const std::string path = folder_.path("terrain.eyt");
    const terrain::HeightGrid grid = test::hardGrid(GridKind::Noise, 300, 300, 5);
    ASSERT_TRUE(import::importTerrain(grid, {"grid", "", 0}, path, {}).ok());
    const auto size = std::filesystem::file_size(path);
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    for (std::uintmax_t at = 4096; at < size / 2; at += 4096)
        file.seekp(static_cast<std::streamoff>(at)).put('\x5a');
    file.close();
    fabric::Scene scene;
    scene.objects.push_back({.name = "t", .kind = fabric::ObjectKind::Terrain, .path = path});
    int refused = 0;
    for (int k = 0; k < 9; ++k) {
        const int column = 40 + 100 * (k % 3);
        const int row = 40 + 100 * (k / 3);
        const fabric::Vec2 at =
            grid.origin + grid.perColumn * (1.0 * column) + grid.perRow * (1.0 * row);
        const auto picked = pick(scene, {{at.x, at.y, 9000}, {at.x, at.y, 0}, {0, 1, 0}});
        if (picked.ok())
            continue;
        ++refused;
        const std::string message = picked.status().ToString();
        EXPECT_TRUE(absl::IsDataLoss(picked.status())) << message;
        EXPECT_NE(message.find(path), std::string::npos) << message;
    }
    EXPECT_GT(refused, 0);
}

}  // namespace eyrie
}  // namespace eyrie
