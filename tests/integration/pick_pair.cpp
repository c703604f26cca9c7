// SPDX-License-Identifier: Apache-2.0
#include "tests/integration/pick_pair.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "renderer/import/terrain_import.h"
#include "renderer/truth/mesh_ray_caster.h"
#include "renderer/truth/pinhole.h"
#include "renderer/truth/terrain_ray_caster.h"

namespace eyrie::test {

using fabric::Camera;
using fabric::PickedPoint;
using fabric::Vec2;
using fabric::Vec3;
using pick::Picker;

PickPair::PickPair(std::shared_ptr<const Picker> picker,
                   std::unique_ptr<truth::ReferenceSurface> source, double exaggeration)
    : picker_(std::move(picker)), source_(std::move(source)), exaggeration_(exaggeration) {}

absl::StatusOr<fabric::Picked> PickPair::pick(const Camera& camera, const Vec2& place) const {
    return picker_->pick({camera, kWidth, kHeight, place, exaggeration_});
}

void PickPair::hold(const Camera& camera, const Vec2& place, PickTally& tally) const {
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

void PickPair::holdThrough(const Wall& wall, const Vec3& eye, const Camera& camera,
                           const Vec2& place, PickTally& tally) const {
    fabric::PickRequest request{camera, kWidth, kHeight, place, exaggeration_};
    request.sight = sightThrough(wall, eye);
    const auto picked = picker_->pick(request);
    ASSERT_TRUE(picked.ok()) << picked.status();
    const Wall inWorld = test::inWorld(camera, wall);
    const truth::Pinhole judge(test::inWorld(camera, eye),
                               {inWorld.lowerLeft, inWorld.lowerRight, inWorld.upperLeft}, kWidth,
                               kHeight);
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
    const double pixels = (request.sight->frustum.top - request.sight->frustum.bottom) / kHeight;
    EXPECT_NEAR((*picked)->pixelMetres, judge.depth((*picked)->worldMetres) * pixels,
                (1e-9 + 10 * judgesTurn) * (*picked)->pixelMetres);
}

void PickPair::holdNearest(const PickedPoint& point) const {
    const auto partner = source_->counterpart(point.worldMetres);
    ASSERT_TRUE(partner.has_value());
    EXPECT_LE(glm::length(*partner - point.worldMetres), point.errorMetres + 1e-9);
}

void PickPair::holdPoint(const PickedPoint& point, double first, double last,
                         PickTally& tally) const {
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
void PickPair::holdError(const PickedPoint& point, double rounding) const {
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

std::shared_ptr<const Picker> openPicker(const fabric::SceneObject& object) {
    fabric::Scene scene;
    scene.objects.push_back(object);
    auto picker = Picker::open(scene, {});
    EXPECT_TRUE(picker.ok()) << picker.status();
    return picker.ok() ? *picker : nullptr;
}

PickPair terrainPair(const TemporaryFolder& folder, const terrain::HeightGrid& grid,
                     double exaggeration) {
    const std::string path = folder.path("terrain.eyt");
    const auto report = import::importTerrain(grid, {"grid", "", 0}, path, {});
    EXPECT_TRUE(report.ok()) << report.status();
    truth::HeightGrid posts{grid.columns, grid.rows,      grid.heights,
                            grid.origin,  grid.perColumn, grid.perRow};
    for (float& height : posts.heights) height = static_cast<float>(height * exaggeration);
    return {openPicker({.name = "terrain", .kind = fabric::ObjectKind::Terrain, .path = path}),
            std::make_unique<truth::TerrainRayCaster>(std::move(posts)), exaggeration};
}

PickPair meshPair(const TemporaryFolder& folder, import::TriangleMesh mesh,
                  const fabric::Mat4& worldFromObject, const import::MeshImportOptions& options) {
    truth::TriangleMesh source{mesh.positions, mesh.triangles};
    for (Vec3& p : source.positions) p = Vec3(worldFromObject * fabric::Vec4(p, 1));
    const std::string path = folder.path("mesh.eym");
    const auto report = import::importMesh(std::move(mesh), path, options);
    EXPECT_TRUE(report.ok()) << report.status();
    return {openPicker({.name = "mesh", .path = path, .worldFromObject = worldFromObject}),
            std::make_unique<truth::MeshRayCaster>(std::move(source))};
}

std::vector<Vec2> placesAround(const Camera& camera, const Vec3& centre, double radius, int count,
                               std::mt19937& engine) {
    const truth::Pinhole pinhole(camera, PickPair::kWidth, PickPair::kHeight);
    const double reach = pinhole.focalPixels() * radius / glm::length(centre - camera.eye);
    const Vec2 middle =
        pinhole.project(centre).value_or(Vec2(PickPair::kWidth / 2.0, PickPair::kHeight / 2.0));
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<Vec2> places;
    while (places.size() < static_cast<std::size_t>(count)) {
        const Vec2 place =
            middle + std::min(reach, 1.0 * PickPair::kWidth) * Vec2(unit(engine), unit(engine));
        if (place.x >= 0 && place.y >= 0 && place.x <= PickPair::kWidth &&
            place.y <= PickPair::kHeight)
            places.push_back(place);
    }
    return places;
}

std::vector<NamedCamera> camerasOver(const Vec3& ground) {
    const auto from = [&](const Vec3& offset, double fovYDegrees) {
        return Camera{ground + offset, ground, {0, 0, 1}, fovYDegrees};
    };
    return {{"1 m", from({0.6, 0.5, 0.6}, 60)},
            {"1 km", from({500, -600, 620}, 60)},
            {"1,000 km", from({3e5, 4e5, 8.6e5}, 1)},
            {"grazing", from({-900, 700, 2}, 40)}};
}

}  // namespace eyrie::test
