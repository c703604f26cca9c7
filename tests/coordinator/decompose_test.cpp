// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/decompose.h"

#include <algorithm>
#include <cstdint>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::coordinator {
namespace {

fabric::ChannelTask wholeView(int width, int height, bool wantsDepth = false) {
    return {7, 3, width, height, {0, 0, width, height}, {}, wantsDepth};
}

std::vector<double> anyCuts() {
    std::vector<double> cuts;
    const int count = *rc::gen::inRange(0, 12);
    for (int i = 0; i < count; ++i) cuts.push_back(*rc::gen::inRange(1, 1000) / 1000.0);
    std::sort(cuts.begin(), cuts.end());
    return cuts;
}

RC_GTEST_PROP(Decompose, TwoDCoversEveryPixelOnceWithTheWholeRange, ()) {
    const auto whole = wholeView(*rc::gen::inRange(1, 300), *rc::gen::inRange(1, 300));
    std::int64_t pixels = 0;
    const auto tasks = decompose(whole, Decomposition::TwoD, anyCuts());
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        pixels += tasks[i].pixelViewport.area();
        RC_ASSERT(whole.pixelViewport.contains(tasks[i].pixelViewport));
        RC_ASSERT(tasks[i].range.isWhole());
        for (std::size_t j = 0; j < i; ++j)
            RC_ASSERT(
                fabric::intersection(tasks[i].pixelViewport, tasks[j].pixelViewport).isEmpty());
    }
    RC_ASSERT(pixels == whole.pixelViewport.area());
}

RC_GTEST_PROP(Decompose, DbCoversTheRangeInAscendingOrderWithTheWholePicture, ()) {
    const auto whole = wholeView(64, 48);
    auto cuts = anyCuts();
    cuts.push_back(1 - 1e-9);
    const auto tasks = decompose(whole, Decomposition::Db, cuts);
    RC_ASSERT(tasks.size() == cuts.size() + 1);
    double end = 0;
    for (const fabric::ChannelTask& task : tasks) {
        RC_ASSERT(task.range.begin == end);
        RC_ASSERT(task.pixelViewport == whole.pixelViewport);
        RC_ASSERT(task.wantsDepth);
        end = task.range.end;
    }
    RC_ASSERT(end == 1.0);
}

TEST(Decompose, OneRendererGetsTheWholeAndNoDepthUnlessWanted) {
    for (const Decomposition decomposition : {Decomposition::TwoD, Decomposition::Db})
        for (const bool wantsDepth : {false, true}) {
            const auto whole = wholeView(64, 48, wantsDepth);
            EXPECT_EQ(decompose(whole, decomposition, {}), std::vector{whole});
        }
}

TEST(Decompose, EveryTaskNamesTheViewAndFrameItBelongsTo) {
    for (const Decomposition decomposition : {Decomposition::TwoD, Decomposition::Db})
        for (const fabric::ChannelTask& task :
             decompose(wholeView(64, 48), decomposition, fabric::equalCuts(3))) {
            EXPECT_EQ(task.viewWidth, 64);
            EXPECT_EQ(task.viewHeight, 48);
            EXPECT_EQ(task.frameNumber, 7U);
            EXPECT_EQ(task.frameDataVersion, 3U);
        }
}

}  // namespace
}  // namespace eyrie::coordinator
