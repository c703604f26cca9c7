// SPDX-License-Identifier: Apache-2.0
#include "fabric/flight.h"

#include <limits>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

namespace eyrie::fabric {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

FlightKey keyAt(double seconds, const Vec3& eye) {
    return {seconds, {eye, eye + Vec3(0, 10, -1), {0, 0, 1}, 45}};
}

std::string refusal(const Flight& flight) { return std::string(validate(flight).message()); }

TEST(Flight, PassesThroughItsKeysExactly) {
    const Flight flight{{keyAt(3, {0, 0, 5}), keyAt(4, {10, 0, 5}), keyAt(9, {10, 80, 6})}};
    ASSERT_TRUE(validate(flight).ok());
    for (const FlightKey& key : flight.keys) EXPECT_EQ(flight.at(key.seconds - 3), key.camera);
    EXPECT_EQ(flight.seconds(), 6);
}

TEST(Flight, StandsAtItsEndsBeforeAndAfter) {
    const Flight flight{{keyAt(0, {0, 0, 5}), keyAt(1, {10, 0, 5})}};
    EXPECT_EQ(flight.at(-1), flight.keys.front().camera);
    EXPECT_EQ(flight.at(7), flight.keys.back().camera);
}

TEST(Flight, OfOneKeyStandsStill) {
    const Flight flight{{keyAt(2, {1, 2, 3})}};
    ASSERT_TRUE(validate(flight).ok());
    EXPECT_EQ(flight.seconds(), 0);
    EXPECT_EQ(flight.at(0), flight.keys.front().camera);
}

RC_GTEST_PROP(FlightProperty, SteadyMotionStaysSteadyHoweverTheKeysAreSpaced, ()) {
    const auto gaps =
        *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(1, 1000)));
    const Vec3 velocity(3, -2, 0.5);
    Flight flight{{keyAt(0, {0, 0, 0})}};
    double seconds = 0;
    for (const int gap : gaps) {
        seconds += gap * 0.01;
        flight.keys.push_back(keyAt(seconds, velocity * seconds));
    }
    const double when = *rc::gen::inRange(0, 1001) * 0.001 * seconds;
    RC_ASSERT(glm::distance(flight.at(when).eye, velocity * when) <= 1e-9 * (1 + seconds));
}

RC_GTEST_PROP(FlightProperty, HasNoCornersAtItsKeys, ()) {
    const auto coordinate = rc::gen::inRange(-100, 101);
    Flight flight;
    for (int i = 0; i < 4; ++i)
        flight.keys.push_back(keyAt(i * i, {*coordinate, *coordinate, *coordinate}));
    const double key = flight.keys[2].seconds;
    constexpr double kStep = 1e-6;
    const auto velocity = [&](double at) {
        return (flight.at(at + kStep / 2).eye - flight.at(at - kStep / 2).eye) / kStep;
    };
    RC_ASSERT(glm::distance(velocity(key - kStep), velocity(key + kStep)) <= 0.05);
}

TEST(Flight, RefusalsNameTheKey) {
    EXPECT_THAT(refusal({}), testing::HasSubstr("no keys"));
    EXPECT_THAT(refusal({{keyAt(0, {}), keyAt(kNaN, {1, 0, 0})}}),
                testing::HasSubstr("keys[1].seconds is not a finite number"));
    EXPECT_THAT(refusal({{keyAt(0, {}), keyAt(2, {}), keyAt(1, {})}}),
                testing::HasSubstr("keys[2].seconds is 1, not after the 2"));
    EXPECT_THAT(
        refusal({{keyAt(-1.5e308, {}), keyAt(1.5e308, {})}}),
        testing::HasSubstr("keys[0].seconds is -1.5e+308; it must be from -1e+15 to 1e+15"));
    EXPECT_THAT(refusal({{keyAt(0, {}), keyAt(0, {})}}), testing::HasSubstr("keys[1].seconds"));
    EXPECT_THAT(refusal({{keyAt(0, {kNaN, 0, 0})}}), testing::HasSubstr("keys[0]: camera.eye"));
}

}  // namespace
}  // namespace eyrie::fabric
