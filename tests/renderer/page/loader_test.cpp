// SPDX-License-Identifier: Apache-2.0
#include "renderer/page/loader.h"

#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

namespace eyrie::page {
namespace {

using std::chrono::milliseconds;

constexpr std::uint64_t kPageBytes = 10;

/// A source whose pages are their own numbers; can be held back, and can fail.
class FakePages {
public:
    absl::StatusOr<Loaded> load(std::uint32_t page) {
        std::unique_lock lock(mutex_);
        begun_.push_back(page);
        changed_.notify_all();
        changed_.wait(lock, [&] { return !isHeld_; });
        if (const auto failing = failing_.find(page); failing != failing_.end())
            return failing->second;
        return Loaded{std::make_shared<std::uint32_t>(page), kPageBytes};
    }
    Loader::Load function() {
        return [this](std::uint32_t page) { return load(page); };
    }

    void hold(bool isHeld) {
        const std::lock_guard lock(mutex_);
        isHeld_ = isHeld;
        changed_.notify_all();
    }
    void fail(std::uint32_t page, absl::Status status) {
        const std::lock_guard lock(mutex_);
        failing_[page] = std::move(status);
    }
    void repair(std::uint32_t page) {
        const std::lock_guard lock(mutex_);
        failing_.erase(page);
    }
    void awaitBegun(std::size_t count) {
        std::unique_lock lock(mutex_);
        EXPECT_TRUE(changed_.wait_for(lock, std::chrono::seconds(10),
                                      [&] { return begun_.size() >= count; }));
    }
    std::vector<std::uint32_t> begun() const {
        const std::lock_guard lock(mutex_);
        return begun_;
    }

private:
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    bool isHeld_ = false;
    std::map<std::uint32_t, absl::Status> failing_;
    std::vector<std::uint32_t> begun_;
};

std::vector<Wish> wishes(const std::vector<std::uint32_t>& pages) {
    std::vector<Wish> result;
    for (const std::uint32_t page : pages)
        result.push_back({page, -static_cast<double>(result.size()), kPageBytes});
    return result;
}

/// Everything that comes until nothing more is under way.
std::vector<Arrival> takeAll(Loader::Source& source) {
    std::vector<Arrival> all;
    while (source.wait())
        for (Arrival& arrival : source.take()) all.push_back(std::move(arrival));
    return all;
}

TEST(Loader, LoadsTheMostWantedFirst) {
    FakePages pages;
    pages.hold(true);
    Loader loader({.threads = 1});
    const auto source = loader.open(pages.function(), 1000);
    source->wish(wishes({9}));
    pages.awaitBegun(1);
    source->wish({{1, 0.5, kPageBytes}, {2, 0.9, kPageBytes}, {3, 0.1, kPageBytes}});
    pages.hold(false);
    EXPECT_EQ(takeAll(*source).size(), 4U);
    EXPECT_EQ(pages.begun(), (std::vector<std::uint32_t>{9, 2, 1, 3}));
}

TEST(Loader, ForgetsWishesThatAreNotRenewed) {
    FakePages pages;
    pages.hold(true);
    Loader loader({.threads = 1});
    const auto source = loader.open(pages.function(), 1000);
    source->wish(wishes({1, 2, 3}));
    pages.awaitBegun(1);
    source->wish(wishes({4}));
    pages.hold(false);
    EXPECT_EQ(takeAll(*source).size(), 2U);
    EXPECT_EQ(pages.begun(), (std::vector<std::uint32_t>{1, 4}));
}

TEST(Loader, LoadsAPageOnceHoweverOftenItIsWishedForMeanwhile) {
    FakePages pages;
    pages.hold(true);
    Loader loader({.threads = 2});
    const auto source = loader.open(pages.function(), 1000);
    source->wish(wishes({1}));
    pages.awaitBegun(1);
    for (int i = 0; i < 10; ++i) source->wish(wishes({1}));
    pages.hold(false);
    EXPECT_EQ(takeAll(*source).size(), 1U);
    EXPECT_EQ(pages.begun().size(), 1U);
}

TEST(Loader, CanBeUsedWithoutWaiting) {
    FakePages pages;
    Loader loader({.threads = 2});
    const auto source = loader.open(pages.function(), 1000);
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    std::size_t taken = 0;
    while (taken < 100 && std::chrono::steady_clock::now() < end) {
        source->tryWish(wishes({static_cast<std::uint32_t>(taken)}));
        taken += source->tryTake().size();
    }
    EXPECT_EQ(taken, 100U);
}

TEST(Loader, TakesTheMostWantedOfAllSources) {
    FakePages one;
    FakePages other;
    one.hold(true);
    Loader loader({.threads = 1});
    const auto first = loader.open(one.function(), 1000);
    const auto second = loader.open(other.function(), 1000);
    first->wish({{7, 0, kPageBytes}});
    one.awaitBegun(1);
    first->wish({{1, 1, kPageBytes}});
    second->wish({{2, 5, kPageBytes}});
    one.hold(false);
    ASSERT_TRUE(second->wait());
    EXPECT_EQ(second->take().front().page, 2U);
    EXPECT_EQ(takeAll(*first).back().page, 1U);
}

TEST(Loader, HoldsNoMoreThanItsLimit) {
    FakePages pages;
    Loader loader({.threads = 2});
    const auto source = loader.open(pages.function(), 3 * kPageBytes);
    source->wish(wishes({1, 2, 3, 4, 5, 6, 7}));
    pages.awaitBegun(3);
    std::size_t taken = 0;
    while (source->wait()) {
        EXPECT_LE(source->bytes(), 3 * kPageBytes);
        EXPECT_LE(pages.begun().size(), taken + 3);
        taken += source->take().size();
    }
    EXPECT_EQ(taken, 7U);
    EXPECT_EQ(source->bytes(), 0U);
}

TEST(Loader, RefusesAPageGreaterThanItSaid) {
    Loader loader({.threads = 1});
    const auto source = loader.open(
        [](std::uint32_t) -> absl::StatusOr<Loaded> {
            return Loaded{std::make_shared<int>(1), 11};
        },
        1000);
    source->wish(wishes({1}));
    ASSERT_TRUE(source->wait());
    EXPECT_TRUE(absl::IsResourceExhausted(source->take().front().result.status()));
    EXPECT_EQ(source->bytes(), 0U);
}

TEST(Loader, LeavesOutAPageThatDoesNotFitItsLimit) {
    FakePages pages;
    Loader loader({.threads = 1});
    const auto source = loader.open(pages.function(), kPageBytes - 1);
    source->wish(wishes({1}));
    EXPECT_FALSE(source->wait());
    EXPECT_TRUE(pages.begun().empty());
}

TEST(Loader, ReportsFailuresAndLoadsTheRest) {
    FakePages pages;
    pages.fail(2, absl::DataLossError("page 2: its checksum is wrong"));
    Loader loader;
    const auto source = loader.open(pages.function(), 1000);
    source->wish(wishes({1, 2, 3}));
    int failed = 0;
    for (const Arrival& arrival : takeAll(*source)) {
        EXPECT_EQ(arrival.result.ok(), arrival.page != 2);
        failed += absl::IsDataLoss(arrival.result.status()) ? 1 : 0;
    }
    EXPECT_EQ(failed, 1);
    EXPECT_EQ(source->bytes(), 0U);
}

TEST(Loader, TriesAFailedPageAgainLaterAndLaterUntilItCanBeRead) {
    FakePages pages;
    pages.fail(5, absl::UnavailableError("the page server is down"));
    Loader loader({.threads = 1, .firstRetry = milliseconds(2), .lastRetry = milliseconds(8)});
    const auto source = loader.open(pages.function(), 1000);
    std::vector<std::chrono::steady_clock::duration> pauses;
    const auto start = std::chrono::steady_clock::now();
    while (pauses.size() < 5) {
        ASSERT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
        source->wish(wishes({5}));
        if (!source->wait())
            continue;
        const auto arrivals = source->take();
        EXPECT_TRUE(absl::IsUnavailable(arrivals.front().result.status()));
        EXPECT_GT(arrivals.front().retryAt, start + milliseconds(2));
        pauses.push_back(arrivals.front().retryAt - start);
    }
    EXPECT_GE(pauses.back(), milliseconds(2 + 4 + 8 + 8)) << "the pause should grow";
    pages.repair(5);
    std::vector<Arrival> arrivals;
    while (arrivals.empty()) {
        ASSERT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
        source->wish(wishes({5}));
        source->wait();
        arrivals = source->take();
    }
    EXPECT_TRUE(arrivals.front().result.ok());
}

TEST(Loader, WaitsThroughTheFirstFailuresOfAPageAndNoLonger) {
    FakePages pages;
    pages.fail(5, absl::UnavailableError("the page server is busy"));
    Loader loader({.threads = 2, .firstRetry = milliseconds(1), .lastRetry = milliseconds(2)});
    const auto source = loader.open(pages.function(), 1000);
    std::vector<bool> givenUp;
    source->wish(wishes({5}));
    while (source->wait()) {
        for (const Arrival& arrival : source->take()) givenUp.push_back(arrival.isGivenUp);
        source->wish(wishes({5}));
        if (givenUp.size() == 3)
            break;
    }
    EXPECT_EQ(givenUp, (std::vector<bool>{false, false, true}));
    pages.repair(5);
    while (!source->wait()) source->wish(wishes({5}));
    bool hasCome = false;
    while (!hasCome) {  // perhaps after one more failure that was under way
        for (const Arrival& arrival : source->take()) hasCome |= arrival.result.ok();
        source->wish(wishes({5}));
    }
}

TEST(Loader, TriesADamagedPageAgainAfterTheLongestPauseOnly) {
    FakePages pages;
    pages.fail(5, absl::DataLossError("page 5: its checksum is wrong"));
    Loader loader({.threads = 1, .firstRetry = milliseconds(1), .lastRetry = milliseconds(60'000)});
    const auto source = loader.open(pages.function(), 1000);
    source->wish(wishes({5}));
    ASSERT_TRUE(source->wait());
    const auto arrivals = source->take();
    EXPECT_TRUE(arrivals.front().isGivenUp);
    EXPECT_GT(arrivals.front().retryAt,
              std::chrono::steady_clock::now() + std::chrono::seconds(50));
    source->wish(wishes({5}));
    EXPECT_FALSE(source->wait()) << "nobody waits for it";
}

TEST(Loader, WaitsForTheNextAttemptAtAGivenUpPageOnceItIsDue) {
    FakePages pages;
    pages.fail(5, absl::DataLossError("page 5: its checksum is wrong"));
    Loader loader({.threads = 1, .firstRetry = milliseconds(1), .lastRetry = milliseconds(20)});
    const auto source = loader.open(pages.function(), 1000);
    source->wish(wishes({5}));
    ASSERT_TRUE(source->wait());
    source->take();
    std::this_thread::sleep_for(milliseconds(40));
    FakePages others;  // keep the thread, so that the attempt begins when somebody waits
    others.hold(true);
    const auto other = loader.open(others.function(), 1000);
    other->wish(wishes({1}));
    others.awaitBegun(1);
    source->wish(wishes({5}));
    const std::jthread release([&] {
        std::this_thread::sleep_for(milliseconds(20));
        others.hold(false);
    });
    EXPECT_TRUE(source->wait());
    EXPECT_EQ(source->take().size(), 1U);
}

TEST(Loader, AsksASourceThatFailedForOnePageAtATimeUntilOneComes) {
    FakePages pages;
    for (std::uint32_t page = 0; page < 8; ++page)
        pages.fail(page, absl::UnavailableError("the server is down"));
    pages.hold(true);
    Loader loader({.threads = 4, .firstRetry = milliseconds(20), .lastRetry = milliseconds(20)});
    const auto source = loader.open(pages.function(), 1000);
    source->wish(wishes({0, 1, 2, 3, 4, 5, 6, 7}));
    pages.awaitBegun(4);
    pages.hold(false);
    ASSERT_TRUE(source->wait());
    while (source->bytes() > 0 && source->wait()) source->take();
    pages.hold(true);
    const std::size_t before = pages.begun().size();
    source->take();
    source->wish(wishes({4, 5, 6, 7}));
    pages.awaitBegun(before + 1);
    std::this_thread::sleep_for(milliseconds(60));  // long enough for the others to begin
    EXPECT_LE(pages.begun().size(), before + 1);
    for (std::uint32_t page = 0; page < 8; ++page) pages.repair(page);
    pages.hold(false);
    std::size_t come = 0;
    while (come < 4 && source->wait())
        for (const Arrival& arrival : source->take()) come += arrival.result.ok() ? 1 : 0;
    EXPECT_EQ(come, 4U);
}

TEST(Loader, OnePageThatAlwaysFailsDoesNotKeepTheOthersAway) {
    FakePages pages;
    pages.fail(1, absl::UnavailableError("503 for this page alone"));
    Loader loader({.threads = 1, .firstRetry = milliseconds(1), .lastRetry = milliseconds(1)});
    const auto source = loader.open(pages.function(), 1000);
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    std::size_t come = 0;
    std::vector<std::uint32_t> left{1, 2, 3, 4, 5, 6, 7, 8};
    while (left.size() > 1 && std::chrono::steady_clock::now() < end) {
        source->wish(wishes(left));
        for (const Arrival& arrival : source->take())
            if (arrival.result.ok()) {
                ++come;
                std::erase(left, arrival.page);
            }
    }
    EXPECT_EQ(come, 7U);
}

TEST(Loader, ASlowSourceDoesNotHoldUpAnother) {
    FakePages slow;
    slow.hold(true);
    FakePages quick;
    Loader loader({.threads = 2});
    const auto stuck = loader.open(slow.function(), kPageBytes);
    const auto source = loader.open(quick.function(), 1000);
    stuck->wish(wishes({1, 2, 3}));
    slow.awaitBegun(1);
    source->wish(wishes({1, 2, 3}));
    EXPECT_EQ(takeAll(*source).size(), 3U);
    slow.hold(false);
}

TEST(Loader, TurnsAnExceptionIntoAFailure) {
    Loader loader({.threads = 1});
    const auto source =
        loader.open([](std::uint32_t) -> absl::StatusOr<Loaded> { throw std::bad_alloc(); }, 1000);
    source->wish(wishes({1}));
    ASSERT_TRUE(source->wait());
    EXPECT_TRUE(absl::IsResourceExhausted(source->take().front().result.status()));
}

TEST(Loader, ASourceEndsWithoutItsWishesButWaitsForWhatIsBeingLoaded) {
    FakePages pages;
    pages.hold(true);
    Loader loader({.threads = 1});
    auto source = loader.open(pages.function(), 1000);
    source->wish(wishes({1, 2, 3}));
    pages.awaitBegun(1);
    pages.hold(false);
    source.reset();
    EXPECT_LE(pages.begun().size(), 3U);
    const std::size_t begun = pages.begun().size();
    const auto other = loader.open(pages.function(), 1000);
    other->wish(wishes({9}));
    EXPECT_EQ(takeAll(*other).size(), 1U);
    EXPECT_EQ(pages.begun().size(), begun + 1) << "the ended source's wishes are gone";
}

TEST(Loader, NobodyWaitsAnyMoreAfterAStop) {
    FakePages pages;
    pages.hold(true);
    Loader loader({.threads = 1});
    const auto source = loader.open(pages.function(), 1000);
    source->wish(wishes({1, 2}));
    pages.awaitBegun(1);
    std::stop_source stop;
    std::jthread stopper([&] { stop.request_stop(); });
    EXPECT_FALSE(source->wait(stop.get_token()));
    EXPECT_FALSE(source->wait(stop.get_token()));
    pages.hold(false);
    EXPECT_EQ(takeAll(*source).size(), 2U) << "what was wished for comes all the same";
}

}  // namespace
}  // namespace eyrie::page
