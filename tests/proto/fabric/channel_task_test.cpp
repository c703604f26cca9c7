// SPDX-License-Identifier: Apache-2.0
#include "fabric/channel_task.h"

#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace eyrie::fabric {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <typename Change>
std::string refusalOfSight(Change change) {
    Sight sight;
    change(sight);
    return std::string(validate(sight).message());
}

TEST(SightCheck, NamesWhatSpansNoPicture) {
    using testing::HasSubstr;
    const auto refused = [](auto change) { return refusalOfSight(change); };
    EXPECT_EQ(refused([](Sight&) {}), "");
    EXPECT_THAT(refused([](Sight& s) { s.eye.y = kNan; }), HasSubstr("sight.eye"));
    EXPECT_THAT(refused([](Sight& s) { s.eye.x = 1e16; }), HasSubstr("sight.eye"));
    EXPECT_THAT(refused([](Sight& s) { s.viewFromCamera[1][1] = 1.001; }),
                HasSubstr("sight.viewFromCamera"));
    EXPECT_THAT(refused([](Sight& s) { s.viewFromCamera[1][1] = -1; }),
                HasSubstr("sight.viewFromCamera"))
        << "a mirror";
    EXPECT_THAT(refused([](Sight& s) { s.viewFromCamera[2][0] = kNan; }),
                HasSubstr("sight.viewFromCamera"));
    EXPECT_THAT(refused([](Sight& s) { s.frustum.left = kNan; }), HasSubstr("sight.frustum.left"));
    EXPECT_THAT(refused([](Sight& s) { s.frustum.top = 1e5; }), HasSubstr("sight.frustum.top"));
    EXPECT_THAT(refused([](Sight& s) { s.frustum.right = s.frustum.left; }),
                HasSubstr("sight.frustum.right"));
    EXPECT_THAT(refused([](Sight& s) { s.frustum.top = -2; }), HasSubstr("sight.frustum.top"));
}

template <typename Change>
std::string refusalOfRaster(Change change) {
    Raster raster{100, 50, {0, 0}, {1, 1}};
    change(raster);
    return std::string(validate(raster, 100, 50).message());
}

TEST(RasterCheck, NamesWhatSamplesNoView) {
    using testing::HasSubstr;
    const auto refused = [](auto change) { return refusalOfRaster(change); };
    EXPECT_EQ(refused([](Raster&) {}), "");
    EXPECT_EQ(refused([](Raster& r) { r = {50, 50, {-0.5, 0}, {2, 1}}; }), "") << "every second";
    EXPECT_EQ(refused([](Raster& r) { r.origin = {0.5, -0.5}; }), "") << "the edges themselves";
    EXPECT_THAT(refused([](Raster& r) { r.width = 0; }), HasSubstr("raster.width"));
    EXPECT_THAT(refused([](Raster& r) { r.height = kMaxViewPixels + 1; }),
                HasSubstr("raster.height"));
    for (const double step : {0.0, -1.0, 1e-4, kNan, std::numeric_limits<double>::infinity()})
        EXPECT_THAT(refused([&](Raster& r) { r.step.x = step; }), HasSubstr("raster.step.x"));
    EXPECT_THAT(refused([](Raster& r) { r.origin.x = kNan; }), HasSubstr("raster.origin.x"));
    EXPECT_THAT(refused([](Raster& r) { r.origin.y = 0.6; }), HasSubstr("raster.origin.y"));
    EXPECT_THAT(refused([](Raster& r) { r.origin.y = -0.6; }), HasSubstr("raster.origin.y"));
    EXPECT_THAT(refused([](Raster& r) { r.step.x = 1.1; }), HasSubstr("raster.origin.x"));
}

}  // namespace
}  // namespace eyrie::fabric
