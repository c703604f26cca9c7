// SPDX-License-Identifier: Apache-2.0
// Frames that several renderers draw as they are free, and frames of several views.
#include <algorithm>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coordinator/config/eqc_reader.h"
#include "coordinator/frame/frame_pipeline.h"
#include "fake_renderer.h"
#include "tests/service/eventually.h"

namespace eyrie::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kWidth = 41;
constexpr int kHeight = 23;

config::Configuration read(const std::string& text) {
    config::Findings findings;
    config::Configuration configuration = config::readEqc(text, findings);
    EXPECT_FALSE(findings.hasErrors()) << describe(findings, "test");
    return configuration;
}

std::string pipes(int count) {
    std::string text;
    for (int i = 0; i < count; ++i)
        text += fmt::format(
            "pipe {{ window {{ viewport [ 0 0 64 48 ] channel {{ name \"{}\" }} }} }} ", i);
    return text;
}

/// Three pipes that share a picture's tiles, or chunks of its data.
config::Configuration queued(const std::string& size) {
    return read("config { appNode { " + pipes(3) +
                "} layout { view {} } canvas { layout 0 segment { channel \"0\" } } "
                "compound { channel ( segment 0 view 0 ) buffer [ COLOR DEPTH ] "
                "outputtiles { name \"q\" size " +
                size +
                " } "
                "compound { inputtiles { name \"q\" } } "
                "compound { channel \"1\" inputtiles { name \"q\" } outputframe { } } "
                "compound { channel \"2\" inputtiles { name \"q\" } outputframe { } } "
                "inputframe { name \"frame.1\" } inputframe { name \"frame.2\" } } }");
}

/// Six walls around the head, of which pipes have every fourth; each is seen by two eyes.
config::Configuration cave() {
    struct Wall {
        const char* bottomLeft;
        const char* bottomRight;
        const char* topLeft;
    };
    constexpr Wall kWalls[] = {
        {"-1 -1 -1", "1 -1 -1", "-1 1 -1"}, {"1 -1 -1", "1 -1 1", "1 1 -1"},
        {"1 -1 1", "-1 -1 1", "1 1 1"},     {"-1 -1 1", "-1 -1 -1", "-1 1 1"},
        {"-1 -1 1", "1 -1 1", "-1 -1 -1"},  {"-1 1 -1", "1 1 -1", "-1 1 1"}};
    std::string windows;
    for (int pipe = 0; pipe < 4; ++pipe) {
        windows += "pipe { ";
        for (int wall = pipe; wall < 6; wall += 4)
            windows +=
                fmt::format("window {{ viewport [ 0 0 64 48 ] channel {{ name \"{}\" }} }} ", wall);
        windows += "} ";
    }
    std::string canvases;
    for (int i = 0; i < 6; ++i)
        canvases += fmt::format(
            "canvas {{ layout 0 wall {{ bottom_left [ {} ] bottom_right [ {} ] top_left [ {} ] }} "
            "segment {{ channel \"{}\" }} }} ",
            kWalls[i].bottomLeft, kWalls[i].bottomRight, kWalls[i].topLeft, i);
    return read("config { appNode { " + windows +
                "} observer { eye_base .2 } layout { view { observer 0 mode STEREO } } " +
                canvases + "}");
}

class SharedFrames : public testing::Test {
protected:
    void open(config::Configuration configuration, int renderers,
              milliseconds patience = seconds(50)) {
        FramePipelineOptions options;
        options.configuration = std::move(configuration);
        options.patience = {patience, patience, 3};
        options.callTimeouts.interactive = seconds(60);
        pipeline_ = std::make_unique<FramePipeline>(registry_, std::move(options));
        fabric::Scene scene;
        scene.background = LayeredScene::kBackground;
        scene.objects.push_back({"a", fabric::ObjectKind::Mesh, "a.eym", fabric::Mat4(1.0), {}});
        pipeline_->setScene(scene);
        for (int i = 0; i < renderers; ++i) {
            renderers_.push_back(std::make_shared<FakeRenderer>(layers_));
            const std::string address = fmt::format("fake:{}", i);
            const auto id = registry_.add(address, {"", address, "", "", true}, renderers_.back(),
                                          Registry::Clock::now());
            ASSERT_TRUE(id.ok()) << id.status();
            ids_.push_back(*id);
        }
        ASSERT_TRUE(eventually([&] {
            const Status status = pipeline_->status();
            return std::ranges::count(status.renderers, RendererCondition::Ready,
                                      &RendererStatus::condition) == renderers;
        }));
    }
    static FrameRequest request() {
        FrameRequest request;
        request.width = kWidth;
        request.height = kHeight;
        request.wantsDepth = true;
        return request;
    }
    void expectWholePicture() {
        const absl::StatusOr<RenderedFrame> frame = pipeline_->renderFrame(request());
        ASSERT_TRUE(frame.ok()) << frame.status();
        EXPECT_TRUE(frame->image == layers_->whole(kWidth, kHeight));
    }
    int drawn() const {
        int sum = 0;
        for (const auto& renderer : renderers_) sum += renderer->drawn;
        return sum;
    }

    std::shared_ptr<const LayeredScene> layers_ =
        std::make_shared<LayeredScene>(4711, kWidth, kHeight);
    Registry registry_;
    std::vector<std::shared_ptr<FakeRenderer>> renderers_;
    std::vector<std::string> ids_;
    std::unique_ptr<FramePipeline> pipeline_;
};

class QueueOf : public SharedFrames, public testing::WithParamInterface<const char*> {};

INSTANTIATE_TEST_SUITE_P(Size, QueueOf, testing::Values("[ 8 8 ]", ".05"), [](const auto& of) {
    return std::string(of.param[0] == '[' ? "Tiles" : "Chunks");
});

TEST_P(QueueOf, MakesTheSinglePictureWithAnyNumberOfRenderers) {
    open(queued(GetParam()), 2);
    for (int i = 0; i < 3; ++i) expectWholePicture();
}

TEST_P(QueueOf, GivesWorkToWhoeverIsFree) {
    open(queued(GetParam()), 3);
    renderers_[1]->hang(true);
    auto frame =
        std::async(std::launch::async, [this] { return pipeline_->renderFrame(request()); });
    const int tiles = GetParam()[0] == '[' ? 18 : 20;
    // The others draw all but the one that it holds, and only then wait for it.
    EXPECT_TRUE(eventually([&] { return drawn() == tiles - 1; }));
    EXPECT_EQ(renderers_[1]->begun, 1);
    renderers_[1]->hang(false);
    const auto result = frame.get();
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_TRUE(result->image == layers_->whole(kWidth, kHeight));
    EXPECT_EQ(renderers_[1]->drawn, 1);
    EXPECT_EQ(drawn(), tiles);
}

TEST_P(QueueOf, ASlowRendererGetsFewer) {
    open(queued(GetParam()), 3);
    renderers_[2]->takes = milliseconds(600);
    expectWholePicture();
    // Of about 20; how the others share theirs is the scheduler's.
    EXPECT_GE(renderers_[2]->drawn, 1);
    EXPECT_LE(renderers_[2]->drawn, 3);
}

TEST_P(QueueOf, WhatADyingRendererHadIsDrawnByTheOthers) {
    open(queued(GetParam()), 3);
    renderers_[0]->hang(true);
    std::jthread killer([&] {
        EXPECT_TRUE(eventually([&] { return renderers_[0]->begun > 0; }));
        registry_.markDead(ids_[0], "killed", Registry::Clock::now());
    });
    expectWholePicture();
    killer.join();
    EXPECT_EQ(renderers_[0]->drawn, 0);
    for (int i = 0; i < 3; ++i) expectWholePicture();
}

TEST_F(SharedFrames, AStoppedRendererOfAQueueIsNotWaitedFor) {
    open(queued("[ 8 8 ]"), 3, milliseconds(100));
    expectWholePicture();
    renderers_[2]->hang(true);
    for (int i = 0; i < 3; ++i) expectWholePicture();
    renderers_[2]->hang(false);
}

std::vector<Shown> allViews() {
    std::vector<Shown> views;
    for (int wall = 0; wall < 6; ++wall)
        for (const compound::Eye eye : {compound::Eye::Left, compound::Eye::Right})
            views.push_back({fmt::format("{}", wall), "0", eye, compound::Stereo::Configured});
    return views;
}

TEST_F(SharedFrames, OfACaveAreTwelveViewsOfOneVersionOfTheFrameData) {
    open(cave(), 4);
    FrameRequest all = request();
    all.shown = allViews();
    const auto frame = pipeline_->renderFrame(all);
    ASSERT_TRUE(frame.ok()) << frame.status();
    ASSERT_EQ(frame->further.size(), 11U);
    EXPECT_EQ(drawn(), 12);
    for (const auto& renderer : renderers_)
        EXPECT_EQ(renderer->versions, (std::vector<std::uint64_t>{1}));
    // Walls 0 and 4, and 1 and 5, are of one pipe.
    for (int i = 0; i < 4; ++i)
        EXPECT_EQ(renderers_[static_cast<std::size_t>(i)]->drawn, i < 2 ? 4 : 2);
    std::size_t different = 0;
    for (std::size_t i = 0; i < all.shown.size(); ++i) {
        FrameRequest one = request();
        one.shown = {all.shown[i]};
        const auto single = pipeline_->renderFrame(one);
        ASSERT_TRUE(single.ok()) << single.status();
        EXPECT_TRUE((i == 0 ? frame->image : frame->further[i - 1]) == single->image) << i;
        different += single->image == frame->image ? 0 : 1;
    }
    EXPECT_GE(different, 6U) << "no eye sees what the other does";
    for (const auto& renderer : renderers_)
        EXPECT_EQ(renderer->versions.size(), 1U) << "nothing was changed in between";
}

TEST_F(SharedFrames, AreShownAsTheirViewIsSet) {
    ActiveConfiguration active(cave());
    EXPECT_EQ(active.plan(request(), 0, {})->draws.size(), 2U);
    config::ViewState mono;
    mono.isStereo = false;
    ASSERT_TRUE(active.setView("0", "0", mono).ok());
    EXPECT_EQ(active.plan(request(), 1, {})->draws.size(), 1U);
    config::ViewState larger;
    larger.modelUnit = 2;
    larger.stereoMode = config::StereoMode::Passive;
    ASSERT_TRUE(active.setView("0", "0", larger).ok());
    const auto plan = active.plan(request(), 2, {});
    ASSERT_TRUE(plan.ok()) << plan.status();
    EXPECT_EQ(plan->pictures.size(), 2U) << "not an anaglyph";
    ASSERT_EQ(plan->draws.size(), 2U);
    EXPECT_NEAR(plan->draws[0].task.sight.value_or(fabric::Sight{}).eye.x, -.2, 1e-12);
    ASSERT_TRUE(active.setView("0", "0", {}).ok());
    EXPECT_EQ(active.plan(request(), 3, {})->pictures.size(), 1U);
    EXPECT_FALSE(active.setView("attic", "0", {}).ok());
}

TEST_F(SharedFrames, AreBalancedAsTheirEqualizerIsTuned) {
    ActiveConfiguration active(
        read("config { appNode { " + pipes(2) +
             "} layout { view {} } canvas { layout 0 segment { channel \"0\" } } "
             "compound { channel ( segment 0 view 0 ) load_equalizer { } compound { } "
             "compound { channel \"1\" outputframe { } } inputframe { name \"frame.1\" } } }"));
    equalizer::Tuning tuning;
    tuning.damping = .25;
    ASSERT_TRUE(active.tune("load.0", tuning).ok());
    tuning = {};
    tuning.isFrozen = true;
    ASSERT_TRUE(active.tune("0", tuning).ok());
    EXPECT_EQ(active.equalizers()[0].settings.damping, .25);
    EXPECT_TRUE(active.equalizers()[0].isFrozen);
    EXPECT_EQ(active.state().equalizers[0].damping, .25);
    EXPECT_EQ(active.state().equalizers[0].isFrozen, true);
    tuning = {};
    tuning.framerate = 30;
    EXPECT_FALSE(active.tune("0", tuning).ok());
    EXPECT_FALSE(active.state().equalizers[0].framerate);
}

}  // namespace
}  // namespace eyrie::coordinator
