// SPDX-License-Identifier: Apache-2.0
#include "fabric/camera.h"

#include <cmath>
#include <limits>
#include <string>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

namespace eyrie::fabric {
namespace {

std::string refusal(const Camera& camera) { return std::string(validate(camera).message()); }

TEST(Camera, TheDefaultSpansAPicture) { EXPECT_TRUE(validate(Camera{}).ok()); }

TEST(Camera, ARefusalNamesTheField) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    EXPECT_THAT(refusal({{nan, 0, 0}, {0, 1, 0}, {0, 0, 1}, 45}), testing::HasSubstr("camera.eye"));
    EXPECT_THAT(refusal({{0, 0, 0}, {0, infinity, 0}, {0, 0, 1}, 45}),
                testing::HasSubstr("camera.target"));
    EXPECT_THAT(refusal({{0, 0, 0}, {0, 0, 0}, {0, 0, 1}, 45}),
                testing::HasSubstr("camera.target"));
    EXPECT_THAT(refusal({{0, 0, 0}, {0, 1, 0}, {0, 0, 0}, 45}), testing::HasSubstr("camera.up"));
    EXPECT_THAT(refusal({{0, 0, 0}, {0, 0, -3}, {0, 0, 1}, 45}), testing::HasSubstr("camera.up"));
    EXPECT_THAT(refusal({{1e300, 0, 0}, {0, 1, 0}, {0, 0, 1}, 45}),
                testing::HasSubstr("camera.eye"));
    EXPECT_THAT(refusal({{0, 0, 0}, {0, 1, 0}, {0, 0, 1e300}, 45}),
                testing::HasSubstr("camera.up"));
    for (const double fovY : {0.0, -45.0, 171.0, nan})
        EXPECT_THAT(refusal({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, fovY}),
                    testing::HasSubstr("camera.fovyDegrees"));
}

TEST(Camera, ATargetOrUpTooShortForADirectionIsNotCalledZero) {
    for (const double tiny : {1e-320, 1e-200, 1e-160}) {
        EXPECT_THAT(refusal({{0, 0, 0}, {0, tiny, 0}, {0, 0, 1}, 45}),
                    testing::HasSubstr("camera.target is equal to camera.eye, or too near"));
        EXPECT_THAT(refusal({{0, 0, 0}, {0, 1, 0}, {0, 0, tiny}, 45}),
                    testing::HasSubstr("camera.up is zero, or too short"));
    }
    for (const double enough : {1e-150, 1e-9})
        EXPECT_EQ(refusal({{0, 0, 0}, {0, enough, 0}, {0, 0, enough}, 45}), "");
    const double far = kMaxCoordinateMetres;
    EXPECT_EQ(refusal({{far, 0, 0}, {std::nextafter(far, 0), 0, 0}, {0, 0, 1}, 45}), "");
    EXPECT_THAT(refusal({{far, 0, 0}, {far - 1e-3, 0, 0}, {0, 0, 1}, 45}),
                testing::HasSubstr("or too near"));
}

TEST(ViewFromWorld, LooksDownMinusZWithYUp) {
    const Mat3 rotation = viewFromWorldRotation({{0, 0, 0}, {0, 5, 0}, {0, 0, 1}, 45});
    EXPECT_EQ(rotation * Vec3(1, 0, 0), Vec3(1, 0, 0));
    EXPECT_EQ(rotation * Vec3(0, 1, 0), Vec3(0, 0, -1));
    EXPECT_EQ(rotation * Vec3(0, 0, 1), Vec3(0, 1, 0));
}

RC_GTEST_PROP(ViewFromWorld, IsARotationThatPutsTheTargetOnTheAxis, ()) {
    const auto number = [] { return *rc::gen::inRange(-1000, 1000) * 0.37; };
    const Camera camera{{number(), number(), number()},
                        {number(), number(), number()},
                        {number(), number(), number()},
                        45};
    RC_PRE(validate(camera).ok());
    const Mat3 rotation = viewFromWorldRotation(camera);
    RC_ASSERT(std::abs(glm::determinant(rotation) - 1) < 1e-9);
    const Vec3 target = rotation * (camera.target - camera.eye);
    const double distance = glm::length(camera.target - camera.eye);
    RC_ASSERT(glm::length(target - Vec3(0, 0, -distance)) < 1e-9 * distance);
    RC_ASSERT((rotation * camera.up).y > 0);
}

}  // namespace
}  // namespace eyrie::fabric
