// SPDX-License-Identifier: Apache-2.0
#include "renderer/page/host_pages.h"

#include <map>
#include <mutex>

#include <gtest/gtest.h>

namespace eyrie::page {
namespace {

using std::chrono::milliseconds;
using Pages = std::vector<std::uint32_t>;

constexpr std::uint64_t kGreatestBytes = 10;
/// A quarter is the loader's: six pages of the greatest size are kept.
constexpr std::uint64_t kLimitBytes = 80;

class HostPagesTest : public testing::Test {
protected:
    absl::StatusOr<Loaded> load(std::uint32_t page) {
        const std::lock_guard lock(mutex_);
        ++loads_[page];
        if (const auto failing = failing_.find(page); failing != failing_.end())
            return failing->second;
        return Loaded{std::make_shared<std::uint32_t>(page), bytes_};
    }
    void fail(std::uint32_t page, const absl::Status& status) {
        const std::lock_guard lock(mutex_);
        failing_[page] = status;
    }
    void repair(std::uint32_t page) {
        const std::lock_guard lock(mutex_);
        failing_.erase(page);
    }
    int loadsOf(std::uint32_t page) {
        const std::lock_guard lock(mutex_);
        return loads_[page];
    }

    void want(const Pages& wanted) {
        pages_.beginFrame();
        for (const std::uint32_t page : wanted) pages_.want(page);
    }
    /// Until there is nothing left to wait for.
    HostPages::Loads loadWanted() {
        HostPages::Loads loads;
        pages_.wish();
        while (pages_.wait({})) {
            loads.add(pages_.take());
            pages_.wish();
            EXPECT_LE(pages_.bytes(), kLimitBytes);
        }
        return loads;
    }
    Pages there() {
        Pages found;
        for (std::uint32_t page = 0; page < 20; ++page)
            if (const std::shared_ptr<const void>* value = pages_.find(page)) {
                EXPECT_EQ(*static_cast<const std::uint32_t*>(value->get()), page);
                found.push_back(page);
            }
        return found;
    }

    std::mutex mutex_;
    std::map<std::uint32_t, int> loads_;
    std::map<std::uint32_t, absl::Status> failing_;
    std::uint64_t bytes_ = kGreatestBytes;  ///< that a page takes

    Loader loader_{
        {.threads = 1, .firstRetry = milliseconds(1), .lastRetry = milliseconds(2), .patience = 2}};
    HostPages pages_{loader_,
                     [this](std::uint32_t page) { return load(page); },
                     {"pages.eyt", [](std::uint32_t) { return kGreatestBytes; },
                      [](std::uint32_t page) { return page == 13 ? 0U : 4U; }},
                     kLimitBytes,
                     kGreatestBytes};
};

TEST_F(HostPagesTest, AreTheMostWantedThatFit) {
    want({3, 1, 4, 1, 5, 9, 2, 6, 8});
    const HostPages::Loads loads = loadWanted();
    EXPECT_EQ(there(), (Pages{1, 2, 3, 4, 5, 9}));
    EXPECT_EQ(loads.pages, 6U);
    EXPECT_EQ(loads.bytes, 24U) << "as they lie in the file";
    EXPECT_FALSE(loads.hasFailed);
    EXPECT_EQ(loadsOf(6) + loadsOf(8), 0);
}

TEST_F(HostPagesTest, StayWhileTheyAreWantedAndMakeRoomWhenTheyAreNot) {
    want({0, 1, 2, 3, 4, 5});
    loadWanted();
    want({3, 4, 5, 6, 7, 8});
    loadWanted();
    EXPECT_EQ(there(), (Pages{3, 4, 5, 6, 7, 8}));
    EXPECT_EQ(loadsOf(3), 1) << "it was there";
    want({7});
    loadWanted();
    EXPECT_EQ(there(), (Pages{3, 4, 5, 6, 7, 8})) << "nobody needs the room";
}

TEST_F(HostPagesTest, CountAsWhatTheyTakeOnceThatIsKnown) {
    bytes_ = kGreatestBytes / 2;
    want({0, 1, 2, 3, 4, 5, 6, 7});
    loadWanted();
    EXPECT_EQ(there().size(), 6U) << "any might have taken the most";
    want({0, 1, 2, 3, 4, 5, 6, 7});
    loadWanted();
    EXPECT_EQ(there().size(), 8U);
}

TEST_F(HostPagesTest, WithoutBytesInTheFileAreNotAskedFor) {
    want({12, 13});
    loadWanted();
    EXPECT_EQ(there(), Pages{12});
    EXPECT_EQ(loadsOf(13), 0);
}

TEST_F(HostPagesTest, AreGivenUpWhenTheyCannotBeReadAndComeWhenTheyCan) {
    fail(2, absl::DataLossError("page 2: its checksum is wrong"));
    want({1, 2});
    EXPECT_TRUE(loadWanted().hasFailed);
    EXPECT_EQ(there(), Pages{1});
    EXPECT_TRUE(pages_.isFailing(2));
    EXPECT_FALSE(pages_.isFailing(1));
    EXPECT_TRUE(pages_.isGivenUp(2, {}));
    EXPECT_FALSE(pages_.isGivenUp(2, HostPages::Clock::now() + milliseconds(100)))
        << "it has been tried again by then";
    EXPECT_FALSE(pages_.isGivenUp(1, {}));

    repair(2);
    const auto end = HostPages::Clock::now() + std::chrono::seconds(10);
    while (pages_.isFailing(2) && HostPages::Clock::now() < end) {
        pages_.tryWish();
        pages_.tryTake();
    }
    EXPECT_EQ(there(), (Pages{1, 2}));
    EXPECT_FALSE(pages_.isGivenUp(2, {}));
}

TEST_F(HostPagesTest, AllFailWhileTheirSourceIsAway) {
    want({1});
    loadWanted();
    fail(2, absl::UnavailableError("nobody answers"));
    want({1, 2});
    EXPECT_TRUE(loadWanted().hasFailed);
    EXPECT_TRUE(pages_.isFailing(7)) << "it would, were it asked for";
    repair(2);
    const auto end = HostPages::Clock::now() + std::chrono::seconds(10);
    while (pages_.isFailing(7) && HostPages::Clock::now() < end) {
        pages_.wish();
        pages_.take();
    }
    EXPECT_FALSE(pages_.isFailing(7));
    EXPECT_EQ(there(), (Pages{1, 2}));
}

TEST_F(HostPagesTest, TellHowLongTheyTakeToCome) {
    const auto before = pages_.latency();
    for (std::uint32_t page = 0; page < 6; ++page) {
        want({page});
        loadWanted();
    }
    EXPECT_GT(pages_.latency().count(), 0);
    EXPECT_LT(pages_.latency(), before) << "far less than what is taken for granted at first";
}

}  // namespace
}  // namespace eyrie::page
