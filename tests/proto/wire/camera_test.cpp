// SPDX-License-Identifier: Apache-2.0
#include "wire/camera.h"

#include <limits>

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "eyrie/v1/camera.pb.h"

namespace eyrie::wire {
namespace {

RC_GTEST_PROP(WireCamera, ComesBackAsItWas, ()) {
    const auto number = [] { return *rc::gen::inRange(-1'000'000, 1'000'000) * 0.123; };
    const fabric::Camera camera{{number(), number(), number()},
                                {number(), number(), number()},
                                {number(), number(), number()},
                                *rc::gen::inRange(1, 171) * 1.0};
    RC_PRE(fabric::validate(camera).ok());
    RC_ASSERT(*fromMessage(toMessage(camera)) == camera);
}

v1::Camera cameraMessage() { return toMessage(fabric::Camera{}); }

TEST(WireCamera, AbsentUpAndFieldOfViewTakeTheirDefaults) {
    v1::Camera message = cameraMessage();
    message.clear_up();
    message.clear_fovy_degrees();
    EXPECT_EQ(fromMessage(message).value(), fabric::Camera{});
}

TEST(WireCamera, ARefusalNamesTheField) {
    v1::Camera none;
    EXPECT_THAT(std::string(fromMessage(none).status().message()),
                testing::HasSubstr("camera.eye has 0 numbers; it must have 3"));
    v1::Camera four = cameraMessage();
    four.add_target(1);
    EXPECT_THAT(std::string(fromMessage(four).status().message()),
                testing::HasSubstr("camera.target has 4 numbers"));
    v1::Camera nan = cameraMessage();
    nan.set_eye(1, std::numeric_limits<double>::quiet_NaN());
    EXPECT_THAT(std::string(fromMessage(nan).status().message()),
                testing::HasSubstr("camera.eye[1]"));
    v1::Camera wide = cameraMessage();
    wide.set_fovy_degrees(180);
    EXPECT_THAT(std::string(fromMessage(wide).status().message()),
                testing::HasSubstr("camera.fovyDegrees"));
}

}  // namespace
}  // namespace eyrie::wire
