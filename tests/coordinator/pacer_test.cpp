// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/pacer.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <utility>

#include <gtest/gtest.h>

namespace eyrie::stream {
namespace {

using std::chrono::milliseconds;

/// A link and a browser: frames are started as the pacer allows and each stage takes its time.
int windowAfter(milliseconds render, milliseconds transmit, milliseconds roundTrip) {
    Pacer pacer;
    Clock::time_point renderFree{};
    Clock::time_point linkFree{};
    std::deque<std::pair<std::uint64_t, Clock::time_point>> acks;
    Clock::time_point now{};
    for (std::uint64_t frame = 1; frame <= 200; ++frame) {
        while (static_cast<int>(acks.size()) >= pacer.window()) {
            now = std::max(now, acks.front().second);
            pacer.acknowledged(acks.front().first, acks.front().second);
            acks.pop_front();
        }
        const Clock::time_point started = std::max(now, renderFree);
        renderFree = started + render;
        now = renderFree;
        pacer.rendered(render);
        pacer.sent(frame, started, true);
        linkFree = std::max(linkFree, renderFree) + transmit;
        acks.emplace_back(frame, linkFree + roundTrip);
    }
    return pacer.window();
}

TEST(Pacer, LetsInAsManyFramesAsKeepTheSlowestStageBusy) {
    EXPECT_EQ(windowAfter(milliseconds(25), milliseconds(1), milliseconds(8)), 2);    // loopback
    EXPECT_EQ(windowAfter(milliseconds(30), milliseconds(20), milliseconds(50)), 4);  // 20 Mbit/s
    EXPECT_EQ(windowAfter(milliseconds(30), milliseconds(80), milliseconds(50)), 2);  // 5 Mbit/s
    EXPECT_EQ(windowAfter(milliseconds(5), milliseconds(1), milliseconds(300)), 4);   // the limit
}

}  // namespace
}  // namespace eyrie::stream
