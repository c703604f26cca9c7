// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/dispatch.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "fake_renderer.h"
#include "tests/service/eventually.h"

namespace eyrie::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kWidth = 40;
constexpr int kHeight = 10;

class DispatchTest : public testing::Test {
protected:
    explicit DispatchTest(milliseconds leastPatience = seconds(50))
        : crew_(registry_, {.patience = {.least = leastPatience}}, [] {}) {
        fabric::Scene scene;
        scene.objects.push_back({"a", fabric::ObjectKind::Mesh, "a.eym", fabric::Mat4(1.0), {}});
        crew_.setScene(scene);
    }

    void openWith(int renderers) {
        for (int i = 0; i < renderers; ++i) {
            renderers_.push_back(std::make_shared<FakeRenderer>(layers_));
            ids_.push_back(registry_
                               .add(fmt::format("fake:{}", renderers_.size()), {},
                                    renderers_.back(), Registry::Clock::now())
                               .value());
            ASSERT_TRUE(eventually(
                [&] { return crew_.state().ready == static_cast<int>(renderers_.size()); }));
        }
    }

    /// Draws as many columns of the picture as there are preferences, by these.
    absl::StatusOr<std::vector<Dispatch::Drawn>> draw(const std::vector<std::size_t>& preferred,
                                                      const std::stop_token& stop = {}) {
        Dispatch::Plan plan;
        plan.frameData.version = 1;
        const int columns = static_cast<int>(preferred.size());
        for (int i = 0; i < columns; ++i) {
            fabric::ChannelTask task{1, 1, kWidth, kHeight, {}, {}, true};
            task.pixelViewport = {kWidth * i / columns, 0, kWidth / columns, kHeight};
            plan.tasks.push_back(task);
        }
        plan.sceneRevision = crew_.state().revision;
        plan.kind = 1;
        plan.firstPatience = seconds(50);
        plan.callTimeout = seconds(60);
        for (const std::size_t each : preferred) plan.takers.preferred.push_back(ids_.at(each));
        plan.stop = stop;
        return std::make_shared<Dispatch>(plan)->run(crew_);
    }
    std::vector<int> drawn() const {
        std::vector<int> counts;
        for (const auto& renderer : renderers_) counts.push_back(renderer->drawn);
        return counts;
    }

    std::shared_ptr<const LayeredScene> layers_ =
        std::make_shared<LayeredScene>(4711, kWidth, kHeight);
    std::vector<std::shared_ptr<FakeRenderer>> renderers_;
    std::vector<std::string> ids_;
    Registry registry_;
    Crew crew_;
};

class ImpatientDispatch : public DispatchTest {
protected:
    ImpatientDispatch() : DispatchTest(milliseconds(500)) {}
};

TEST_F(DispatchTest, EachTaskIsDrawnByTheRendererThatItPrefers) {
    openWith(3);
    for (const auto& renderer : renderers_) renderer->takes = milliseconds(5);
    ASSERT_TRUE(draw({2, 0, 2, 2}).ok());
    EXPECT_EQ(drawn(), (std::vector<int>{1, 0, 3}));
}

TEST_F(DispatchTest, WhatOneIsToDrawThatHasDiedIsDrawnByAnotherAndTheRestAsPreferred) {
    openWith(3);
    for (const auto& renderer : renderers_) renderer->takes = milliseconds(5);
    registry_.markDead(ids_[0], "test", Registry::Clock::now());
    ASSERT_TRUE(draw({1, 1, 2, 0}).ok());
    EXPECT_EQ(renderers_[0]->drawn, 0);
    EXPECT_GE(renderers_[1]->drawn, 2);
    EXPECT_GE(renderers_[2]->drawn, 1);
}

/// Expected: what it waited for does not count, however long a renderer says that was.
TEST_F(DispatchTest, WhatARendererHadToDoBeforeDoesNotCountAsTheTasksTime) {
    openWith(1);
    renderers_[0]->takes = milliseconds(60);
    const auto timeIf = [&](std::chrono::nanoseconds waited) {
        renderers_[0]->saysItWaited = waited;
        return draw({0}).value().at(0).taken;
    };
    EXPECT_GE(timeIf(milliseconds(0)), milliseconds(60));
    EXPECT_GE(timeIf(milliseconds(-70)), milliseconds(60));
    const auto rest = timeIf(milliseconds(50));
    EXPECT_GE(rest, milliseconds(10));
    EXPECT_EQ(timeIf(std::chrono::hours(24 * 365 * 200)), milliseconds(0));
}

TEST_F(ImpatientDispatch, APreferredRendererThatHangsIsNotWaitedFor) {
    openWith(2);
    ASSERT_TRUE(draw({0, 1}).ok());  // it is known how long they take
    renderers_[0]->hang(true);
    ASSERT_TRUE(draw({0, 0, 0, 1}).ok());
    EXPECT_EQ(drawn(), (std::vector<int>{1, 5}));
    ASSERT_TRUE(draw({0, 0, 1, 1}).ok());  // busy with what is past
    EXPECT_EQ(drawn(), (std::vector<int>{1, 9}));
    renderers_[0]->hang(false);
}

TEST_F(ImpatientDispatch, ARendererOfWhichNothingIsKnownIsGivenAsLongAsTheOthers) {
    openWith(1);
    ASSERT_TRUE(draw({0}).ok());
    openWith(1);
    renderers_[1]->hang(true);
    const auto start = std::chrono::steady_clock::now();
    ASSERT_TRUE(draw({0, 1}).ok());
    EXPECT_LT(std::chrono::steady_clock::now() - start, seconds(25));  // half of firstPatience
    EXPECT_EQ(drawn(), (std::vector<int>{3, 0}));
    renderers_[1]->hang(false);
}

/// Expected: it is asked no more, but it is not late either, for it has nothing in hand.
TEST_F(ImpatientDispatch, OneThatFailsWhileAnotherHangsIsNotLate) {
    openWith(3);
    ASSERT_TRUE(draw({0, 1, 2}).ok());
    renderers_[0]->hang(true);
    renderers_[1]->failToRender(absl::ResourceExhaustedError("too much to do"));
    ASSERT_TRUE(draw({0}).ok());
    EXPECT_EQ(drawn(), (std::vector<int>{1, 1, 2}));
    for (const auto& member : crew_.ready(crew_.state().revision))
        EXPECT_EQ(member->isLate(), member->id() == ids_[0]) << member->id();
    renderers_[0]->hang(false);
    EXPECT_TRUE(eventually([&] {
        return std::ranges::none_of(crew_.ready(crew_.state().revision),
                                    [](const auto& member) { return member->isLate(); });
    }));
}

TEST(MemberTest, TakesNothingAfterItsEnd) {
    Member member("a", {}, std::make_shared<FakeRenderer>(nullptr));
    member.retire();
    ASSERT_TRUE(eventually([&] { return member.hasEnded(); }));
    const fabric::FrameData data;
    const fabric::ChannelTask task;
    EXPECT_FALSE(member.draw({data, task}, [](const auto&, auto) { FAIL(); }));
    EXPECT_TRUE(absl::IsUnavailable(member.prepare(data, 1, seconds(1)).get()));
}

TEST_F(DispatchTest, WhatNobodyWantsIsGivenUpByRenderersAndNotHeldAgainstThem) {
    openWith(2);
    renderers_[0]->hang(true);
    std::stop_source stop;
    std::jthread stopper([&] {
        EXPECT_TRUE(eventually([&] { return renderers_[0]->begun == 1; }));
        stop.request_stop();
    });
    // The second part waits behind the first.
    EXPECT_TRUE(absl::IsCancelled(draw({0, 0}, stop.get_token()).status()));
    stopper.join();
    renderers_[0]->hang(false);
    ASSERT_TRUE(draw({0, 1}).ok());
    EXPECT_EQ(drawn(), (std::vector<int>{1, 1}));
    EXPECT_EQ(renderers_[0]->begun, 2);
    for (const auto& member : crew_.ready(crew_.state().revision)) EXPECT_FALSE(member->isLate());
    EXPECT_EQ(crew_.state().ready, 2);
}

TEST_F(DispatchTest, WhatNobodyWantedFromTheBeginningIsNotDrawn) {
    openWith(1);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_TRUE(absl::IsCancelled(draw({0}, stop.get_token()).status()));
    EXPECT_EQ(renderers_[0]->begun, 0);
}

}  // namespace
}  // namespace eyrie::coordinator
