// SPDX-License-Identifier: Apache-2.0
// Who hears of frames: the newest, at the pace asked for, until there are no more.
#include "coordinator/stream/statistics_feed.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "eyrie/v1/coordinator_service.pb.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/service/eventually.h"

namespace eyrie::stream {
namespace {

using std::chrono::hours;

coordinator::RenderedFrame frameOf(std::uint64_t triangles) {
    coordinator::FrameRequest request;
    request.width = 8;
    request.height = 4;
    coordinator::RenderedFrame frame = coordinator::plainFrame(request, {1, 2, 3, 255});
    frame.statistics.triangles = triangles;
    return frame;
}

/// What a reader was told.
class Heard {
public:
    StatisticsFeed::Then then() {
        return [this](const absl::StatusOr<StatisticsFeed::Message>& message) {
            const std::lock_guard lock(mutex_);
            messages_.push_back(message);
        };
    }
    std::size_t count() const {
        const std::lock_guard lock(mutex_);
        return messages_.size();
    }
    bool becomes(std::size_t count) const {
        return eventually([&] { return this->count() == count; });
    }
    absl::StatusOr<StatisticsFeed::Message> last() const {
        const std::lock_guard lock(mutex_);
        return messages_.back();
    }
    std::uint64_t triangles() const { return (*last())->statistics().triangles(); }

private:
    mutable std::mutex mutex_;
    std::vector<absl::StatusOr<StatisticsFeed::Message>> messages_;
};

TEST(StatisticsFeed, TellsTheLastFrameFirstAndThenEach) {
    StatisticsFeed feed;
    feed.drawn("a", frameOf(10));
    Heard heard;
    const auto reader = feed.read({}).value();
    reader->next(heard.then());
    ASSERT_TRUE(heard.becomes(1));
    EXPECT_EQ(heard.triangles(), 10U);
    EXPECT_EQ((*heard.last())->session(), "a");
    EXPECT_EQ((*heard.last())->statistics().width(), 8);
    EXPECT_GT((*heard.last())->unix_milliseconds(), 1'000'000'000'000);
    reader->next(heard.then());
    feed.drawn("", frameOf(20));
    ASSERT_TRUE(heard.becomes(2));
    EXPECT_EQ(heard.triangles(), 20U);
    EXPECT_EQ((*heard.last())->frame(), 2U);
    EXPECT_EQ((*heard.last())->left_out(), 0U);
}

TEST(StatisticsFeed, WhoReadsSlowlyGetsTheNewestAndHowManyWereLeftOut) {
    StatisticsFeed feed;
    const auto reader = feed.read({}).value();
    for (std::uint64_t i = 1; i <= 1000; ++i) feed.drawn("a", frameOf(i));
    Heard heard;
    reader->next(heard.then());
    ASSERT_TRUE(heard.becomes(1));
    EXPECT_EQ(heard.triangles(), 1000U);
    EXPECT_EQ((*heard.last())->left_out(), 999U);
    feed.drawn("a", frameOf(7));
    reader->next(heard.then());
    ASSERT_TRUE(heard.becomes(2));
    EXPECT_EQ((*heard.last())->left_out(), 0U);
}

TEST(StatisticsFeed, TellsNoMoreOftenThanAskedFor) {
    StatisticsFeed feed;
    Heard seldom;
    Heard often;
    const auto slow = feed.read({"", hours(1)}).value();
    const auto fast = feed.read({}).value();
    for (std::uint64_t i = 1; i <= 3; ++i) {
        fast->next(often.then());
        feed.drawn("a", frameOf(i));
        ASSERT_TRUE(often.becomes(i));
        if (i == 1) {
            slow->next(seldom.then());
            ASSERT_TRUE(seldom.becomes(1));
            slow->next(seldom.then());
        }
    }
    EXPECT_EQ(seldom.count(), 1U);
}

TEST(StatisticsFeed, TellsTheLastFrameThoughNoneFollows) {
    StatisticsFeed feed;
    Heard heard;
    const auto reader = feed.read({"", std::chrono::milliseconds(200)}).value();
    reader->next(heard.then());
    feed.drawn("a", frameOf(1));
    ASSERT_TRUE(heard.becomes(1));
    reader->next(heard.then());
    feed.drawn("a", frameOf(2));  // too soon
    ASSERT_TRUE(heard.becomes(2));
    EXPECT_EQ(heard.triangles(), 2U);
}

TEST(StatisticsFeed, TellsOfOneSessionOnly) {
    StatisticsFeed feed;
    feed.drawn("b", frameOf(1));
    Heard heard;
    Heard all;
    const auto reader = feed.read({"a", {}}).value();
    const auto other = feed.read({}).value();
    reader->next(heard.then());
    other->next(all.then());
    ASSERT_TRUE(all.becomes(1));
    EXPECT_EQ(heard.count(), 0U);
    feed.drawn("", frameOf(2));
    feed.drawn("a", frameOf(3));
    ASSERT_TRUE(heard.becomes(1));
    EXPECT_EQ(heard.triangles(), 3U);
    EXPECT_EQ((*heard.last())->left_out(), 0U) << "those of others count for nothing";
}

TEST(StatisticsFeed, TellsTheLastFrameOfTheSessionThoughOthersFollowed) {
    StatisticsFeed feed;
    feed.drawn("a", frameOf(1));
    feed.drawn("b", frameOf(2));
    feed.drawn("", frameOf(3));
    Heard heard;
    const auto reader = feed.read({"a", {}}).value();
    reader->next(heard.then());
    ASSERT_TRUE(heard.becomes(1));
    EXPECT_EQ(heard.triangles(), 1U);
    EXPECT_EQ((*heard.last())->left_out(), 0U);
    feed.ended("a");
    Heard next;
    const auto other = feed.read({"a", {}}).value();
    other->next(next.then());
    feed.drawn("a", frameOf(4));
    ASSERT_TRUE(next.becomes(1));
    EXPECT_EQ(next.triangles(), 4U) << "of the session that has the name now";
}

TEST(StatisticsFeed, TellsTheLastFrameOfASessionThatBeganBeforeThatOfItsNameHadEnded) {
    StatisticsFeed feed;
    feed.drawn("a", frameOf(1), 7);
    feed.drawn("a", frameOf(2), 8);
    feed.drawn("a", frameOf(3), 7);  // it was under way
    const auto first = [&feed] {
        Heard heard;
        const auto reader = feed.read({"a", {}}).value();
        reader->next(heard.then());
        EXPECT_TRUE(heard.becomes(1));
        return heard.triangles();
    };
    EXPECT_EQ(first(), 2U);
    feed.ended("a", 7);
    EXPECT_EQ(first(), 2U);
}

TEST(StatisticsFeed, TellsWhoWaitsThatThereWillBeNoMore) {
    StatisticsFeed feed;
    Heard heard;
    const auto reader = feed.read({}).value();
    reader->next(heard.then());
    feed.stop();
    ASSERT_EQ(heard.count(), 1U);
    EXPECT_TRUE(absl::IsUnavailable(heard.last().status()));
    reader->next(heard.then());
    EXPECT_EQ(heard.count(), 2U);
    EXPECT_TRUE(absl::IsUnavailable(feed.read({}).status()));
    feed.drawn("a", frameOf(1));
    feed.stop();
}

TEST(StatisticsFeed, HasSoManyReadersAtATime) {
    StatisticsFeed feed(2);
    auto one = feed.read({}).value();
    const auto two = feed.read({}).value();
    EXPECT_TRUE(absl::IsResourceExhausted(feed.read({}).status()));
    one.reset();
    EXPECT_TRUE(feed.read({}).ok());
}

TEST(StatisticsFeed, TellsNobodyWhoHasGone) {
    StatisticsFeed feed;
    std::atomic<bool> isOver = false;
    std::thread drawing([&] {
        for (std::uint64_t i = 0; !isOver; ++i) feed.drawn("a", frameOf(i));
    });
    for (int i = 0; i < 500; ++i) {
        auto count = std::make_unique<std::atomic<int>>(0);
        auto reader = feed.read({}).value();
        reader->next([told = count.get()](const auto&) { ++*told; });
        if (i % 2 == 0)
            std::this_thread::yield();
        reader.reset();
        count.reset();  // what is told after this is told to freed memory
    }
    isOver = true;
    drawing.join();
}

}  // namespace
}  // namespace eyrie::stream
