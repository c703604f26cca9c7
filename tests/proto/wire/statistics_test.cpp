// SPDX-License-Identifier: Apache-2.0
#include "wire/statistics.h"

#include <limits>
#include <string>

#include <gmock/gmock.h>

#include "eyrie/v1/statistics.pb.h"

namespace eyrie::wire {
namespace {

fabric::FrameStatistics sample() {
    return {1,  2.5,  false, true, 10, 20,   30,   8,
            40, 4000, 6,     5,    7,  31.5, 2.25, {0.1, 0.2, 0.3, 0.4, 1.5, 0.15, 0.05}};
}

TEST(WireStatistics, ComeBackAsTheyWere) {
    EXPECT_EQ(fromMessage(toMessage(sample())).value(), sample());
}

TEST(WireStatistics, TellWhatBecameOfABudget) {
    fabric::FrameStatistics statistics = sample();
    statistics.budget = fabric::BudgetUse{33, 30.5, 4, 200'000, 0.25};
    EXPECT_EQ(fromMessage(toMessage(statistics)).value(), statistics);
    v1::FrameStatistics message = toMessage(statistics);
    message.mutable_budget()->set_tau_pixels(std::numeric_limits<double>::infinity());
    EXPECT_THAT(std::string(fromMessage(message).status().message()),
                testing::HasSubstr("statistics.budget.tau_pixels"));
    message = toMessage(statistics);
    message.mutable_budget()->set_covered(1.5);
    EXPECT_THAT(std::string(fromMessage(message).status().message()),
                testing::HasSubstr("statistics.budget.covered"));
}

TEST(WireStatistics, TheErrorAchievedMayBeInfinite) {
    fabric::FrameStatistics boundless = sample();
    boundless.tauAchievedPixels = std::numeric_limits<double>::infinity();
    EXPECT_EQ(fromMessage(toMessage(boundless)).value(), boundless);
}

TEST(WireStatistics, ARefusalNamesTheField) {
    v1::FrameStatistics message = toMessage(sample());
    message.set_tau_achieved(std::numeric_limits<double>::quiet_NaN());
    EXPECT_THAT(std::string(fromMessage(message).status().message()),
                testing::HasSubstr("statistics.tau_achieved"));
    message = toMessage(sample());
    message.set_pages_failed(7);
    EXPECT_THAT(std::string(fromMessage(message).status().message()),
                testing::HasSubstr("statistics.pages_failed"));
    message = toMessage(sample());
    message.set_normal_error_degrees(181);
    EXPECT_THAT(std::string(fromMessage(message).status().message()),
                testing::HasSubstr("statistics.normal_error_degrees is 181"));
    message = toMessage(sample());
    message.set_normal_error_mean_degrees(32);
    EXPECT_THAT(std::string(fromMessage(message).status().message()),
                testing::HasSubstr("statistics.normal_error_mean_degrees is 32"));
    message = toMessage(sample());
    message.mutable_milliseconds()->set_draw(-1);
    EXPECT_THAT(std::string(fromMessage(message).status().message()),
                testing::HasSubstr("statistics.milliseconds.draw"));
}

TEST(LimitingStage, IsTheLongestOfThoseThatWereMeasured) {
    fabric::StageMilliseconds ms{.cull = 3, .draw = 9, .readback = 2, .total = 14};
    EXPECT_EQ(fabric::limitingStage(ms), "");
    ms.vertices = 4;
    ms.fill = 5;
    EXPECT_EQ(fabric::limitingStage(ms), "fill");
    ms.cull = 6;
    EXPECT_EQ(fabric::limitingStage(ms), "cull");
    ms.readback = 7;
    EXPECT_EQ(fabric::limitingStage(ms), "readback");
    ms.vertices = 8;
    EXPECT_EQ(fabric::limitingStage(ms), "vertices");
}

TEST(WireDeviceInfo, ComesBackAsItWas) {
    const fabric::DeviceInfo device{"Mesa", "llvmpipe", "4.5 (Core Profile)", "EGL device 0", true};
    EXPECT_EQ(fromMessage(toMessage(device)).value(), device);
}

TEST(WireDeviceInfo, TextWithoutEndIsRefused) {
    v1::DeviceInfo message;
    message.set_driver(std::string(2000, 'x'));
    EXPECT_THAT(std::string(fromMessage(message).status().message()),
                testing::HasSubstr("device.driver"));
}

}  // namespace
}  // namespace eyrie::wire
