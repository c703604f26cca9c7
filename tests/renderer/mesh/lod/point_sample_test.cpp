// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/point_sample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "renderer/mesh/image_codec.h"
#include "renderer/mesh/vertex_packing.h"
#include "renderer/truth/mesh_ray_caster.h"
#include "tests/renderer/mesh/sample_meshes.h"

namespace eyrie::mesh {
namespace {

constexpr double kAnyError = std::numeric_limits<double>::infinity();

Patch wholeOf(const PackedMesh& mesh) {
    return {mesh.triangles, std::vector<Shifts>(mesh.triangles.size())};
}

std::optional<PointSample> sampled(const PackedMesh& mesh, std::size_t mostPoints) {
    const SurfaceColours colours(mesh);
    return samplePoints(mesh, wholeOf(mesh), colours, mostPoints, kAnyError);
}

std::vector<glm::dvec3> placesOf(const PointSample& sample) {
    std::vector<glm::dvec3> places;
    for (const std::uint64_t position : sample.positions)
        places.emplace_back(unpackPosition(position));
    return places;
}

std::array<glm::dvec3, 3> cornersOf(const PackedMesh& mesh, const Triangle& triangle) {
    std::array<glm::dvec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
        corners[k] = glm::dvec3(unpackPosition(mesh.positions[triangle[k]]));
    return corners;
}

/// Random points of random triangles, corners among them.
std::vector<glm::dvec3> pointsOn(const PackedMesh& mesh, std::size_t count, std::mt19937& random) {
    std::uniform_real_distribution<double> share(0, 1);
    std::vector<glm::dvec3> points;
    while (points.size() < count) {
        const auto [a, b, c] = cornersOf(mesh, mesh.triangles[random() % mesh.triangles.size()]);
        const double root = std::sqrt(share(random));
        const double along = share(random);
        points.push_back((1 - root) * a + root * (1 - along) * b + root * along * c);
        points.push_back(a);
    }
    return points;
}

double nearest(const glm::dvec3& point, std::span<const glm::dvec3> places) {
    double least = std::numeric_limits<double>::infinity();
    for (const glm::dvec3& place : places) least = std::min(least, glm::distance(point, place));
    return least;
}

void checkOrder(const PointSample& sample, std::size_t mostPoints) {
    RC_ASSERT(!sample.prefixes.empty());
    for (std::size_t i = 1; i < sample.prefixes.size(); ++i) {
        RC_ASSERT(sample.prefixes[i].points > sample.prefixes[i - 1].points);
        RC_ASSERT(sample.prefixes[i].errorSteps < sample.prefixes[i - 1].errorSteps);
    }
    RC_ASSERT(sample.prefixes.back().points == sample.positions.size());
    RC_ASSERT(sample.positions.size() <= mostPoints);
    RC_ASSERT(sample.normals.size() == sample.positions.size());
}

RC_GTEST_PROP(PointSample, EveryPrefixHasAPointNearEachOfTheSurface, ()) {
    const auto seed = *rc::gen::arbitrary<std::uint32_t>();
    const auto extent = *rc::gen::element(20U, 3000U, 1U << 20);
    const auto mostPoints = *rc::gen::element<std::size_t>(1, 50, 500);
    const PackedMesh mesh = test::randomSoup(*rc::gen::inRange<std::uint32_t>(1, 60), 100, extent,
                                             seed, *rc::gen::arbitrary<bool>());
    const auto sample = sampled(mesh, mostPoints);
    RC_ASSERT(sample.has_value());
    RC_ASSERT(sample->prefixes.front().points == 1U);
    checkOrder(*sample, mostPoints);
    RC_ASSERT(sample->colours.size() == (mesh.colours.empty() ? 0 : sample->positions.size()));
    const std::vector<glm::dvec3> places = placesOf(*sample);
    std::mt19937 random(seed);
    const std::vector<glm::dvec3> points = pointsOn(mesh, 200, random);
    for (const PointPrefix& prefix : sample->prefixes)
        for (const glm::dvec3& point : points)
            RC_ASSERT(nearest(point, std::span(places).first(prefix.points)) <= prefix.errorSteps);
}

/// The side of a hall, and a hair across it.
PackedMesh wallAndHair() {
    PackedMesh mesh;
    for (const glm::uvec3 point : {glm::uvec3(0, 0, 0),
                                   {60000, 0, 0},
                                   {60000, 40000, 0},
                                   {0, 40000, 0},
                                   {0, 0, 5000},
                                   {60000, 40000, 5000},
                                   {60000, 40003, 5000}}) {
        mesh.positions.push_back(packPosition(point));
        mesh.normals.push_back(packNormal({0, 0, 1}));
    }
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
    return mesh;
}

TEST(PointSample, IsNoFinerThanItSaysNorMuchCoarser) {
    const PackedMesh mesh = wallAndHair();
    const auto sample = sampled(mesh, 2000);
    ASSERT_TRUE(sample.has_value());
    truth::TriangleMesh plain;
    for (const std::uint64_t position : mesh.positions)
        plain.positions.emplace_back(unpackPosition(position));
    plain.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
    const truth::MeshRayCaster surface(std::move(plain));
    const std::vector<glm::dvec3> places = placesOf(*sample);
    for (const glm::dvec3& place : places)
        EXPECT_LE(glm::distance(*surface.counterpart(place), place), 1);
    std::mt19937 random(5);
    double worst = 0;
    for (const glm::dvec3& point : pointsOn(mesh, 4000, random))
        worst = std::max(worst, nearest(point, places));
    fmt::print("{} points: promised {:.0f} steps, measured {:.0f}\n", places.size(),
               sample->errorSteps(), worst);
    EXPECT_LE(worst, sample->errorSteps());
    EXPECT_GE(worst, 0.5 * sample->errorSteps());
    // A square of a side of this many steps for each: what darts leave, and half as much again.
    EXPECT_LE(sample->errorSteps(), 2 * std::sqrt(6e4 * 4e4 / 2000));
}

TEST(PointSample, OfANeedleTakesNoMoreTimeThanItIsLong) {
    PackedMesh mesh = wallAndHair();
    mesh.positions[5] = packPosition({kMaxLatticeCoordinate, kMaxLatticeCoordinate, 5000});
    mesh.positions[6] = packPosition({kMaxLatticeCoordinate, kMaxLatticeCoordinate - 1, 5000});
    mesh.triangles = {{4, 5, 6}};
    const auto sample = sampled(mesh, 8192);
    ASSERT_TRUE(sample.has_value());
    EXPECT_LE(sample->errorSteps(), std::sqrt(2) * kMaxLatticeCoordinate / 4096 * 1.5);
}

TEST(PointSample, CountsHowFarTheSurfaceIsOffItself) {
    const PackedMesh mesh = wallAndHair();
    const SurfaceColours colours(mesh);
    Patch patch = wholeOf(mesh);
    const auto exact = samplePoints(mesh, patch, colours, 100, kAnyError);
    for (Shifts& one : patch.shifts) one = Shifts().andThen(700);
    const auto shifted = samplePoints(mesh, patch, colours, 100, kAnyError);
    ASSERT_TRUE(exact && shifted);
    EXPECT_NEAR(shifted->errorSteps(), exact->errorSteps() + 700, 1);
    EXPECT_FALSE(samplePoints(mesh, patch, colours, 100, shifted->errorSteps() - 1).has_value());
}

/// A square: one triangle of each of two materials, with an image of which the left half is red and
/// the right half green and see-through.
PackedMesh picture(const Material& left, const Material& right) {
    PackedMesh mesh;
    mesh.materials = {left, right};
    for (const std::uint16_t material : {std::uint16_t{0}, std::uint16_t{1}})
        for (const glm::uvec3 point :
             {glm::uvec3(0, 0, 9), {8192, 0, 9}, {8192, 8192, 9}, {0, 8192, 9}}) {
            mesh.positions.push_back(packPosition(point));
            mesh.normals.push_back(packNormal({1, 0, 1}));
            mesh.textureCoordinates.emplace_back(point.x * 8, point.y * 8);
            mesh.materialOf.push_back(material);
        }
    mesh.triangles = {{0, 1, 2}, {4, 6, 7}};
    std::vector<fabric::Rgba> texels;
    for (int i = 0; i < 64; ++i)
        texels.push_back(i % 8 < 4 ? fabric::Rgba{255, 0, 0, 255} : fabric::Rgba{0, 255, 0, 0});
    mesh.images.push_back(encodeImage({8, 8, kHasAlpha, 0, 0}, texels));
    return mesh;
}

TEST(PointSample, HasTheColoursOfTheImageAndNoneInItsHoles) {
    const auto full = sampled(picture({.image = 0}, {.image = 0}), 1000);
    const auto cut = sampled(
        picture({.image = 0, .alphaCutoff = 0.5F}, {.image = 0, .alphaCutoff = 0.5F}), 1000);
    ASSERT_TRUE(full && cut);
    std::size_t right = 0;
    for (std::size_t i = 0; i < full->positions.size(); ++i) {
        const bool isRight = unpackPosition(full->positions[i]).x > 4096;
        const fabric::Rgba colour = unpackColour(full->colours[i]);
        EXPECT_EQ(colour.g > colour.r, isRight) << unpackPosition(full->positions[i]).x;
        right += isRight ? 1 : 0;
    }
    EXPECT_GT(right, full->positions.size() / 3);
    for (const std::uint64_t position : cut->positions)
        EXPECT_LE(unpackPosition(position).x, 4096U);
}

TEST(PointSample, SaysFromWhichSidesItsPointsAreSeen) {
    const auto sample =
        sampled(picture({.flags = kIsOneSided}, {.image = 0, .flags = kIsTwoSided}), 100);
    ASSERT_TRUE(sample.has_value());
    bool hasOne = false, hasBoth = false;
    for (std::size_t i = 0; i < sample->positions.size(); ++i) {
        const glm::uvec3 place = unpackPosition(sample->positions[i]);
        const bool isOneSided = place.x > place.y;
        EXPECT_EQ(unpackColour(sample->colours[i]).a, isOneSided ? kSeenFromFront : kSeenFromBoth);
        // Of one that is not seen from behind, where it faces; of others, how it is lit.
        const glm::vec3 normal = unpackNormal(sample->normals[i]);
        EXPECT_NEAR(normal.x, isOneSided ? 0 : std::sqrt(0.5F), 1e-3F);
        (isOneSided ? hasOne : hasBoth) = true;
    }
    EXPECT_TRUE(hasOne && hasBoth);
    const auto plain = sampled(picture({}, {.image = 0}), 100);
    ASSERT_TRUE(plain.has_value());
    EXPECT_EQ(unpackColour(plain->colours[0]).a, kSeenFromBoth);
}

TEST(PointSample, IsNotMadeWhereNothingCouldSayThatItHasOneSide) {
    PackedMesh mesh = wallAndHair();
    mesh.materials = {{.flags = kIsOneSided}};
    mesh.materialOf.assign(mesh.positions.size(), 0);
    EXPECT_FALSE(sampled(mesh, 100).has_value());
    mesh.colours.assign(mesh.positions.size(), 0xFFFFFFFF);
    EXPECT_TRUE(sampled(mesh, 100).has_value());
}

TEST(PointSample, IsNotMadeOfWhatIsBlendedNorOfHolesAlone) {
    EXPECT_FALSE(sampled(picture({}, {.flags = kIsBlended}), 100).has_value());
    PackedMesh holes =
        picture({.image = 0, .alphaCutoff = 0.5F}, {.image = 0, .alphaCutoff = 0.5F});
    for (glm::ivec2& place : holes.textureCoordinates) place.x = 50000;
    EXPECT_FALSE(sampled(holes, 100).has_value());
}

}  // namespace
}  // namespace eyrie::mesh
