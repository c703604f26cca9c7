// SPDX-License-Identifier: Apache-2.0
#include "wire/pick.h"

#include <limits>
#include <string>

#include <gmock/gmock.h>

#include "eyrie/v1/camera.pb.h"
#include "eyrie/v1/pick.pb.h"

namespace eyrie::wire {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

fabric::PickedPoint point() {
    return {3, {1, 2, 3}, {0, 0, 1}, 17, 0.5, 16, 19, 0.02, 412.5, 0.25};
}

TEST(WirePick, RequestsComeBackAsTheyWere) {
    const fabric::PickRequest request{{{1, 2, 3}, {4, 5, 6}}, 640, 480, {0.5, 480}, 2.5, {{0, 4}}};
    EXPECT_EQ(fromMessage(toMessage(request)).value(), request);
    v1::PickRequest plain = toMessage(request);
    plain.clear_exaggeration();
    EXPECT_EQ(fromMessage(plain)->exaggeration, 1);
}

TEST(WirePick, RequestsOutsideThePictureAreRefused) {
    const fabric::PickRequest inside{{{1, 2, 3}, {4, 5, 6}}, 640, 480, {5, 5}, 1};
    v1::PickRequest message = toMessage(inside);
    for (const double x : {-0.5, 640.5, kNan}) {
        message.set_x(x);
        EXPECT_TRUE(absl::IsInvalidArgument(fromMessage(message).status())) << x;
    }
    message = toMessage(inside);
    message.mutable_camera()->set_eye(0, kNan);
    EXPECT_TRUE(absl::IsInvalidArgument(fromMessage(message).status()));
    message = toMessage(inside);
    message.set_view_height(0);
    EXPECT_TRUE(absl::IsInvalidArgument(fromMessage(message).status()));
    message = toMessage(inside);
    message.set_exaggeration(kNan);
    EXPECT_TRUE(absl::IsInvalidArgument(fromMessage(message).status()));
    message = toMessage(inside);
    message.add_hidden_objects(-1);
    EXPECT_TRUE(absl::IsInvalidArgument(fromMessage(message).status()));
}

TEST(WirePick, PointsComeBackAsTheyWere) {
    EXPECT_EQ(fromMessage(toMessage(point())).value(), point());
    fabric::PickedPoint bare = point();
    bare.elevationMetres.reset();
    bare.elevationErrorMetres = 0;
    bare.farthestMetres = std::numeric_limits<double>::infinity();
    EXPECT_EQ(fromMessage(toMessage(bare)).value(), bare);
}

TEST(WirePick, PointsThatCannotBeAreRefused) {
    const auto isRefused = [](auto change) {
        v1::PickedPoint message = toMessage(point());
        change(message);
        return absl::IsInvalidArgument(fromMessage(message).status());
    };
    EXPECT_TRUE(isRefused([](auto& m) { m.set_object(-1); }));
    EXPECT_TRUE(isRefused([](auto& m) { m.mutable_position()->set_y(kNan); }));
    EXPECT_TRUE(isRefused([](auto& m) { m.set_error(-0.1); }));
    EXPECT_TRUE(isRefused([](auto& m) { m.set_nearest(18); }));
    EXPECT_TRUE(isRefused([](auto& m) { m.set_farthest(kNan); }));
    EXPECT_TRUE(isRefused([](auto& m) { m.set_elevation(kNan); }));
    EXPECT_TRUE(isRefused([](auto& m) { m.set_elevation_error(-1); }));
}

}  // namespace
}  // namespace eyrie::wire
