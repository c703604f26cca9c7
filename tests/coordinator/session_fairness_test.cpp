// SPDX-License-Identifier: Apache-2.0
// Several sessions on one farm: who gets how many of its frames, by counts.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coordinator/stream/sessions.h"
#include "eyrie/v1/viewer.pb.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/coordinator/viewer_browser.h"
#include "tests/service/eventually.h"

namespace eyrie::stream {
namespace {

using std::chrono::milliseconds;

/// Makes one frame at a time, in the order in which they were asked for.
class Farm {
public:
    explicit Farm(milliseconds takes) {
        frames_.setDraw([this, takes](const coordinator::FrameRequest& request) {
            std::unique_lock lock(mutex_);
            const int mine = asked_++;
            changed_.wait(lock, [&] { return made_ == mine; });
            lock.unlock();
            std::this_thread::sleep_for(takes);
            lock.lock();
            ++made_;
            changed_.notify_all();
            return coordinator::plainFrame(request, {90, 120, 60, 255});
        });
    }

    coordinator::FakeFrameSource& frames() { return frames_; }

private:
    std::mutex mutex_;  ///< guards the numbers
    std::condition_variable changed_;
    int asked_ = 0;
    int made_ = 0;
    coordinator::FakeFrameSource frames_;
};

/// Moves its session's view, if it leads, and acknowledges what comes, until `isOver`.
void use(Sessions& sessions, const Joining& joining, const std::atomic<bool>& isOver,
         std::atomic<int>& got) {
    Browser browser(sessions, joining);
    std::uint64_t view = 0;
    if (joining.role == Role::Lead)
        browser.look(++view);
    while (!isOver) {
        const auto frame = browser.nextFrame(milliseconds(200));
        if (!frame)
            continue;
        ++got;
        browser.acknowledge(frame->frame_number());
        if (joining.role == Role::Lead)
            browser.look(++view);
    }
}

TEST(Sessions, ShareAFarmFairly) {
    constexpr int kSessions = 4;
    constexpr int kFramesEach = 30;
    Farm farm(milliseconds(40));  // so that browsers on a busy machine answer in time
    Sessions sessions(farm.frames(), moving(2));
    std::atomic<bool> isOver = false;
    std::vector<std::atomic<int>> got(2 * kSessions);
    std::vector<std::thread> threads;
    for (int i = 0; i < kSessions; ++i)
        for (const Role role : {Role::Lead, Role::Watch}) {
            const Joining joining{fmt::format("session-{}", i), role};
            std::atomic<int>& mine = got[threads.size()];
            threads.emplace_back([&, joining] { use(sessions, joining, isOver, mine); });
        }
    const auto leastOfLeaders = [&] {
        int least = got[0];
        for (std::size_t i = 0; i < got.size(); i += 2) least = std::min<int>(least, got[i]);
        return least;
    };
    EXPECT_TRUE(eventually([&] { return leastOfLeaders() >= kFramesEach; }));
    std::vector<int> counts;
    for (std::size_t i = 0; i < got.size(); i += 2) counts.push_back(got[i]);
    isOver = true;
    for (std::thread& thread : threads) thread.join();
    const auto [least, most] = std::ranges::minmax(counts);
    EXPECT_GE(least, 0.8 * most) << fmt::format("{}", fmt::join(counts, ", "));
}

}  // namespace
}  // namespace eyrie::stream
