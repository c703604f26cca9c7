// SPDX-License-Identifier: Apache-2.0
#include "service/frame_data_history.h"

#include <gmock/gmock.h>

namespace eyrie::service {
namespace {

fabric::FrameData frameData(std::uint64_t version, double tau = 1) {
    return {version, {}, tau, fabric::Shading::Smooth};
}

TEST(FrameDataHistory, KeepsTheLastEightVersions) {
    FrameDataHistory history;
    for (std::uint64_t version = 1; version <= 9; ++version) history.store(frameData(version));
    EXPECT_EQ(history.find(1).status().code(), absl::StatusCode::kFailedPrecondition);
    for (std::uint64_t version = 2; version <= 9; ++version)
        EXPECT_EQ(history.find(version).value().version, version);
}

TEST(FrameDataHistory, ARefusalNamesTheVersionsThereAre) {
    FrameDataHistory history;
    history.store(frameData(4));
    history.store(frameData(7));
    EXPECT_THAT(std::string(history.find(5).status().message()),
                testing::AllOf(testing::HasSubstr("is 5"), testing::HasSubstr("[4, 7]")));
}

TEST(FrameDataHistory, AVersionSentAgainReplacesTheOneBefore) {
    FrameDataHistory history;
    for (int i = 0; i < 20; ++i) history.store(frameData(1, i));
    history.store(frameData(2));
    EXPECT_EQ(history.find(1).value().tauPixels, 19);
}

}  // namespace
}  // namespace eyrie::service
