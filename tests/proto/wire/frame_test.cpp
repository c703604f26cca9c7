// SPDX-License-Identifier: Apache-2.0
#include "wire/frame.h"

#include <limits>

#include <glm/common.hpp>
#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "eyrie/v1/frame.pb.h"

namespace eyrie::wire {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// From -1 to 1.
double anyNumber() { return *rc::gen::inRange(-1'000'000, 1'000'001) / 1e6; }

fabric::Sight anySight() {
    fabric::Sight sight;
    sight.eye = {anyNumber(), anyNumber(), anyNumber()};
    sight.viewFromCamera = fabric::Mat3(
        glm::rotate(glm::rotate(fabric::Mat4(1.0), 6 * anyNumber(), fabric::Vec3(1, 0, 0)),
                    6 * anyNumber(), fabric::Vec3(0, 0.6, 0.8)));
    sight.frustum.left = 9 * anyNumber();
    sight.frustum.right = sight.frustum.left + 1.1 + anyNumber();
    sight.frustum.bottom = 9 * anyNumber();
    sight.frustum.top = sight.frustum.bottom + 1.1 + anyNumber();
    return sight;
}

/// Of the whole view; what is drawn is the last row.
void addRaster(fabric::ChannelTask& task) {
    fabric::Raster raster;
    raster.width = *rc::gen::inRange(1, fabric::kMaxViewPixels + 1);
    raster.height = *rc::gen::inRange(1, fabric::kMaxViewPixels + 1);
    raster.step = {static_cast<double>(task.viewWidth) / raster.width,
                   static_cast<double>(task.viewHeight) / raster.height};
    raster.origin = fabric::Vec2(anyNumber(), anyNumber()) * 0.4 * raster.step;
    // A raster so fine has more pixels than any is allowed.
    raster.step = glm::max(raster.step, fabric::Vec2(fabric::kMinRasterStep));
    if (!fabric::validate(raster, task.viewWidth, task.viewHeight).ok())
        raster = {1, 1, {-0.5, -0.5}, {1, 1}};
    task.raster = raster;
    task.pixelViewport = {0, raster.height - 1, raster.width, 1};
}

fabric::ChannelTask anyTask() {
    fabric::ChannelTask task;
    task.frameNumber = *rc::gen::arbitrary<std::uint64_t>();
    task.frameDataVersion = *rc::gen::arbitrary<std::uint64_t>();
    task.viewWidth = *rc::gen::inRange(1, fabric::kMaxViewPixels + 1);
    task.viewHeight = *rc::gen::inRange(1, fabric::kMaxViewPixels + 1);
    const int x = *rc::gen::inRange(0, task.viewWidth);
    const int y = *rc::gen::inRange(0, task.viewHeight);
    task.pixelViewport = {x, y, *rc::gen::inRange(1, task.viewWidth - x + 1),
                          *rc::gen::inRange(1, task.viewHeight - y + 1)};
    const int begin = *rc::gen::inRange(0, 1001);
    task.range = {begin / 1000.0, *rc::gen::inRange(begin, 1001) / 1000.0};
    task.wantsDepth = *rc::gen::arbitrary<bool>();
    task.measuresStages = *rc::gen::arbitrary<bool>();
    task.completeness =
        *rc::gen::element(fabric::Completeness::Complete, fabric::Completeness::Interactive);
    if (*rc::gen::arbitrary<bool>())
        task.sight = anySight();
    if (*rc::gen::arbitrary<bool>())
        addRaster(task);
    return task;
}

RC_GTEST_PROP(WireChannelTask, ComesBackAsItWas, ()) {
    const fabric::ChannelTask task = anyTask();
    RC_ASSERT(*fromMessage(toMessage(task)) == task);
}

RC_GTEST_PROP(WireFrameData, ComesBackAsItWas, ()) {
    fabric::FrameData frameData;
    frameData.version = *rc::gen::inRange<std::uint64_t>(1, 1U << 30);
    frameData.tauPixels = *rc::gen::inRange(1, 100'001) / 100.0;
    frameData.shading = *rc::gen::element(fabric::Shading::Smooth, fabric::Shading::Gouraud,
                                          fabric::Shading::Flat, fabric::Shading::Wireframe);
    frameData.look.exaggeration = *rc::gen::inRange(-10, 11);
    frameData.occlusion =
        *rc::gen::element(fabric::Occlusion::Auto, fabric::Occlusion::On, fabric::Occlusion::Off);
    if (*rc::gen::arbitrary<bool>())
        frameData.budget = {*rc::gen::inRange(1, 10'001) * 1.0, *rc::gen::inRange(0, 1000) / 7.0,
                            *rc::gen::inRange(0, 1000) / 1e6, *rc::gen::inRange(0, 1000) / 9.0};
    RC_ASSERT(*fromMessage(toMessage(frameData)) == frameData);
}

template <typename Message>
std::string refusal(const Message& message) {
    return std::string(fromMessage(message).status().message());
}

v1::ChannelTask taskMessage() {
    fabric::ChannelTask task;
    task.viewWidth = 100;
    task.viewHeight = 50;
    task.pixelViewport = {0, 0, 100, 50};
    return toMessage(task);
}

TEST(WireChannelTask, ARefusalNamesTheField) {
    v1::ChannelTask large = taskMessage();
    large.set_view_width(fabric::kMaxViewPixels + 1);
    EXPECT_THAT(refusal(large), testing::HasSubstr("task.view_width"));
    v1::ChannelTask flat = taskMessage();
    flat.set_view_height(0);
    EXPECT_THAT(refusal(flat), testing::HasSubstr("task.view_height"));
    v1::ChannelTask outside = taskMessage();
    outside.mutable_pixel_viewport()->set_x(1);
    EXPECT_THAT(refusal(outside), testing::HasSubstr("task.pixel_viewport"));
    v1::ChannelTask empty = taskMessage();
    empty.mutable_pixel_viewport()->set_width(0);
    EXPECT_THAT(refusal(empty), testing::HasSubstr("task.pixel_viewport"));
    v1::ChannelTask sampled = taskMessage();
    sampled.mutable_raster()->set_width(50);
    sampled.mutable_raster()->set_height(50);
    sampled.mutable_raster()->set_step_x(2);
    sampled.mutable_raster()->set_step_y(1);
    EXPECT_THAT(refusal(sampled), testing::HasSubstr("task.pixel_viewport"));
    sampled.mutable_pixel_viewport()->set_width(50);
    EXPECT_TRUE(fromMessage(sampled).ok());
    sampled.mutable_raster()->set_step_y(0);
    EXPECT_THAT(refusal(sampled), testing::HasSubstr("raster.step.y"));
    v1::ChannelTask blind = taskMessage();
    blind.mutable_sight();
    EXPECT_THAT(refusal(blind), testing::HasSubstr("sight.frustum.right"));
    blind.mutable_sight()->add_view_from_camera(1);
    EXPECT_THAT(refusal(blind), testing::HasSubstr("sight.view_from_camera"));
    v1::ChannelTask unknown = taskMessage();
    unknown.set_completeness(static_cast<v1::Completeness>(7));
    EXPECT_THAT(refusal(unknown), testing::HasSubstr("task.completeness"));
}

TEST(WireChannelTask, WaitsForDataUnlessItSaysOtherwise) {
    v1::ChannelTask message = taskMessage();
    message.clear_completeness();
    EXPECT_EQ(fromMessage(message).value().completeness, fabric::Completeness::Complete);
}

TEST(WireChannelTask, AnAbsentRangeIsTheWhole) {
    v1::ChannelTask message = taskMessage();
    message.clear_range();
    EXPECT_EQ(fromMessage(message).value().range, fabric::Range{});
}

TEST(WirePixelViewport, NumbersThatWouldOverflowAreRefused) {
    v1::PixelViewport far;
    far.set_x(std::numeric_limits<std::int32_t>::max());
    far.set_width(1);
    EXPECT_THAT(refusal(far), testing::HasSubstr("pixel_viewport.x"));
    v1::PixelViewport wide;
    wide.set_width(std::numeric_limits<std::int32_t>::max());
    EXPECT_THAT(refusal(wide), testing::HasSubstr("pixel_viewport.width"));
    v1::PixelViewport negative;
    negative.set_height(-1);
    EXPECT_THAT(refusal(negative), testing::HasSubstr("pixel_viewport.height"));
}

TEST(WireRange, OnlySharesOfTheDataAreAccepted) {
    const std::vector<std::pair<double, double>> refused = {
        {0.5, 0.4}, {-0.1, 1}, {0, 1.1}, {kNan, 1}, {0, kNan}};
    for (const auto& [begin, end] : refused) {
        v1::Range message;
        message.set_begin(begin);
        message.set_end(end);
        EXPECT_THAT(refusal(message), testing::HasSubstr("range")) << begin << " to " << end;
    }
}

TEST(WireFrameData, ARefusalNamesTheField) {
    const fabric::FrameData good{1, {}, 1, fabric::Shading::Smooth};
    for (const double tau : {0.0, -1.0, 1001.0, kNan}) {
        v1::FrameData message = toMessage(good);
        message.set_tau_pixels(tau);
        EXPECT_THAT(refusal(message), testing::HasSubstr("frame_data.tau_pixels"));
    }
    v1::FrameData unversioned = toMessage(good);
    unversioned.clear_version();
    EXPECT_THAT(refusal(unversioned), testing::HasSubstr("frame_data.version"));
    v1::FrameData shaded = toMessage(good);
    shaded.set_shading(static_cast<v1::Shading>(99));
    EXPECT_THAT(refusal(shaded), testing::HasSubstr("frame_data.shading"));
    v1::FrameData occluded = toMessage(good);
    occluded.set_occlusion(static_cast<v1::Occlusion>(99));
    EXPECT_THAT(refusal(occluded), testing::HasSubstr("frame_data.occlusion"));
    for (const double budget : {0.0, -33.0, 1e9, kNan}) {
        v1::FrameData timed = toMessage(good);
        timed.mutable_budget()->set_milliseconds(budget);
        EXPECT_THAT(refusal(timed), testing::HasSubstr("frame_data: the frame time"));
    }
    v1::FrameData slow = toMessage(good);
    slow.mutable_budget()->set_milliseconds(33);
    slow.mutable_budget()->set_milliseconds_a_triangle(kNan);
    EXPECT_THAT(refusal(slow), testing::HasSubstr("budget.milliseconds_a_triangle"));
    v1::FrameData blind = toMessage(good);
    blind.clear_camera();
    EXPECT_THAT(refusal(blind), testing::HasSubstr("camera.eye"));
}

}  // namespace
}  // namespace eyrie::wire
