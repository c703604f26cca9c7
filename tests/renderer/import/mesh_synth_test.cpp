// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/mesh_synth.h"

#include <cmath>
#include <map>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

namespace eyrie::import {
namespace {

class MeshSynth : public testing::TestWithParam<std::uint64_t> {};

TEST_P(MeshSynth, IsClosedAndFacesOutwards) {
    const TriangleMesh mesh = synthesizeMesh(GetParam(), 3);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    double volume = 0;
    for (const auto& t : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
        volume +=
            glm::dot(mesh.positions[t[0]], glm::cross(mesh.positions[t[1]], mesh.positions[t[2]])) /
            6;
    }
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        EXPECT_TRUE(edges.contains({edge.second, edge.first}));
    }
    EXPECT_EQ(mesh.positions.size() + mesh.triangles.size(), edges.size() / 2 + 2);  // Euler
    EXPECT_GT(volume, 0);
}

TEST_P(MeshSynth, HasAboutTheTrianglesAskedFor) {
    const auto asked = static_cast<double>(GetParam());
    const auto made = static_cast<double>(synthesizeMesh(GetParam(), 3).triangles.size());
    EXPECT_NEAR(made, std::max(asked, 8.0), 3 * std::sqrt(asked) + 8);
}

/// In memory of its own, so that it is rounded whatever the compiler makes of the way back.
bool isFloatsValue(double value) {
    const volatile auto rounded = static_cast<float>(value);
    return rounded == value;
}

void expectFloats(const TriangleMesh& mesh) {
    for (const fabric::Vec3& position : mesh.positions)
        for (int axis = 0; axis < 3; ++axis)
            ASSERT_TRUE(isFloatsValue(position[axis])) << position[axis];
}

TEST_P(MeshSynth, HasFloatsAsCoordinates) { expectFloats(synthesizeMesh(GetParam(), 3)); }

INSTANTIATE_TEST_SUITE_P(Sizes, MeshSynth, testing::Values(0, 8, 32, 1000, 20000));

TEST(MeshSynth, IsTheSameForASeedAndAnotherForAnother) {
    const TriangleMesh mesh = synthesizeMesh(5000, 7);
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_TRUE(synthesizeMesh(5000, 7) == mesh);
    EXPECT_FALSE(synthesizeMesh(5000, 8) == mesh);
}

TEST(MeshSynth, KeepsItsLargeShapeAtEverySize) {
    const TriangleMesh coarse = synthesizeMesh(8 * 64 * 64, 7);
    const TriangleMesh fine = synthesizeMesh(8 * 128 * 128, 7);
    EXPECT_LT(glm::distance(coarse.positions.front(), fine.positions.front()), 0.02);
    EXPECT_LT(glm::distance(coarse.positions.back(), fine.positions.back()), 0.02);
}

TEST(MeshSynth, HasBumpsButKeepsItsMiddle) {
    double least = 10;
    double most = 0;
    for (const fabric::Vec3& position : synthesizeMesh(5000, 7).positions) {
        least = std::min(least, glm::length(position));
        most = std::max(most, glm::length(position));
    }
    EXPECT_GE(least, 0.19);
    EXPECT_GT(most - least, 0.1);
    EXPECT_LT(most, 2);
}

/// Of two triangles that meet at an edge, how far their normals are apart on average, in radians.
double meanBend(const TriangleMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, fabric::Vec3> normals;
    for (const auto& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            normals[{t[i], t[(i + 1) % 3]}] =
                glm::normalize(glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                                          mesh.positions[t[2]] - mesh.positions[t[0]]));
    double sum = 0;
    for (const auto& [edge, normal] : normals)
        sum += std::acos(std::min(glm::dot(normal, normals[{edge.second, edge.first}]), 1.0));
    return sum / static_cast<double>(normals.size());
}

TEST(MeshSynth, BendsLessWhereItIsLessRoughAndAsMuchAtEverySizeWhereItIsEven) {
    const auto bend = [](std::uint64_t triangles, double roughness) {
        return meanBend(synthesizeMesh(triangles, 7, roughness));
    };
    EXPECT_LT(bend(40000, 0), bend(40000, kScanRoughness));
    EXPECT_LT(bend(40000, kScanRoughness), bend(40000, kEvenRoughness));
    EXPECT_NEAR(bend(40000, kEvenRoughness), bend(10000, kEvenRoughness), 0.02);
    EXPECT_LT(bend(40000, kScanRoughness), 0.75 * bend(10000, kScanRoughness));
}

TEST(Subdivide, CutsEachTriangleIntoFourAndKeepsTheSurface) {
    const TriangleMesh source = synthesizeMesh(200, 7);
    const auto fine = subdivide(source, 2);
    ASSERT_TRUE(fine.ok()) << fine.status();
    EXPECT_EQ(fine->triangles.size(), 16 * source.triangles.size());
    EXPECT_EQ(fine->positions.size(), 8 * source.triangles.size() + 2);  // closed: Euler
    const auto area = [](const TriangleMesh& mesh) {
        fabric::Vec3 sum(0.0);
        double size = 0;
        for (const auto& t : mesh.triangles) {
            const fabric::Vec3 normal = glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                                                   mesh.positions[t[2]] - mesh.positions[t[0]]);
            sum += normal;
            size += glm::length(normal);
        }
        EXPECT_LT(glm::length(sum), 1e-6);
        return size;
    };
    EXPECT_NEAR(area(*fine), area(source), 1e-5);
    EXPECT_EQ(subdivide(source, 0)->triangles, source.triangles);
}

TEST(Subdivide, HasFloatsAsCoordinates) { expectFloats(*subdivide(synthesizeMesh(200, 7), 2)); }

TEST(Subdivide, RefusesToMakeTooMany) {
    const auto huge = subdivide(synthesizeMesh(200, 7), 12);
    EXPECT_EQ(huge.status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(Displace, HasFloatsAsCoordinates) {
    TriangleMesh mesh = synthesizeMesh(5000, 7);
    displace(mesh, 0.01, 3);
    expectFloats(mesh);
}

TEST(Displace, MovesPointsButNotFar) {
    const TriangleMesh source = synthesizeMesh(5000, 7);
    TriangleMesh moved = source;
    displace(moved, 0.01, 3);
    double farthest = 0;
    for (std::size_t i = 0; i < source.positions.size(); ++i)
        farthest = std::max(farthest, glm::distance(source.positions[i], moved.positions[i]));
    EXPECT_LT(farthest, 0.01 * std::sqrt(3));
    EXPECT_GT(farthest, 0.002);
    TriangleMesh again = source;
    displace(again, 0.01, 3);
    EXPECT_TRUE(again == moved);
    displace(again = source, 0.01, 4);
    EXPECT_FALSE(again == moved);
    TriangleMesh point;
    point.positions = {{1, 2, 3}};
    displace(point, 1, 3);
    EXPECT_EQ(point.positions[0], fabric::Vec3(1, 2, 3));
}

}  // namespace
}  // namespace eyrie::import
