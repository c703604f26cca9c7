// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lattice.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::mesh {
namespace {

/// A coordinate of any size the importer takes, from 2^-60 m to 2^49 m.
rc::Gen<double> coordinate() {
    return rc::gen::map(
        rc::gen::tuple(rc::gen::inRange(-1000000, 1000001), rc::gen::inRange(-80, 30)),
        [](const std::tuple<int, int>& parts) {
            return std::ldexp(std::get<0>(parts), std::get<1>(parts));
        });
}

rc::Gen<std::vector<fabric::Vec3>> points() {
    return rc::gen::nonEmpty(rc::gen::container<std::vector<fabric::Vec3>>(
        rc::gen::construct<fabric::Vec3>(coordinate(), coordinate(), coordinate())));
}

fabric::Box boundsOf(const std::vector<fabric::Vec3>& points) {
    fabric::Box box;
    for (const fabric::Vec3& point : points) box.grow(point);
    return box;
}

long double distance(const fabric::Vec3& a, const fabric::Vec3& b) {
    const auto square = [](long double d) { return d * d; };
    return std::sqrt(square(static_cast<long double>(a.x) - b.x) +
                     square(static_cast<long double>(a.y) - b.y) +
                     square(static_cast<long double>(a.z) - b.z));
}

RC_GTEST_PROP(Lattice, HoldsEveryPointWithinItsErrorIn21Bits, ()) {
    const auto cloud = *points();
    const auto lattice = fitLattice(boundsOf(cloud));
    RC_ASSERT(lattice.ok());
    RC_ASSERT(isValid(*lattice));
    for (const fabric::Vec3& point : cloud) {
        const glm::uvec3 nearest = lattice->nearest(point);
        RC_ASSERT(nearest.x <= kMaxLatticeCoordinate);
        RC_ASSERT(nearest.y <= kMaxLatticeCoordinate);
        RC_ASSERT(nearest.z <= kMaxLatticeCoordinate);
        RC_ASSERT(distance(lattice->metres(nearest), point) <=
                  static_cast<long double>(lattice->errorMetres()) * (1 + 1e-15L));
    }
}

RC_GTEST_PROP(Lattice, KeepsAPointOfItsOwnWhereItIs, ()) {
    const auto lattice = fitLattice(boundsOf(*points()));
    RC_ASSERT(lattice.ok());
    const auto axis = rc::gen::inRange<std::uint32_t>(0, kMaxLatticeCoordinate + 1);
    const glm::uvec3 point(*axis, *axis, *axis);
    RC_ASSERT(lattice->nearest(lattice->metres(point)) == point);
}

TEST(Lattice, IsTheFinestThatHasRoomForTheExtent) {
    const auto step = [](double extent) {
        return fitLattice({{0, 0, 0}, {0, extent, 0}})->stepMetres;
    };
    EXPECT_EQ(step(kMaxLatticeCoordinate), 1);
    EXPECT_EQ(step(kMaxLatticeCoordinate + 1.0), 2);
    EXPECT_EQ(step(1), std::ldexp(1, -20));
}

TEST(Lattice, CoversATerametreWithAMicrometreBesideIt) {
    const auto lattice = fitLattice({{1e-6, 0, 0}, {1e12, 1e-6, 0}});
    ASSERT_TRUE(lattice.ok());
    EXPECT_EQ(lattice->nearest({1e-6, 0, 0}), glm::uvec3(0, 0, 0));
    EXPECT_NEAR(lattice->metres(lattice->nearest({1e12, 0, 0})).x, 1e12, lattice->errorMetres());
}

TEST(Lattice, NeverGetsFinerThanTheDigitsOfFarCoordinates) {
    const double far = 1e15;
    const auto lattice = fitLattice({{far, 0, 0}, {std::nextafter(far, 0.0), 0, 0}});
    EXPECT_FALSE(lattice.ok());  // min above max: an empty box
    const auto swapped = fitLattice({{std::nextafter(far, 0.0), 0, 0}, {far, 0, 0}});
    ASSERT_TRUE(swapped.ok());
    EXPECT_EQ(swapped->metres(swapped->nearest({far, 0, 0})).x, far);
}

TEST(Lattice, RefusesCoordinatesBeyondItsLimitSayingWhatTheyAre) {
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double extreme : {2e15, 1e300, infinity, std::nan("")}) {
        const auto lattice = fitLattice({{0, 0, 0}, {0, 0, extreme}});
        ASSERT_EQ(lattice.status().code(), absl::StatusCode::kInvalidArgument) << extreme;
        EXPECT_THAT(std::string(lattice.status().message()), testing::HasSubstr("z 0 to"));
    }
    EXPECT_FALSE(fitLattice({}).ok());
}

TEST(Lattice, IsValidOnlyWithAPowerOfTwoAndAMultipleOfIt) {
    EXPECT_TRUE(isValid({{3, 0, -5.5}, 0.5}));
    EXPECT_FALSE(isValid({{3, 0, -5.5}, 0.75}));
    EXPECT_FALSE(isValid({{3, 0.25, 0}, 0.5}));
    EXPECT_FALSE(isValid({{3, 0, 0}, 0}));
    EXPECT_FALSE(isValid({{3, 0, 0}, -0.5}));
    EXPECT_FALSE(isValid({{std::nan(""), 0, 0}, 0.5}));
    EXPECT_FALSE(isValid({{0, 0, 0}, std::ldexp(1, 80)}));
    EXPECT_FALSE(isValid({{0, 0, 0}, std::ldexp(1, -130)}));
}

}  // namespace
}  // namespace eyrie::mesh
