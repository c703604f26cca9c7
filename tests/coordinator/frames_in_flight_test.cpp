// SPDX-License-Identifier: Apache-2.0
// Several frames under way at once: who draws what when is told by counts, never by a clock.
#include <atomic>
#include <future>
#include <thread>

#include <gmock/gmock.h>

#include "coordinator/config/eqc_reader.h"
#include "frame_pipeline_fixture.h"

namespace eyrie::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Renderers = std::vector<std::shared_ptr<FakeRenderer>>;

/// A frame that somebody asked for, on a thread of its own.
class Asked {
public:
    Asked(FramePipeline& pipeline, const FrameRequest& request)
        : answer_(std::async(std::launch::async, [this, &pipeline, request] {
              auto frame = pipeline.renderLatest([&] {
                  hasBegun_ = true;
                  return request;
              });
              isThere_ = true;
              return frame;
          })) {}

    bool begins() const {
        return eventually([this] { return hasBegun_.load(); });
    }
    /// Long enough that one that may begin, or is there, would have told.
    bool staysOut() const {
        std::this_thread::sleep_for(milliseconds(50));
        return !hasBegun_;
    }
    bool isKeptBack() const {
        std::this_thread::sleep_for(milliseconds(50));
        return !isThere_;
    }
    absl::StatusOr<RenderedFrame> get() { return answer_.get(); }

private:
    std::atomic<bool> hasBegun_{false};
    std::atomic<bool> isThere_{false};
    std::future<absl::StatusOr<RenderedFrame>> answer_;
};

/// No part is taken for lost and drawn by another.
class FramesInFlight : public FramePipelineTest {
protected:
    FramesInFlight() = default;
    explicit FramesInFlight(const FramePipelineOptions& options) : FramePipelineTest(options) {}

    Asked ask() { return {pipeline_, request()}; }
    /// Their counts begin at nothing.
    Renderers openFresh(int count) {
        const Renderers renderers = openWith(count);
        for (const auto& renderer : renderers) renderer->begun = renderer->drawn = 0;
        return renderers;
    }
    static bool haveDrawn(const Renderers& renderers, int times) {
        return eventually([&] {
            return std::ranges::all_of(
                renderers, [&](const auto& renderer) { return renderer->drawn == times; });
        });
    }
    static bool begins(const FakeRenderer& renderer, int times) {
        return eventually([&] { return renderer.begun == times; });
    }
    void expectWhole(Asked& asked) {
        const absl::StatusOr<RenderedFrame> frame = asked.get();
        ASSERT_TRUE(frame.ok()) << frame.status();
        EXPECT_TRUE(frame->image == layers_->whole(kWidth, kHeight));
    }
};

INSTANTIATE_TEST_SUITE_P(Of, FramesInFlight, testing::Values("2D", "DB dynamic"),
                         [](const auto& of) { return test::identifier(of.param); });

TEST_P(FramesInFlight, TheNextIsDrawnWhilePicturesAreOnTheirWay) {
    const Renderers renderers = openFresh(2);
    for (const auto& renderer : renderers) renderer->holdPictures(true);
    Asked first = ask();
    ASSERT_TRUE(haveDrawn(renderers, 1));
    Asked second = ask();
    ASSERT_TRUE(haveDrawn(renderers, 2));
    Asked third = ask();
    EXPECT_TRUE(third.staysOut()) << "as many are under way as the latency, and one";
    for (const auto& renderer : renderers) renderer->holdPictures(false);
    for (Asked* each : {&first, &second, &third}) expectWhole(*each);
    for (const auto& renderer : renderers) EXPECT_EQ(renderer->most, 1);
}

TEST_P(FramesInFlight, NoneBeginsWhileAllAreDrawing) {
    const Renderers renderers = openFresh(2);
    for (const auto& renderer : renderers) renderer->hang(true);
    Asked first = ask();
    ASSERT_TRUE(begins(*renderers[0], 1) && begins(*renderers[1], 1));
    Asked second = ask();
    EXPECT_TRUE(second.staysOut()) << "its view would only be older";
    renderers[1]->hang(false);
    EXPECT_TRUE(second.begins()) << "one of them has nothing to do";
    ASSERT_TRUE(eventually([&] { return renderers[1]->drawn == 2; }));
    renderers[0]->hang(false);
    expectWhole(first);
    expectWhole(second);
    EXPECT_EQ(renderers[0]->drawn, 2) << "each draws its own share, however long it takes";
}

TEST_P(FramesInFlight, PartsOfOneFrameHaveOneVersionOfItsData) {
    const Renderers renderers = openFresh(3);
    std::atomic<int> whole{0};
    {
        std::vector<std::jthread> viewers;
        for (int viewer = 0; viewer < 3; ++viewer)
            viewers.emplace_back([&, viewer] {
                for (int i = 0; i < 20; ++i) {
                    FrameRequest mine = request();
                    mine.camera.eye.x = 1 + viewer + i * 0.1;
                    const auto frame = pipeline_.renderFrame(mine);
                    whole += frame.ok() && frame->image == layers_->whole(kWidth, kHeight) ? 1 : 0;
                }
            });
    }
    EXPECT_EQ(whole, 60);
    for (const auto& renderer : renderers) {
        EXPECT_EQ(renderer->most, 1);
        EXPECT_TRUE(std::ranges::is_sorted(renderer->frames));
        for (const auto& [frame, version] : renderer->tasks) {
            const auto same = renderers[0]->tasks.find(frame);
            EXPECT_TRUE(same == renderers[0]->tasks.end() || same->second == version) << frame;
        }
    }
}

TEST_P(FramesInFlight, OneThatIsNotWantedAnyMoreIsNotDrawn) {
    const Renderers renderers = openFresh(2);
    const absl::Status status =
        pipeline_.renderLatest([]() -> std::optional<FrameRequest> { return std::nullopt; })
            .status();
    EXPECT_TRUE(absl::IsCancelled(status)) << status;
    EXPECT_EQ(renderers[0]->begun, 0);
    expectWholePicture();
}

TEST_P(FramesInFlight, OneThatIsGivenUpBeforeItsTurnDoesNotWaitForOthers) {
    const Renderers renderers = openFresh(2);
    for (const auto& renderer : renderers) renderer->hang(true);
    Asked first = ask();
    ASSERT_TRUE(begins(*renderers[0], 1) && begins(*renderers[1], 1));
    std::stop_source stop;
    std::atomic<bool> isChosen{false};
    auto given = std::async(std::launch::async, [&] {
        return pipeline_
            .renderLatest(
                [&]() -> std::optional<FrameRequest> {
                    isChosen = true;
                    return request();
                },
                stop.get_token())
            .status();
    });
    std::this_thread::sleep_for(milliseconds(50));  // it is in line
    stop.request_stop();
    const absl::Status status = given.get();
    EXPECT_TRUE(absl::IsCancelled(status)) << status;
    EXPECT_FALSE(isChosen);
    EXPECT_TRUE(first.isKeptBack());
    for (const auto& renderer : renderers) renderer->hang(false);
    expectWhole(first);
}

TEST_P(FramesInFlight, ARendererThatDiesWithTwoOfThemIsReplacedInBoth) {
    const Renderers renderers = openFresh(3);
    renderers[1]->holdPictures(true);
    Asked first = ask();
    ASSERT_TRUE(haveDrawn(renderers, 1));
    renderers[1]->hang(true);
    Asked second = ask();
    ASSERT_TRUE(begins(*renderers[1], 2));
    registry_.markDead(ids_[1], "killed", Registry::Clock::now());
    expectWhole(first);
    expectWhole(second);
    EXPECT_FALSE(isAlive(1));
    expectWholePicture();
}

TEST_P(FramesInFlight, WithoutARendererLeftAllFailAndTheNextSaysWhatToDo) {
    const Renderers renderers = openFresh(1);
    renderers[0]->holdPictures(true);
    Asked first = ask();
    ASSERT_TRUE(haveDrawn(renderers, 1));
    Asked second = ask();
    ASSERT_TRUE(begins(*renderers[0], 2));
    registry_.markDead(ids_[0], "killed", Registry::Clock::now());
    EXPECT_TRUE(absl::IsUnavailable(first.get().status()));
    EXPECT_TRUE(absl::IsUnavailable(second.get().status()));
    EXPECT_THAT(std::string(pipeline_.renderFrame(request()).status().message()),
                testing::HasSubstr("eyrie renderer --coordinator"));
}

/// A configuration of that latency whose renderers take whole frames in turn, with `equalizer`.
FramePipelineOptions inTurn(int renderers, int latency, const std::string& equalizer = "") {
    std::string pipes;
    std::string children;
    for (int i = 0; i < renderers; ++i) {
        pipes += fmt::format("pipe {{ {}window {{ channel {{ name \"c{}\" }} }} }}\n",
                             i == 0 ? "window { channel { name \"shown\" } } " : "", i);
        children += fmt::format(
            "compound {{ channel \"c{}\" phase {} period {} outputframe {{ name \"f\" }} }}\n", i,
            i, renderers);
    }
    config::Findings findings;
    FramePipelineOptions options;
    options.configuration = config::readEqc(
        fmt::format(
            "server {{ config {{ latency {} appNode {{ {} }} layout {{ view {{ }} }}\n"
            "canvas {{ layout 0 segment {{ channel \"shown\" }} }}\n"
            "compound {{ channel ( segment 0 view 0 ) {} {} inputframe {{ name \"f\" }} }} }} }}",
            latency, pipes, equalizer, children),
        findings);
    options.patience = {seconds(50), seconds(50), 3};
    return options;
}

/// The parameter is a number of renderers that take frames in turn.
template <int Latency>
class TimeMultiplexed : public FramesInFlight {
protected:
    explicit TimeMultiplexed(const std::string& equalizer = "")
        : FramesInFlight(inTurn(std::stoi(GetParam()), Latency, equalizer)) {}

    /// Without depth, which the configuration's frames do not have.
    static FrameRequest request() {
        FrameRequest request = FramePipelineTest::request();
        request.wantsDepth = false;
        return request;
    }
    /// All have the scene open.
    Renderers open() {
        pipeline_.setScene(sceneNamed("first"));
        Renderers renderers;
        for (int i = 0; i < std::stoi(GetParam()); ++i) renderers.push_back(addRenderer());
        EXPECT_TRUE(eventually([&] {
            return std::ranges::all_of(pipeline_.status().renderers, [](const auto& each) {
                return each.condition == RendererCondition::Ready;
            });
        }));
        EXPECT_TRUE(pipeline_.renderFrame(request()).ok());  // by c1
        for (const auto& renderer : renderers) renderer->begun = 0;
        return renderers;
    }
    void expectColours(Asked& asked) {
        const absl::StatusOr<RenderedFrame> frame = asked.get();
        ASSERT_TRUE(frame.ok()) << frame.status();
        EXPECT_TRUE(frame->image.colour == layers_->whole(kWidth, kHeight).colour);
    }
};

using InTurn = TimeMultiplexed<2>;
INSTANTIATE_TEST_SUITE_P(Of, InTurn, testing::Values("2", "3"),
                         [](const auto& of) { return "By" + of.param; });

TEST_P(InTurn, EachRendererIsDrawingAFrameOfItsOwn) {
    const Renderers renderers = open();
    for (const auto& renderer : renderers) renderer->hang(true);
    std::vector<std::unique_ptr<Asked>> frames;
    for (std::size_t i = 0; i < renderers.size(); ++i)
        frames.push_back(std::make_unique<Asked>(pipeline_, request()));
    for (const auto& renderer : renderers) EXPECT_TRUE(begins(*renderer, 1));
    for (const auto& renderer : renderers) renderer->hang(false);
    for (const auto& frame : frames) expectColours(*frame);
}

TEST_P(InTurn, ItIsSaidHowManyRenderersOfTheConfigurationAreMissing) {
    const std::size_t wanted = open().size();
    EXPECT_EQ(pipeline_.status().note, "");
    registry_.markDead(ids_[0], "killed", Registry::Clock::now());
    EXPECT_THAT(pipeline_.status().note,
                testing::StartsWith(fmt::format("{} of the {} renderers", wanted - 1, wanted)));
    addRenderer();
    EXPECT_TRUE(eventually([&] { return pipeline_.status().note.empty(); }));
}

TEST_P(InTurn, AFrameIsNotShownBeforeTheOneBeforeIt) {
    const Renderers renderers = open();
    FakeRenderer& slow = *renderers[2 % renderers.size()];  // frame 2 is its
    slow.hang(true);
    Asked first(pipeline_, request());
    ASSERT_TRUE(begins(slow, 1));
    FakeRenderer& next = *renderers[3 % renderers.size()];
    const int drawn = next.drawn;
    Asked second(pipeline_, request());
    ASSERT_TRUE(eventually([&] { return next.drawn == drawn + 1; }));
    EXPECT_TRUE(second.isKeptBack());
    slow.hang(false);
    expectColours(first);
    expectColours(second);
}

class AtASteadyRate : public TimeMultiplexed<2> {
protected:
    AtASteadyRate() : TimeMultiplexed("framerate_equalizer { }") {}
};
INSTANTIATE_TEST_SUITE_P(Of, AtASteadyRate, testing::Values("2"),
                         [](const auto& of) { return "By" + of.param; });

/// Renderers say that they take 200 ms, and take none: without the equalizer all frames would be
/// there at once. By two of them one may begin every 105 ms.
TEST_P(AtASteadyRate, FramesBeginAtThePeriodsShareOfWhatOneTakes) {
    const Renderers renderers = open();
    for (const auto& renderer : renderers) renderer->millisecondsAFrame = 200;
    EXPECT_TRUE(pipeline_.renderFrame(request()).ok());
    EXPECT_TRUE(pipeline_.renderFrame(request()).ok());
    const auto begun = std::chrono::steady_clock::now();
    for (int frame = 0; frame < 4; ++frame) EXPECT_TRUE(pipeline_.renderFrame(request()).ok());
    EXPECT_GE(std::chrono::steady_clock::now() - begun, 3 * milliseconds(105));
}

using OneAtATime = TimeMultiplexed<0>;
INSTANTIATE_TEST_SUITE_P(Of, OneAtATime, testing::Values("2"),
                         [](const auto& of) { return "By" + of.param; });

TEST_P(OneAtATime, WithoutLatencyNoFrameBeginsBeforeTheLastIsThere) {
    const Renderers renderers = open();
    for (const auto& renderer : renderers) renderer->holdPictures(true);
    Asked first(pipeline_, request());
    ASSERT_TRUE(first.begins());
    Asked second(pipeline_, request());
    EXPECT_TRUE(second.staysOut());
    for (const auto& renderer : renderers) renderer->holdPictures(false);
    expectColours(first);
    expectColours(second);
}

}  // namespace
}  // namespace eyrie::coordinator
