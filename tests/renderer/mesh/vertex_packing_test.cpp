// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/vertex_packing.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::mesh {
namespace {

constexpr double kMaxNormalErrorRadians = 1e-4;  // 0.006 degrees, half a snorm step and folding

double angle(const glm::vec3& a, const glm::vec3& b) {
    const glm::dvec3 u = glm::normalize(glm::dvec3(a));
    const glm::dvec3 v = glm::normalize(glm::dvec3(b));
    return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

RC_GTEST_PROP(VertexPacking, GivesEveryLatticePointBack, ()) {
    const auto axis = rc::gen::inRange<std::uint32_t>(0, kMaxLatticeCoordinate + 1);
    const glm::uvec3 point(*axis, *axis, *axis);
    RC_ASSERT(unpackPosition(packPosition(point)) == point);
}

TEST(VertexPacking, PutsXLowestAndLeavesTheTopBitFree) {
    const std::uint32_t all = kMaxLatticeCoordinate;
    EXPECT_EQ(packPosition({all, 0, 0}), 0x1FFFFFULL);
    EXPECT_EQ(packPosition({0, all, 0}), 0x1FFFFFULL << 21);
    EXPECT_EQ(packPosition({0, 0, all}), 0x1FFFFFULL << 42);
    EXPECT_EQ(packPosition({all, all, all}) >> 63, 0ULL);
}

RC_GTEST_PROP(VertexPacking, TurnsANormalByLessThanItsBound, ()) {
    const auto component = rc::gen::inRange(-1000, 1001);
    const glm::vec3 normal(*component, *component, *component);
    RC_PRE(normal != glm::vec3(0));
    RC_ASSERT(angle(unpackNormal(packNormal(normal)), normal) < kMaxNormalErrorRadians);
}

TEST(VertexPacking, KeepsAxesAndTheFoldsOfTheOctahedron) {
    for (const glm::vec3 normal : {glm::vec3(1, 0, 0),
                                   {-1, 0, 0},
                                   {0, 1, 0},
                                   {0, -1, 0},
                                   {0, 0, 1},
                                   {0, 0, -1},
                                   {1, 1, 0},
                                   {-1, 1, 0},
                                   {1, -1, 0},
                                   {-1, -1, 0},
                                   {1, 0, -1},
                                   {0, -1, -1},
                                   {1e-20F, 0, -1}})
        EXPECT_LT(angle(unpackNormal(packNormal(normal)), normal), kMaxNormalErrorRadians)
            << normal.x << " " << normal.y << " " << normal.z;
}

TEST(VertexPacking, DoesNotCareForANormalsLength) {
    EXPECT_EQ(packNormal({0x3p100F, -0x1p100F, 0x2p100F}),
              packNormal({0x3p-100F, -0x1p-100F, 0x2p-100F}));
}

TEST(VertexPacking, StoresColoursAsRgbaBytes) {
    const fabric::Rgba colour{1, 2, 3, 4};
    EXPECT_EQ(packColour(colour), 0x04030201U);
    EXPECT_EQ(unpackColour(packColour(colour)), colour);
}

}  // namespace
}  // namespace eyrie::mesh
