// SPDX-License-Identifier: Apache-2.0
// Scenes and data: who has opened which, and who may take part.
#include <algorithm>
#include <atomic>

#include <gmock/gmock.h>

#include "frame_pipeline_fixture.h"

namespace eyrie::coordinator {
namespace {

class FrameScenes : public FramePipelineTest {};

INSTANTIATE_TEST_SUITE_P(Of, FrameScenes, testing::Values("2D", "DB dynamic"),
                         [](const auto& of) { return test::identifier(of.param); });

TEST_P(FrameScenes, StatusSaysWhatIsMissing) {
    EXPECT_THAT(pipeline_.status().problem, testing::HasSubstr("scene is empty"));
    pipeline_.setScene(sceneNamed("first"));
    EXPECT_THAT(pipeline_.status().problem, testing::HasSubstr("no renderer is connected"));
    auto broken = std::make_shared<FakeRenderer>(layers_);
    broken->failToOpen(absl::NotFoundError("a.eym: no such file"));
    ASSERT_TRUE(registry_.add("fake:0", {}, broken, Registry::Clock::now()).ok());
    EXPECT_TRUE(eventually([&] {
        return pipeline_.status().problem.find("a.eym: no such file") != std::string::npos;
    }));
    openWith(1);
    EXPECT_EQ(pipeline_.status().problem, "");
    EXPECT_EQ(pipeline_.status().sceneInfo.triangles, 30U);
    EXPECT_EQ(pipeline_.status().scene.objects[0].name, "first");
}

TEST_P(FrameScenes, ARendererWhoseDataCannotBeHadStaysAndIsAskedAgain) {
    constexpr auto kAlways = Registry::Clock::time_point::max();
    const auto says = [&](const char* text) {
        return eventually(
            [&] { return pipeline_.status().problem.find(text) != std::string::npos; });
    };
    pipeline_.setScene(sceneNamed("first"));
    auto renderer = std::make_shared<FakeRenderer>(layers_);
    renderer->failToOpen(absl::AbortedError("http://host/a.eym: no answer"));
    add(renderer);
    ASSERT_TRUE(says("the scene cannot be opened: http://host/a.eym: no answer"));
    for (const int asked : {2, 3}) {
        EXPECT_TRUE(eventually([&] {
            pipeline_.openAgain(kAlways);
            EXPECT_THAT(pipeline_.status().problem, testing::HasSubstr("no answer"));
            return renderer->asked >= asked;
        }));
        EXPECT_EQ(statusOf(0).condition, RendererCondition::Refused);
    }
    renderer->failToOpen(absl::AbortedError("http://host/a.eym: HTTP 503"));
    EXPECT_TRUE(eventually([&] {
        pipeline_.openAgain(kAlways);
        return pipeline_.status().problem.find("HTTP 503") != std::string::npos;
    }));
    renderer->failToOpen(absl::OkStatus());
    EXPECT_TRUE(eventually([&] {
        pipeline_.openAgain(kAlways);
        return pipeline_.status().problem.empty();
    }));
    const int asked = renderer->asked;
    pipeline_.openAgain(kAlways);
    awaitReady({renderer});
    expectWholePicture();
    EXPECT_EQ(renderer->asked, asked) << "it has the scene open";
}

TEST_P(FrameScenes, ListenersHearThatThePictureIsThere) {
    std::atomic<bool> ready{false};
    const int handle = pipeline_.subscribe([&] {
        if (pipeline_.status().problem.empty())
            ready = true;
    });
    openWith(1);
    EXPECT_TRUE(eventually([&] { return ready.load(); }));
    pipeline_.unsubscribe(handle);
}

/// Without a frame, and told to those who ask when they hear of a change.
TEST_P(FrameScenes, TheStatusHasTheLayoutsOfTheRenderersThereAre) {
    std::atomic<bool> heardOfTwo{false};
    const auto has = [&](const std::string& layout) {
        const auto canvases = pipeline_.status().canvases;
        return !canvases.empty() && std::ranges::count(canvases.front().layouts, layout) == 1;
    };
    const int handle = pipeline_.subscribe([&] {
        if (has(GetParam()))
            heardOfTwo = true;
    });
    EXPECT_TRUE(pipeline_.status().canvases.empty());
    pipeline_.setScene(sceneNamed("first"));
    addRenderer();
    EXPECT_TRUE(eventually([&] { return has("Simple"); }));
    EXPECT_FALSE(has(GetParam()));
    addRenderer();
    EXPECT_TRUE(eventually([&] { return heardOfTwo.load(); }));
    EXPECT_TRUE(has(GetParam()));
    pipeline_.setScene(sceneNamed("second"));
    EXPECT_TRUE(has(GetParam())) << "who opens another scene is not gone";
    EXPECT_TRUE(eventually([&] { return pipeline_.status().problem.empty(); }));
    registry_.markDead(ids_[0], "test", Registry::Clock::now());
    EXPECT_TRUE(eventually([&] { return !has(GetParam()); }));
    EXPECT_TRUE(has("Simple"));
    pipeline_.unsubscribe(handle);
}

TEST_P(FrameScenes, RenderersHaveAConfigurationBeforeThereIsAScene) {
    EXPECT_TRUE(absl::IsFailedPrecondition(
        pipeline_.withConfiguration([](ActiveConfiguration&) { return absl::OkStatus(); })));
    addRenderer();
    addRenderer();
    const auto nodes = [&] {
        std::size_t count = 0;
        EXPECT_TRUE(pipeline_
                        .withConfiguration([&](ActiveConfiguration& active) {
                            count = active.written().nodes.size();
                            return absl::OkStatus();
                        })
                        .ok());
        return count;
    };
    EXPECT_TRUE(eventually([&] { return nodes() == 2; }));
    EXPECT_TRUE(pipeline_.configure({"0", "Simple"}).ok());
    EXPECT_FALSE(pipeline_.renderFrame(request()).ok()) << "there is nothing to draw";
    pipeline_.setScene(sceneNamed("first"));
    EXPECT_TRUE(eventually([&] { return pipeline_.status().problem.empty(); }));
    EXPECT_EQ(nodes(), 2U);
    EXPECT_EQ(pipeline_.status().canvases.front().layout, "Simple");
}

TEST_P(FrameScenes, ANewSceneIsOpenedByAll) {
    const auto renderers = openWith(2);
    pipeline_.setScene(sceneNamed("second"));
    awaitReady(renderers);
    expectWholePicture();
    EXPECT_EQ(pipeline_.status().scene.objects[0].name, "second");
    EXPECT_EQ(renderers[0]->opened, (std::vector<std::string>{"first", "second"}));
}

/// So that parts which are asked for one by one are of one picture.
TEST_P(FrameScenes, OnlyPicturesOfAnotherSceneHaveAnotherRevision) {
    const auto renderers = openWith(2);
    const auto revision = [&](const FrameRequest& request) {
        const absl::StatusOr<RenderedFrame> frame = pipeline_.renderFrame(request);
        EXPECT_TRUE(frame.ok()) << frame.status();
        return frame.ok() ? frame->revision : 0;
    };
    const std::uint64_t first = revision(request());
    FrameRequest part = request();
    part.camera.eye.x += 1;
    part.tauPixels = 2;
    part.part = {3, 4, 10, 5};
    EXPECT_EQ(revision(part), first);
    registry_.markDead(ids_[1], "test", Registry::Clock::now());
    EXPECT_EQ(revision(request()), first) << "whoever draws, and by which compounds";
    pipeline_.setScene(sceneNamed("second"));
    awaitReady({renderers[0]});
    EXPECT_NE(revision(request()), first);
}

TEST_P(FrameScenes, ARendererThatFindsOtherDataIsRefusedWithTheDifference) {
    const auto renderers = openWith(2);
    auto other = std::make_shared<FakeRenderer>(std::make_shared<LayeredScene>(1));
    other->files = {{123, 0xabc}};
    for (const auto& renderer : renderers) EXPECT_TRUE(renderer->files.empty());
    add(other);
    ASSERT_TRUE(eventually([&] { return statusOf(2).condition == RendererCondition::Refused; }));
    EXPECT_THAT(statusOf(2).why, testing::HasSubstr("it names 1 files, the others 0"));
    for (int i = 0; i < 3; ++i) expectWholePicture();
    EXPECT_EQ(other->begun, 0);
}

TEST_P(FrameScenes, TheDifferenceOfDataNamesFileAndSums) {
    pipeline_.setScene(sceneNamed("hill"));
    for (const std::uint64_t sum : {1, 2}) {
        auto renderer = std::make_shared<FakeRenderer>(layers_);
        renderer->files = {{100, sum}};
        add(renderer);
        EXPECT_TRUE(eventually([&] {
            const RendererCondition is = statusOf(static_cast<int>(sum) - 1).condition;
            return is == RendererCondition::Ready || is == RendererCondition::Refused;
        }));
    }
    EXPECT_THAT(
        statusOf(1).why,
        testing::HasSubstr("hill (a.eym) has 100 bytes and sum 0000000000000002 there, 100 bytes "
                           "and sum 0000000000000001 with the others"));
    EXPECT_THAT(statusOf(1).why,
                testing::HasSubstr("where a file was replaced, set the scene again"));
}

TEST_P(FrameScenes, OtherDataAreDrawnWhenNobodyIsLeftWithTheFirst) {
    openWith(1);
    const auto layers = std::make_shared<LayeredScene>(1);
    std::vector<std::shared_ptr<FakeRenderer>> others;
    for (int i = 0; i < 2; ++i) {
        others.push_back(std::make_shared<FakeRenderer>(layers));
        others.back()->files = {{123, 0xabc}};
        add(others.back());
    }
    ASSERT_TRUE(eventually([&] {
        return statusOf(1).condition == RendererCondition::Refused &&
               statusOf(2).condition == RendererCondition::Refused;
    }));
    registry_.markDead(ids_[0], "test", Registry::Clock::now());
    awaitReady(others);
    const auto frame = pipeline_.renderFrame(request());
    ASSERT_TRUE(frame.ok()) << frame.status();
    EXPECT_TRUE(frame->image == layers->whole(kWidth, kHeight));
}

TEST_P(FrameScenes, ASuccessorWithOtherDataIsTakenWhereNobodyElseIs) {
    openWith(1);
    registry_.markDead(ids_[0], "test", Registry::Clock::now());
    auto successor = std::make_shared<FakeRenderer>(layers_);
    successor->files = {{123, 0xabc}};
    add(successor);
    awaitReady({successor});
    expectWholePicture();
}

}  // namespace
}  // namespace eyrie::coordinator
