// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/swap_group.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace eyrie::stream {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;
using Member = SwapGroup::Member;
using Word = SwapGroup::Word;

constexpr milliseconds kPatience{100};

Clock::time_point at(int ms) {
    return Clock::time_point(std::chrono::seconds(1000)) + milliseconds(ms);
}

/// Two members who have been given the picture of swap 1 at 0 ms.
SwapGroup two() {
    SwapGroup group(kPatience);
    group.join(1);
    group.join(2);
    const std::vector<SwapGroup::Candidate> both{{1, true}, {2, true}};
    EXPECT_THAT(group.gather(both, at(0)), ElementsAre(1, 2));
    group.begin(1, std::vector<Member>{1, 2});
    group.given(1, 1, at(0));
    group.given(2, 1, at(0));
    return group;
}

TEST(SwapGroup, SaysNothingBeforeAllAreReady) {
    SwapGroup group = two();
    group.ready(1, 1, at(5));
    EXPECT_THAT(group.takeWords(at(5)), IsEmpty());
    EXPECT_TRUE(group.isSwapping());
    group.ready(2, 1, at(9));
    EXPECT_THAT(group.takeWords(at(9)), ElementsAre(Word{1, 1}, Word{2, 1}));
    EXPECT_FALSE(group.isSwapping());
    EXPECT_THAT(group.takeWords(at(10)), IsEmpty());
    EXPECT_EQ(group.takeEnded().together, 1);
}

TEST(SwapGroup, DoesNotBeginWhileOneHasNoRoomUntilItsPatienceEnds) {
    SwapGroup group(kPatience);
    group.join(1);
    group.join(2);
    const std::vector<SwapGroup::Candidate> stalled{{1, true}, {2, false}};
    EXPECT_THAT(group.gather(stalled, at(0)), IsEmpty());
    EXPECT_EQ(group.deadline(), at(100));
    EXPECT_THAT(group.gather(stalled, at(99)), IsEmpty());
    EXPECT_THAT(group.gather(stalled, at(100)), ElementsAre(1));
    EXPECT_FALSE(group.isInStep(2));
    EXPECT_EQ(group.behind(), 1);
}

TEST(SwapGroup, GoesOnWithoutOneThatIsLate) {
    SwapGroup group = two();
    group.ready(1, 1, at(5));
    EXPECT_EQ(group.deadline(), at(100));
    EXPECT_THAT(group.takeWords(at(99)), IsEmpty());
    EXPECT_THAT(group.takeWords(at(100)), ElementsAre(Word{1, 1}));
    EXPECT_EQ(group.behind(), 1);
    EXPECT_EQ(group.takeEnded().cutShort, 1);
}

TEST(SwapGroup, CountsPatienceFromWhenAllHaveTheirPictures) {
    SwapGroup group(kPatience);
    group.join(1);
    group.join(2);
    group.begin(1, std::vector<Member>{1, 2});
    group.given(1, 1, at(0));
    group.ready(1, 1, at(1));
    EXPECT_EQ(group.deadline(), std::nullopt) << "the other's is being encoded";
    EXPECT_THAT(group.takeWords(at(5000)), IsEmpty());
    group.given(2, 1, at(5000));
    EXPECT_EQ(group.deadline(), at(5100));
}

TEST(SwapGroup, LetsOneThatIsBehindShowWhatItHasAndTakesItBackOnceItIsInTime) {
    SwapGroup group = two();
    group.ready(1, 1, at(5));
    group.takeWords(at(100));
    ASSERT_FALSE(group.isInStep(2));
    group.ready(2, 1, at(450));
    EXPECT_THAT(group.takeWords(at(450)), ElementsAre(Word{2, 1}));
    EXPECT_FALSE(group.isInStep(2)) << "450 ms are not in time";
    group.given(2, 2, at(500));
    group.ready(2, 2, at(560));
    EXPECT_THAT(group.takeWords(at(560)), ElementsAre(Word{2, 2}));
    EXPECT_TRUE(group.isInStep(2));
}

TEST(SwapGroup, DoesNotWaitForOneThatLeaves) {
    SwapGroup group = two();
    group.ready(1, 1, at(5));
    group.leave(2);
    EXPECT_THAT(group.takeWords(at(6)), ElementsAre(Word{1, 1}));
    group.leave(1);
    EXPECT_EQ(group.size(), 0);
    EXPECT_THAT(group.takeWords(at(7)), IsEmpty());
}

TEST(SwapGroup, EndsASwapThatAllHaveLeft) {
    SwapGroup group = two();
    group.join(3);
    group.leave(1);
    group.leave(2);
    EXPECT_FALSE(group.isSwapping());
    EXPECT_EQ(group.deadline(), std::nullopt);
}

TEST(SwapGroup, DoesNotBelieveWhoIsReadyForSomethingElse) {
    SwapGroup group = two();
    group.ready(1, 1, at(1));
    group.ready(1, 1, at(2));
    group.ready(2, 7, at(3));
    group.ready(2, 0, at(3));
    group.ready(9, 1, at(3));
    EXPECT_THAT(group.takeWords(at(4)), IsEmpty());
}

TEST(SwapGroup, GoesOnWithoutAPictureThatCannotBeMade) {
    SwapGroup group = two();
    group.ready(1, 1, at(1));
    group.withheld(2);
    EXPECT_THAT(group.takeWords(at(1)), ElementsAre(Word{1, 1}));
    EXPECT_TRUE(group.isInStep(2));
}

/// Viewers that get ready late, early or never, join and leave, driven as a session drives a group.
/// What is drawn is held against what was said, member by member.
class Wall {
public:
    explicit Wall(unsigned seed) : dice_(seed) {}

    void step() {
        now_ += milliseconds(in(0, 40));
        switch (in(0, 9)) {
            case 0:
                join();
                break;
            case 1:
                leave();
                break;
            case 2:
            case 3:
                begin();
                break;
            case 4:
                catchUp();
                break;
            default:
                getReady();
        }
        say();
    }

    /// From now on everybody is ready at once.
    void settle() {
        for (int i = 0; i < 3; ++i) {
            now_ += 2 * kPatience;
            say();
            for (const auto& [member, screen] : screens_) decoded(member);
            say();
            for (auto& [member, screen] : screens_)
                if (!group_.isInStep(member)) {
                    give(member, ++last_);
                    decoded(member);
                }
            say();
        }
    }

    SwapGroup& group() { return group_; }
    int swaps() const { return swaps_; }
    int cutShort() const { return cutShort_; }

private:
    struct Screen {
        std::uint64_t has = 0;  ///< given, and not drawn yet; 0: none
        bool isDecoded = false;
        std::uint64_t drawn = 0;
        Clock::time_point givenAt;
    };

    int in(int least, int most) { return std::uniform_int_distribution(least, most)(dice_); }

    Member someone() {
        auto each = screens_.begin();
        std::advance(each, in(0, static_cast<int>(screens_.size()) - 1));
        return each->first;
    }

    void join() {
        if (screens_.size() >= 6)
            return;
        screens_[++lastMember_];
        group_.join(lastMember_);
    }

    void leave() {
        if (screens_.empty())
            return;
        const Member member = someone();
        screens_.erase(member);
        group_.leave(member);
        std::erase(swapping_, member);
    }

    void give(Member member, std::uint64_t swap) {
        screens_[member] = {swap, false, screens_[member].drawn, now_};
        group_.given(member, swap, now_);
    }

    void begin() {
        std::vector<SwapGroup::Candidate> candidates;
        for (const auto& [member, screen] : screens_)
            if (group_.isInStep(member))
                candidates.push_back({member, in(0, 9) != 0});
        const bool wasSwapping = group_.isSwapping();
        const std::vector<Member> members = group_.gather(candidates, now_);
        if (members.empty())
            return;
        ASSERT_FALSE(wasSwapping) << "a second picture before the first was shown";
        group_.begin(++last_, members);
        swapping_ = members;
        for (const Member member : members) give(member, last_);
    }

    /// One that is behind gets a picture by itself.
    void catchUp() {
        for (const auto& [member, screen] : screens_)
            if (!group_.isInStep(member) && screen.isDecoded == (screen.has != 0))
                return give(member, ++last_);
    }

    void getReady() {
        if (!screens_.empty())
            decoded(someone());
    }

    void decoded(Member member) {
        Screen& screen = screens_.at(member);
        if (screen.has == 0)
            return;
        screen.isDecoded = true;
        group_.ready(member, screen.has, now_);
    }

    void say() {
        const bool wasSwapping = group_.isSwapping();
        const std::vector<Word> words = group_.takeWords(now_);
        const bool hasEnded = wasSwapping && !group_.isSwapping();
        for (const Word& word : words) {
            ASSERT_TRUE(screens_.contains(word.member)) << "a word to one that has left";
            Screen& screen = screens_.at(word.member);
            EXPECT_EQ(screen.has, word.swap);
            EXPECT_TRUE(screen.isDecoded) << "a word before the picture was there";
            EXPECT_GT(word.swap, screen.drawn) << "back to an older picture, or the same twice";
            screen.drawn = word.swap;
            screen.has = 0;
        }
        if (hasEnded)
            checkEnd();
        const SwapGroup::Ended ended = group_.takeEnded();
        swaps_ += ended.together + ended.cutShort;
        cutShort_ += ended.cutShort;
    }

    /// Whoever has not drawn it with the others was late, and is behind for that.
    void checkEnd() {
        const std::uint64_t swap = last_;
        for (const Member member : swapping_) {
            const Screen& screen = screens_.at(member);
            if (screen.drawn == swap || screen.has == 0)
                continue;
            EXPECT_FALSE(group_.isInStep(member)) << "waited for no longer, but not behind";
            EXPECT_GE(now_ - screen.givenAt, kPatience) << "given up too early";
        }
        swapping_.clear();
    }

    std::mt19937 dice_;
    Clock::time_point now_ = at(0);
    SwapGroup group_{kPatience};
    std::map<Member, Screen> screens_;
    std::vector<Member> swapping_;
    Member lastMember_ = 0;
    std::uint64_t last_ = 0;
    int swaps_ = 0;
    int cutShort_ = 0;
};

TEST(SwapGroup, ShowsNothingBeforeAllInStepHaveItAndNeverHangsWhateverHappens) {
    int swaps = 0;
    int cutShort = 0;
    for (unsigned seed = 1; seed <= 300; ++seed) {
        SCOPED_TRACE(seed);
        Wall wall(seed);
        for (int i = 0; i < 400; ++i) {
            wall.step();
            if (testing::Test::HasFailure())
                return;
        }
        wall.settle();
        EXPECT_FALSE(wall.group().isSwapping());
        EXPECT_EQ(wall.group().behind(), 0) << "all are in time again";
        swaps += wall.swaps();
        cutShort += wall.cutShort();
    }
    EXPECT_GT(swaps, 3000);
    EXPECT_GT(cutShort, 300);
    EXPECT_LT(cutShort, swaps);
}

}  // namespace
}  // namespace eyrie::stream
