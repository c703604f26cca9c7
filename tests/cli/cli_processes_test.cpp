// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

#include "cli/restart_policy.h"
#include "cli/stop_signal.h"
#include "cli/temporary_folder.h"

namespace eyrie::cli {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Clock = RestartPolicy::Clock;

TEST(RestartPolicy, StartsAgainAtOnceAfterTheFirstEnd) {
    RestartPolicy policy;
    const Clock::time_point now{};
    EXPECT_EQ(policy.ended(now, now), now + milliseconds(250));
}

TEST(RestartPolicy, WaitsTwiceAsLongAfterEachFurtherEnd) {
    RestartPolicy policy;
    Clock::time_point now{};
    milliseconds pause{250};
    for (int i = 0; i < 4; ++i) {
        const Clock::time_point next = policy.ended(now, now);
        EXPECT_EQ(next - now, pause);
        now = next;
        pause *= 2;
    }
}

TEST(RestartPolicy, NeverStartsMoreThanSixTimesWithinAMinute) {
    RestartPolicy policy;
    Clock::time_point now{};
    std::vector<Clock::time_point> starts;
    for (int i = 0; i < 50; ++i) {
        const Clock::time_point end = now + (i % 3 == 0 ? RestartPolicy::kWorked : seconds(0));
        starts.push_back(now = policy.ended(now, end));
    }
    for (std::size_t i = RestartPolicy::kMaxPerMinute; i < starts.size(); ++i)
        EXPECT_GE(starts[i] - starts[i - RestartPolicy::kMaxPerMinute], seconds(60)) << i;
}

TEST(RestartPolicy, ForgetsEndsOfLongAgo) {
    RestartPolicy policy;
    const Clock::time_point start{};
    for (int i = 0; i < 3; ++i) policy.ended(start + seconds(i), start + seconds(i));
    const Clock::time_point later = start + seconds(120);
    EXPECT_EQ(policy.ended(later, later) - later, milliseconds(250));
}

TEST(RestartPolicy, StartsAgainAtOnceWhatHasWorkedForTenSeconds) {
    RestartPolicy policy;
    Clock::time_point now{};
    for (int i = 0; i < 3; ++i) now = policy.ended(now, now);
    const Clock::time_point end = now + seconds(10);
    EXPECT_EQ(policy.ended(now, end) - end, milliseconds(250));
    EXPECT_EQ(policy.ended(end, end) - end, milliseconds(500));
}

TEST(TemporaryFolder, IsPrivateAndGoesWithItsContents) {
    std::filesystem::path path;
    {
        const auto folder = TemporaryFolder::create();
        ASSERT_TRUE(folder.ok()) << folder.status();
        path = folder->path();
        EXPECT_EQ(std::filesystem::status(path).permissions(), std::filesystem::perms::owner_all);
        std::ofstream(path / "file") << "x";
        EXPECT_EQ(folder->socket("a"), "unix:" + (path / "a").string());
    }
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(TemporaryFolder, LeavesRoomForTheNameOfASocket) {
    const auto longFolder = TemporaryFolder::create();
    ASSERT_TRUE(longFolder.ok());
    const auto parent = longFolder->path() / std::string(80, 'x');
    std::filesystem::create_directory(parent);
    const char* before = std::getenv("TMPDIR");
    const std::optional<std::string> saved =
        before == nullptr ? std::nullopt : std::optional<std::string>(before);
    setenv("TMPDIR", parent.c_str(), 1);
    const auto folder = TemporaryFolder::create();
    if (saved)
        setenv("TMPDIR", saved->c_str(), 1);
    else
        unsetenv("TMPDIR");
    ASSERT_TRUE(folder.ok()) << folder.status();
    EXPECT_LE(folder->socket("renderer-63-1000").size(), 100U);
}

TEST(StopSignal, TurnsAnInterruptIntoARequest) {
    const StopSignal stop;
    EXPECT_FALSE(stop.token().stop_requested());
    kill(getpid(), SIGINT);
    stop.wait();
    EXPECT_TRUE(stop.token().stop_requested());
}

TEST(StopSignal, TurnsTheEndOfItsTerminalIntoARequest) {
    std::signal(SIGHUP, SIG_DFL);  // these tests, too, may run under nohup
    const StopSignal stop;
    kill(getpid(), SIGHUP);
    stop.wait();
    EXPECT_TRUE(stop.token().stop_requested());
}

/// As nohup has it.
TEST(StopSignalDeathTest, OutlivesItsTerminalWhereItIsToldTo) {
    EXPECT_EXIT(
        {
            std::signal(SIGHUP, SIG_IGN);
            const StopSignal stop;
            kill(getpid(), SIGHUP);
            std::this_thread::sleep_for(milliseconds(200));
            std::exit(stop.token().stop_requested() ? 1 : 0);
        },
        testing::ExitedWithCode(0), "");
}

TEST(StopSignalDeathTest, TakesEchoesOfASignalForOne) {
    EXPECT_EXIT(
        {
            const StopSignal stop;
            kill(getpid(), SIGTERM);
            stop.wait();
            kill(getpid(), SIGTERM);
            std::this_thread::sleep_for(milliseconds(200));
            std::exit(0);
        },
        testing::ExitedWithCode(0), "");
}

TEST(StopSignalDeathTest, EndsTheProcessOnASignalLongAfterTheFirst) {
    EXPECT_EXIT(
        {
            const StopSignal stop;
            kill(getpid(), SIGTERM);
            stop.wait();
            kill(getpid(), SIGTERM);  // an echo
            std::this_thread::sleep_for(milliseconds(1200));
            kill(getpid(), SIGTERM);
            std::this_thread::sleep_for(seconds(20));
        },
        testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace eyrie::cli
