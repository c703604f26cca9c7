// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/frame_pipeline.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <random>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "fake_renderer.h"
#include "tests/service/eventually.h"
#include "tests/support/identifier.h"

namespace eyrie::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class FramePipelineTest : public testing::TestWithParam<std::string> {
protected:
    static constexpr int kWidth = 41;
    static constexpr int kHeight = 23;

    explicit FramePipelineTest(milliseconds patience = milliseconds(100))
        : pipeline_(registry_, options(GetParam(), patience)) {}

    static FramePipelineOptions options(const std::string& layout, milliseconds patience) {
        FramePipelineOptions options;
        options.layout = layout;
        options.patience = {patience, patience, 3};
        options.callTimeout = seconds(60);
        return options;
    }
    static fabric::Scene sceneNamed(const std::string& name) {
        fabric::Scene scene;
        scene.background = LayeredScene::kBackground;
        scene.objects.push_back({name, fabric::ObjectKind::Mesh, "a.eym", fabric::Mat4(1.0), {}});
        return scene;
    }
    static FrameRequest request() {
        FrameRequest request;
        request.width = kWidth;
        request.height = kHeight;
        request.wantsDepth = true;
        return request;
    }

    std::shared_ptr<FakeRenderer> addRenderer() {
        auto renderer = std::make_shared<FakeRenderer>(layers_);
        add(renderer);
        return renderer;
    }
    void add(const std::shared_ptr<FakeRenderer>& renderer) {
        const std::string address = fmt::format("fake:{}", ++added_);
        ids_.push_back(
            registry_.add(address, {"", address, "", "", true}, renderer, Registry::Clock::now())
                .value());
    }
    std::vector<std::shared_ptr<FakeRenderer>> openWith(int renderers) {
        pipeline_.setScene(sceneNamed("first"));
        std::vector<std::shared_ptr<FakeRenderer>> result;
        for (int i = 0; i < renderers; ++i) result.push_back(addRenderer());
        awaitReady(result);
        return result;
    }
    /// All are ready once a frame has used all.
    void awaitReady(const std::vector<std::shared_ptr<FakeRenderer>>& renderers) {
        EXPECT_TRUE(eventually([&] {
            for (const auto& renderer : renderers) renderer->drawn = 0;
            return pipeline_.renderFrame(request()).ok() &&
                   std::all_of(renderers.begin(), renderers.end(),
                               [](const auto& renderer) { return renderer->drawn == 1; });
        }));
    }
    void expectWholePicture() {
        const absl::StatusOr<RenderedFrame> frame = pipeline_.renderFrame(request());
        ASSERT_TRUE(frame.ok()) << frame.status();
        EXPECT_TRUE(frame->image == layers_->whole(kWidth, kHeight));
    }
    RendererStatus statusOf(int renderer) const {
        for (const RendererStatus& status : pipeline_.status().renderers)
            if (status.id == ids_[static_cast<std::size_t>(renderer)])
                return status;
        RendererStatus gone;
        gone.condition = RendererCondition::Dead;
        return gone;
    }
    bool isAlive(int renderer) const { return statusOf(renderer).isAlive(); }

    std::shared_ptr<const LayeredScene> layers_ = std::make_shared<LayeredScene>(4711);
    Registry registry_;
    FramePipeline pipeline_;
    std::vector<std::string> ids_;
    int added_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Of, FramePipelineTest, testing::Values("2D", "DB dynamic"),
                         [](const auto& of) { return test::identifier(of.param); });

TEST_P(FramePipelineTest, AnyNumberOfRenderersMakesTheSinglePicture) {
    for (int count = 1; count <= 4; ++count) {
        openWith(1);  // one more
        expectWholePicture();
    }
}

TEST_P(FramePipelineTest, AllReadyRenderersTakePart) {
    const auto renderers = openWith(3);
    expectWholePicture();
    for (const auto& renderer : renderers) EXPECT_EQ(renderer->drawn, 2);
}

TEST_P(FramePipelineTest, PicturesGetSmallerWhereNoErrorKeepsTheirTime) {
    openWith(2);
    FrameRequest timed = request();
    timed.budgetMilliseconds = 1;
    const auto first = pipeline_.renderFrame(timed);
    ASSERT_TRUE(first.ok()) << first.status();
    ASSERT_TRUE(first->statistics.budget.has_value());
    EXPECT_EQ(first->statistics.budget->milliseconds, 1);
    EXPECT_EQ(first->statistics.budget->tauPixels, fabric::kBudgetTauPixels);
    for (int i = 0; i < 3; ++i) (void)pipeline_.renderFrame(timed);
    const auto later = pipeline_.renderFrame(timed);
    ASSERT_TRUE(later.ok()) << later.status();
    EXPECT_FALSE(later->statistics.budget->isMet());
    const fabric::PixelViewport area = later->image.area;
    EXPECT_LT(area.width, kWidth);
    EXPECT_TRUE(later->image == layers_->whole(area.width, area.height));
    expectWholePicture();  // without a time to keep
}

TEST_P(FramePipelineTest, ATimeThatIsNoneIsRefused) {
    openWith(1);
    FrameRequest timed = request();
    timed.budgetMilliseconds = 0;
    EXPECT_TRUE(absl::IsInvalidArgument(pipeline_.renderFrame(timed).status()));
}

TEST_P(FramePipelineTest, AFailedPartIsDrawnByAnother) {
    const auto renderers = openWith(3);
    renderers[1]->failToRender(absl::UnavailableError("connection reset"));
    expectWholePicture();
    EXPECT_FALSE(isAlive(1));
    EXPECT_TRUE(isAlive(0));
    expectWholePicture();
}

TEST_P(FramePipelineTest, APartThatHangsIsDrawnByAnother) {
    const auto renderers = openWith(3);
    renderers[0]->hang(true);
    expectWholePicture();
    EXPECT_TRUE(isAlive(0));
    const int begun = renderers[0]->begun;
    expectWholePicture();
    EXPECT_EQ(renderers[0]->begun, begun);  // it sits out while it is busy
    renderers[0]->hang(false);
    EXPECT_TRUE(eventually([&] {
        expectWholePicture();
        return renderers[0]->begun > begun;
    }));
}

TEST_P(FramePipelineTest, ARendererThatDiesMidFrameIsReplaced) {
    const auto renderers = openWith(2);
    renderers[1]->hang(true);
    const int begun = renderers[1]->begun;
    std::jthread killer([&] {
        EXPECT_TRUE(eventually([&] { return renderers[1]->begun > begun; }));
        registry_.markDead(ids_[1], "no heartbeat", Registry::Clock::now());
    });
    expectWholePicture();
    EXPECT_FALSE(isAlive(1));
}

TEST_P(FramePipelineTest, ADeadOnesSuccessorTakesPart) {
    openWith(2);
    registry_.markDead(ids_[0], "test", Registry::Clock::now());
    expectWholePicture();
    const auto successor = addRenderer();
    EXPECT_TRUE(eventually([&] {
        expectWholePicture();
        return successor->drawn > 0;
    }));
}

TEST_P(FramePipelineTest, WithoutAnyRendererLeftItIsUnavailableAndSaysWhatToDo) {
    const auto renderers = openWith(2);
    for (const auto& renderer : renderers)
        renderer->failToRender(absl::UnavailableError("connection reset"));
    EXPECT_EQ(pipeline_.renderFrame(request()).status().code(), absl::StatusCode::kUnavailable);
    const absl::Status next = pipeline_.renderFrame(request()).status();
    EXPECT_EQ(next.code(), absl::StatusCode::kUnavailable);
    EXPECT_THAT(std::string(next.message()), testing::HasSubstr("eyrie renderer --coordinator"));
    EXPECT_EQ(pipeline_.status().problem, std::string(next.message()));
}

TEST_P(FramePipelineTest, ATaskThatEveryRendererRefusesIsAnErrorAndNobodysDeath) {
    const auto renderers = openWith(2);
    for (const auto& renderer : renderers)
        renderer->failToRender(absl::ResourceExhaustedError("no memory for the picture"));
    const absl::Status status = pipeline_.renderFrame(request()).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
    EXPECT_TRUE(isAlive(0) && isAlive(1));
}

TEST_P(FramePipelineTest, FrameDataIsSentOnceAVersion) {
    const auto renderers = openWith(2);
    ASSERT_TRUE(pipeline_.renderFrame(request()).ok());
    const std::size_t sent = renderers[0]->versions.size();
    ASSERT_TRUE(pipeline_.renderFrame(request()).ok());
    EXPECT_EQ(renderers[0]->versions.size(), sent);
    FrameRequest moved = request();
    moved.camera.eye.x += 1;
    ASSERT_TRUE(pipeline_.renderFrame(moved).ok());
    ASSERT_EQ(renderers[0]->versions.size(), sent + 1);
    EXPECT_GT(renderers[0]->versions[sent], renderers[0]->versions[sent - 1]);
}

TEST_P(FramePipelineTest, StatisticsAreTheWholeFrames) {
    openWith(1);
    const auto frame = pipeline_.renderFrame(request());
    ASSERT_TRUE(frame.ok());
    EXPECT_EQ(frame->statistics.nodes, 30U);
    EXPECT_EQ(frame->statistics.tauAskedPixels, 1);
    EXPECT_GT(frame->statistics.milliseconds.total, 0);
    EXPECT_EQ(frame->device.renderer, "fake:1");
}

TEST_P(FramePipelineTest, ARequestOutOfRangeIsRefused) {
    openWith(1);
    FrameRequest wide = request();
    wide.width = fabric::kMaxViewPixels + 1;
    FrameRequest fine = request();
    fine.tauPixels = 0;
    FrameRequest blind = request();
    blind.camera.target = blind.camera.eye;
    for (const FrameRequest& bad : {wide, fine, blind})
        EXPECT_EQ(pipeline_.renderFrame(bad).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST_P(FramePipelineTest, APartOfThePictureIsTheWholePicturesPart) {
    openWith(3);
    FrameRequest part = request();
    part.part = {7, 3, 20, 11};
    const auto frame = pipeline_.renderFrame(part);
    ASSERT_TRUE(frame.ok()) << frame.status();
    EXPECT_EQ(frame->image.area, part.part);
    fabric::Image whole = layers_->whole(kWidth, kHeight);
    fabric::paste(frame->image, whole);
    EXPECT_TRUE(whole == layers_->whole(kWidth, kHeight));
    part.part = {30, 3, 20, 11};
    EXPECT_EQ(pipeline_.renderFrame(part).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST_P(FramePipelineTest, StatusSaysWhatIsMissing) {
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

TEST_P(FramePipelineTest, ListenersHearThatThePictureIsThere) {
    std::atomic<bool> ready{false};
    const int handle = pipeline_.subscribe([&] {
        if (pipeline_.status().problem.empty())
            ready = true;
    });
    openWith(1);
    EXPECT_TRUE(eventually([&] { return ready.load(); }));
    pipeline_.unsubscribe(handle);
}

TEST_P(FramePipelineTest, ANewSceneIsOpenedByAll) {
    const auto renderers = openWith(2);
    pipeline_.setScene(sceneNamed("second"));
    awaitReady(renderers);
    expectWholePicture();
    EXPECT_EQ(pipeline_.status().scene.objects[0].name, "second");
    EXPECT_EQ(renderers[0]->opened, (std::vector<std::string>{"first", "second"}));
}

TEST_P(FramePipelineTest, FramesFromSeveralThreadsAreAllWhole) {
    const auto renderers = openWith(3);
    std::atomic<int> whole{0};
    {
        std::vector<std::jthread> viewers;
        for (int viewer = 0; viewer < 4; ++viewer)
            viewers.emplace_back([&, viewer] {
                for (int i = 0; i < 25; ++i) {
                    FrameRequest mine = request();
                    mine.camera.eye.x = viewer + i * 0.1;
                    const auto frame = pipeline_.renderFrame(mine);
                    whole += frame.ok() && frame->image == layers_->whole(kWidth, kHeight) ? 1 : 0;
                }
            });
    }
    EXPECT_EQ(whole, 100);
}

TEST_P(FramePipelineTest, LatenessIsShownUntilItEnds) {
    const auto renderers = openWith(2);
    renderers[1]->hang(true);
    expectWholePicture();
    EXPECT_EQ(statusOf(1).condition, RendererCondition::Late);
    EXPECT_EQ(statusOf(0).condition, RendererCondition::Ready);
    std::atomic<bool> isOver{false};
    const int handle = pipeline_.subscribe(
        [&] { isOver = isOver || statusOf(1).condition == RendererCondition::Ready; });
    renderers[1]->hang(false);
    EXPECT_TRUE(eventually([&] { return isOver.load(); }));
    pipeline_.unsubscribe(handle);
}

TEST_P(FramePipelineTest, ARendererThatFindsOtherDataIsRefusedWithTheDifference) {
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

TEST_P(FramePipelineTest, TheDifferenceOfDataNamesFileAndSums) {
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
}

TEST_P(FramePipelineTest, OtherDataAreDrawnWhenNobodyIsLeftWithTheFirst) {
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

TEST_P(FramePipelineTest, ASuccessorWithOtherDataIsTakenWhereNobodyElseIs) {
    openWith(1);
    registry_.markDead(ids_[0], "test", Registry::Clock::now());
    auto successor = std::make_shared<FakeRenderer>(layers_);
    successor->files = {{123, 0xabc}};
    add(successor);
    awaitReady({successor});
    expectWholePicture();
}

TEST_P(FramePipelineTest, OneThatDrainsFinishesWhatItHasAndGetsNothingNew) {
    const auto renderers = openWith(2);
    renderers[1]->hang(true);
    const int begun = renderers[1]->begun;
    std::jthread frame([&] { expectWholePicture(); });
    ASSERT_TRUE(eventually([&] { return renderers[1]->begun > begun; }));
    ASSERT_TRUE(registry_.drain(ids_[1], Registry::Clock::now()).ok());
    EXPECT_EQ(statusOf(1).condition, RendererCondition::Draining);
    frame.join();  // its part was late, and drawn by the other
    expectWholePicture();
    EXPECT_EQ(renderers[1]->begun, begun + 1);
    EXPECT_TRUE(registry_.drain(ids_[1], Registry::Clock::now()).ok());
    const int drawn = renderers[1]->drawn;
    renderers[1]->hang(false);
    EXPECT_TRUE(eventually([&] { return pipeline_.status().renderers.size() == 1; }));
    EXPECT_EQ(renderers[1]->drawn, drawn + 1);
    EXPECT_TRUE(absl::IsNotFound(registry_.drain(ids_[1], Registry::Clock::now())));
    expectWholePicture();
}

TEST_P(FramePipelineTest, OneThatDrainsWithNothingToDoIsGoneAtOnce) {
    openWith(2);
    ASSERT_TRUE(registry_.drain(ids_[0], Registry::Clock::now()).ok());
    EXPECT_TRUE(eventually([&] { return pipeline_.status().renderers.size() == 1; }));
    expectWholePicture();
}

/// Without an equalizer, which would give it less and less to do.
TEST_P(FramePipelineTest, ASlowRendererIsGivenThreeTimesWhatItTakes) {
    const auto renderers = openWith(2);
    expectWholePicture();
    ASSERT_TRUE(pipeline_.configure({"0", "DB static"}).ok());
    renderers[1]->takes = milliseconds(40);
    for (int i = 0; i < 15; ++i) expectWholePicture();
    const int begun = renderers[0]->begun;
    renderers[1]->hang(true);
    const auto start = std::chrono::steady_clock::now();
    expectWholePicture();
    EXPECT_GE(std::chrono::steady_clock::now() - start, milliseconds(120));
    EXPECT_EQ(renderers[0]->begun, begun + 2);
    renderers[1]->hang(false);
}

/// Depths of LayeredScene tie all over. No part is taken for lost and drawn by another.
class HardCase13 : public FramePipelineTest {
protected:
    HardCase13() : FramePipelineTest(seconds(50)) {}

    /// Draws a frame, the parts of which come in the order of `renderers`.
    absl::StatusOr<RenderedFrame> framePartByPart(
        const std::vector<std::shared_ptr<FakeRenderer>>& renderers) {
        int begun = 0;
        for (const auto& renderer : renderers) {
            renderer->hang(true);
            begun += renderer->begun;
        }
        auto frame =
            std::async(std::launch::async, [this] { return pipeline_.renderFrame(request()); });
        EXPECT_TRUE(eventually([&] {
            int now = 0;
            for (const auto& renderer : renderers) now += renderer->begun;
            return now == begun + static_cast<int>(renderers.size());
        }));
        for (const auto& renderer : renderers) {
            const int drawn = renderer->drawn;
            renderer->hang(false);
            EXPECT_TRUE(eventually([&] { return renderer->drawn == drawn + 1; }));
        }
        return frame.get();
    }
};

INSTANTIATE_TEST_SUITE_P(Of, HardCase13, testing::Values("DB static"),
                         [](const auto&) { return "Db"; });

TEST_P(HardCase13, PicturesAreTheSameInWhateverOrderTiedPartsArrive) {
    std::mt19937 random(13);
    std::vector<std::shared_ptr<FakeRenderer>> renderers;
    for (const std::size_t count : {2U, 3U, 5U, 8U}) {
        const auto added = openWith(static_cast<int>(count - renderers.size()));
        renderers.insert(renderers.end(), added.begin(), added.end());
        for (int i = 0; i < 25; ++i) {
            std::ranges::shuffle(renderers, random);
            const auto frame = framePartByPart(renderers);
            ASSERT_TRUE(frame.ok()) << frame.status();
            ASSERT_TRUE(frame->image == layers_->whole(kWidth, kHeight)) << count << ", " << i;
        }
    }
}

/// The picture expected is the one that LayeredScene draws by its definition, whole. No part is
/// taken for late, so each renderer draws its own.
class HardCase27 : public FramePipelineTest {
protected:
    HardCase27() : FramePipelineTest(seconds(50)) {}
};

INSTANTIATE_TEST_SUITE_P(Of, HardCase27, testing::Values("2D", "DB dynamic"),
                         [](const auto& of) { return test::identifier(of.param); });

TEST_P(HardCase27, AllInOnePixelIsTheSinglePictureOverEightRenderers) {
    layers_ = std::make_shared<LayeredScene>(27, 1, 1);
    openWith(8);
    expectWholePicture();
}

TEST_P(HardCase27, PartsWithNothingInThemAreBackground) {
    layers_ = std::make_shared<LayeredScene>(27, 41, 23, 1);
    openWith(8);
    expectWholePicture();
}

TEST_P(HardCase27, ARendererTenTimesSlowerGetsATenthAndPicturesStayWhole) {
    const auto renderers = openWith(3);
    for (const auto& renderer : renderers) renderer->millisecondsAFrame = 1000;
    renderers[1]->millisecondsAFrame = 10000;
    for (int i = 0; i < 20; ++i) expectWholePicture();
    // Equal times are shares of 10 : 1 : 10. A column of pixels of 41 is the finest cut in 2D.
    EXPECT_NEAR(renderers[0]->share, 10.0 / 21, 0.04);
    EXPECT_NEAR(renderers[1]->share, 1.0 / 21, 0.03);
    EXPECT_NEAR(renderers[2]->share, 10.0 / 21, 0.04);
}

TEST_P(HardCase27, AfterOneIsKilledMidFrameTheNextFramesAreRightAndTiesAreWonAsBefore) {
    const auto renderers = openWith(3);
    renderers[0]->hang(true);
    const int begun = renderers[0]->begun;
    std::jthread killer([&] {
        EXPECT_TRUE(eventually([&] { return renderers[0]->begun > begun; }));
        registry_.markDead(ids_[0], "killed", Registry::Clock::now());
    });
    for (int i = 0; i < 5; ++i) expectWholePicture();
    EXPECT_FALSE(isAlive(0));
    killer.join();
    openWith(1);
    for (int i = 0; i < 5; ++i) expectWholePicture();
}

TEST_P(FramePipelineTest, PicksAreAskedOfTheNextRendererWhereOneFails) {
    const auto renderers = openWith(3);
    const fabric::PickRequest request{{{1, 2, 3}, {4, 5, 6}}, 640, 480, {20, 30}, 1};
    renderers[0]->failToPick(absl::DeadlineExceededError("its server stalls"));
    renderers[1]->pickedObject = 7;  // the scene has one
    const auto picked = pipeline_.pick(request);
    ASSERT_TRUE(picked.ok() && picked->has_value()) << picked.status();
    EXPECT_EQ((*picked)->worldMetres, fabric::Vec3(20, 30, 0));
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(renderers[static_cast<std::size_t>(i)]->picks, 1);
        EXPECT_TRUE(isAlive(i));
    }
    for (const auto& renderer : renderers)
        renderer->failToPick(absl::DataLossError("page 7 is damaged"));
    EXPECT_TRUE(absl::IsDataLoss(pipeline_.pick(request).status()));
    expectWholePicture();
}

TEST_P(FramePipelineTest, PicksOutsideThePictureOrWithoutASceneAreRefused) {
    fabric::PickRequest request{{{1, 2, 3}, {4, 5, 6}}, 640, 480, {20, 30}, 1};
    EXPECT_TRUE(absl::IsUnavailable(pipeline_.pick(request).status()));
    request.place.x = 641;
    EXPECT_TRUE(absl::IsInvalidArgument(pipeline_.pick(request).status()));
}

}  // namespace
}  // namespace eyrie::coordinator
