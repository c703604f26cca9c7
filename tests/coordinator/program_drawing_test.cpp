// SPDX-License-Identifier: Apache-2.0
// Frames that renderers put together among themselves, and what is done where that fails.
#include "coordinator/frame/program_drawing.h"

#include <atomic>
#include <condition_variable>
#include <future>
#include <map>
#include <mutex>
#include <set>
#include <tuple>

#include "fabric/channel_buffer.h"
#include "fabric/status.h"
#include "frame_pipeline_fixture.h"

namespace eyrie::coordinator {
namespace {

/// What renderers have sent each other: pictures by address, session, frame's and picture's number.
class Post {
public:
    using Key = std::tuple<std::string, std::uint64_t, std::uint64_t, std::uint32_t>;

    void put(const Key& key, fabric::Image image) {
        {
            const std::lock_guard lock(mutex_);
            images_[key] = std::move(image);
        }
        changed_.notify_all();
    }
    absl::StatusOr<fabric::Image> take(const Key& key, ChannelRenderer::Clock::time_point deadline,
                                       const std::stop_token& stop) {
        std::unique_lock lock(mutex_);
        if (changed_.wait_until(lock, stop, deadline, [&] { return images_.contains(key); }))
            return std::move(images_.extract(key).mapped());
        return stop.stop_requested() ? absl::CancelledError("stopped")
                                     : absl::DeadlineExceededError("nothing was sent");
    }

private:
    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::map<Key, fabric::Image> images_;
};

/// Draws a LayeredScene, and carries out programs with others of its kind.
class ExchangingRenderer final : public ChannelRenderer {
public:
    ExchangingRenderer(std::string address, std::shared_ptr<const LayeredScene> scene, Post& post)
        : address_(std::move(address)), scene_(std::move(scene)), post_(post) {}

    absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene&, Clock::time_point) override {
        ++opened;
        return fabric::SceneInfo{{{0, 0, 0}, {1, 1, 1}}, 30, 100, {}, {}};
    }
    absl::Status setFrameData(const fabric::FrameData& frameData, Clock::time_point) override {
        const std::lock_guard lock(mutex_);
        versions_.insert(frameData.version);
        return absl::OkStatus();
    }
    absl::StatusOr<fabric::ChannelResult> render(const fabric::ChannelTask& task,
                                                 Clock::time_point deadline,
                                                 const ChannelNews& news,
                                                 const fabric::FrameData* frameData,
                                                 const std::stop_token&) override {
        if (frameData != nullptr)
            RETURN_IF_ERROR(setFrameData(*frameData, deadline));
        ++channels;
        if (news.drawn)
            news.drawn();
        return scene_->draw(task);
    }
    absl::StatusOr<fabric::ProgramResult> runProgram(const fabric::ChannelProgram& program,
                                                     Clock::time_point deadline,
                                                     const std::stop_token& stop) override {
        ++programs;
        if (fails)
            return absl::InternalError("a disk is full");
        fabric::ProgramResult result;
        fabric::ChannelBuffer buffer(program.area, program.background, program.hasDepth);
        for (const fabric::ProgramStage& stage : program.stages)
            RETURN_IF_ERROR(carryOut(stage, program, deadline, stop, buffer, result));
        std::unique_lock lock(mutex_);
        const bool isAnswered = changed_.wait_until(
            lock, stop, deadline, [this] { return !holdsAnswers_ || cancelled_; });
        if (cancelled_ || stop.stop_requested())
            return absl::CancelledError("cancelled");
        if (!isAnswered)
            return absl::DeadlineExceededError("the answer is held");
        return result;
    }
    absl::StatusOr<fabric::Picked> pick(const fabric::PickRequest&, Clock::time_point) override {
        return fabric::Picked();
    }
    void cancel() override { set(cancelled_, true); }

    /// Those of programs do not arrive before the end of that.
    void holdAnswers(bool holds) { set(holdsAnswers_, holds); }

    std::atomic<int> opened{0};    ///< scenes
    std::atomic<int> channels{0};  ///< drawn one by one
    std::atomic<int> programs{0};  ///< begun
    std::atomic<bool> fails{false};

private:
    absl::Status carryOut(const fabric::ProgramStage& stage, const fabric::ChannelProgram& program,
                          Clock::time_point deadline, const std::stop_token& stop,
                          fabric::ChannelBuffer& buffer, fabric::ProgramResult& result) {
        if (stage.draw) {
            if (!knows(stage.draw->frameDataVersion))
                return absl::FailedPreconditionError("frame data of another version");
            fabric::ChannelResult drawn = scene_->draw(*stage.draw);
            result.draws.push_back(drawn.statistics);
            buffer.put(std::move(drawn.image), stage.draw->pixelViewport,
                       program.hasDepth && stage.draw->wantsDepth ? fabric::Merge::DepthBehind
                                                                  : fabric::Merge::Paste);
        }
        const auto keyOf = [&](const std::string& to, std::uint32_t frame) {
            return Post::Key{to, program.session, program.frameNumber, frame};
        };
        for (const fabric::ProgramInput& input : stage.inputs) {
            ASSIGN_OR_RETURN(fabric::Image image,
                             post_.take(keyOf(address_, input.frame), deadline, stop));
            buffer.put(std::move(image), input.area, input.merge);
        }
        for (const fabric::ProgramOutput& output : stage.outputs) {
            fabric::Image image = buffer.part(output.area, output.withDepth);
            if (output.to.empty())
                result.pictures.push_back({output.frame, std::move(image)});
            else
                post_.put(keyOf(output.to, output.frame), std::move(image));
        }
        return absl::OkStatus();
    }

    bool knows(std::uint64_t version) const {
        const std::lock_guard lock(mutex_);
        return versions_.contains(version);
    }

    void set(bool& variable, bool value) {
        {
            const std::lock_guard lock(mutex_);
            variable = value;
        }
        changed_.notify_all();
    }

    const std::string address_;
    const std::shared_ptr<const LayeredScene> scene_;
    Post& post_;
    mutable std::mutex mutex_;          ///< guards what follows
    std::set<std::uint64_t> versions_;  ///< of the frame data that have come
    std::condition_variable_any changed_;
    bool holdsAnswers_ = false;
    bool cancelled_ = false;
};

class ProgramDrawingTest : public FramePipelineTest {
protected:
    explicit ProgramDrawingTest(std::chrono::milliseconds patience = std::chrono::seconds(20))
        : FramePipelineTest(patience) {}

    using Renderers = std::vector<std::shared_ptr<ExchangingRenderer>>;

    Renderers added(const std::vector<std::string>& addresses) {
        pipeline_.setScene(sceneNamed("first"));
        Renderers renderers;
        for (const std::string& address : addresses) {
            renderers.push_back(std::make_shared<ExchangingRenderer>(address, layers_, post_));
            EXPECT_TRUE(registry_
                            .add(address, {"", address, "", "", true}, renderers.back(),
                                 Registry::Clock::now())
                            .ok());
        }
        return renderers;
    }
    /// Frames are drawn until all renderers have taken part; then begins the count.
    void awaitAll(const Renderers& renderers, std::atomic<int> ExchangingRenderer::*part) {
        EXPECT_TRUE(eventually([&] {
            return pipeline_.renderFrame(request()).ok() &&
                   std::ranges::all_of(renderers,
                                       [&](const auto& one) { return (*one).*part > 0; });
        }));
        for (const auto& one : renderers) one->programs = one->channels = 0;
    }
    /// So many renderers, once all have taken part in programs.
    Renderers exchanging(int count) {
        std::vector<std::string> addresses;
        for (int i = 0; i < count; ++i) addresses.push_back(fmt::format("fake:{}", i));
        Renderers renderers = added(addresses);
        awaitAll(renderers, &ExchangingRenderer::programs);
        return renderers;
    }
    /// A frame for which every renderer has begun its program.
    std::future<absl::StatusOr<RenderedFrame>> begun(const Renderers& renderers) {
        auto frame =
            std::async(std::launch::async, [this] { return pipeline_.renderFrame(request()); });
        EXPECT_TRUE(eventually([&] {
            return std::ranges::all_of(renderers,
                                       [](const auto& one) { return one->programs == 1; });
        }));
        return frame;
    }

    Post post_;
};

INSTANTIATE_TEST_SUITE_P(Of, ProgramDrawingTest, testing::Values("direct-send"),
                         [](const auto& of) { return test::identifier(of.param); });

TEST_P(ProgramDrawingTest, WhatRenderersMergeAmongThemselvesIsTheSinglePicture) {
    const auto renderers = exchanging(3);
    const absl::StatusOr<RenderedFrame> frame = pipeline_.renderFrame(request());
    ASSERT_TRUE(frame.ok()) << frame.status();
    EXPECT_TRUE(frame->image == layers_->whole(kWidth, kHeight));
    for (const auto& one : renderers) {
        EXPECT_EQ(one->programs, 1);
        EXPECT_EQ(one->channels, 0) << "drawn beside its program";
    }
    // Who drew what is told; together it is all of the data.
    EXPECT_EQ(frame->parts.size(), renderers.size());
    double share = 0;
    for (const DrawnPart& part : frame->parts) share += part.range.end - part.range.begin;
    EXPECT_NEAR(share, 1, 1e-6);
    EXPECT_EQ(frame->statistics.nodes, 30u) << "each rectangle is drawn by one of them";
}

TEST_P(ProgramDrawingTest, EachFrameHasItsOwnDataAndPictures) {
    const auto renderers = exchanging(2);
    FrameRequest other = request();
    other.width = 30;
    other.height = 31;
    other.tauPixels = 3;
    for (int i = 0; i < 3; ++i) {
        const auto frame = pipeline_.renderFrame(other);
        ASSERT_TRUE(frame.ok()) << frame.status();
        EXPECT_TRUE(frame->image == layers_->whole(30, 31));
        EXPECT_EQ(frame->statistics.tauAskedPixels, 3);
        expectWholePicture();
    }
    for (const auto& one : renderers) EXPECT_EQ(one->programs, 6);
}

TEST_P(ProgramDrawingTest, WhereAProgramFailsTheFrameIsPutTogetherHereAndProgramsRest) {
    const auto renderers = exchanging(3);
    renderers[1]->fails = true;
    expectWholePicture();
    for (const auto& one : renderers) EXPECT_EQ(one->channels, 1) << "drawn without programs";
    const int tried = renderers[1]->programs;
    EXPECT_EQ(tried, 1);
    renderers[1]->fails = false;
    expectWholePicture();
    EXPECT_EQ(renderers[1]->programs, tried) << "tried again at once";
    EXPECT_TRUE(eventually([&] {
        expectWholePicture();
        return renderers[1]->programs > tried;
    })) << "never tried again";
}

TEST_P(ProgramDrawingTest, AFrameDuringWhichAnotherSceneIsOpenedIsDrawnOnceMore) {
    const auto renderers = exchanging(2);
    renderers[0]->holdAnswers(true);
    auto frame = begun(renderers);
    const int opened = renderers[0]->opened;
    pipeline_.setScene(sceneNamed("second"));
    EXPECT_TRUE(eventually([&] { return renderers[0]->opened > opened; }));
    renderers[0]->holdAnswers(false);
    EXPECT_TRUE(frame.get().ok());
    for (const auto& one : renderers)
        EXPECT_GT(one->programs + one->channels, 1) << "its part is of one scene or the other";
}

TEST_P(ProgramDrawingTest, ARendererThatLeavesFinishesItsProgram) {
    const auto renderers = exchanging(2);
    renderers[1]->holdAnswers(true);
    auto frame = begun(renderers);
    const std::string id = registry_.entries()[1].id;
    ASSERT_TRUE(registry_.drain(id, Registry::Clock::now()).ok());
    EXPECT_EQ(registry_.entries().size(), 2U) << "it has left amid its program";
    renderers[1]->holdAnswers(false);
    const absl::StatusOr<RenderedFrame> drawn = frame.get();
    ASSERT_TRUE(drawn.ok()) << drawn.status();
    EXPECT_TRUE(drawn->image == layers_->whole(kWidth, kHeight));
    for (const auto& one : renderers) EXPECT_EQ(one->channels, 0) << "drawn without programs";
    EXPECT_TRUE(eventually([&] { return registry_.entries().size() == 1; }));
}

/// Where programs are given up after a second and a half while nothing is known of frames.
class ImpatientProgramsTest : public ProgramDrawingTest {
protected:
    ImpatientProgramsTest() : ProgramDrawingTest(std::chrono::milliseconds(1500)) {}

    /// What the next frame takes for which a renderer begins a program.
    Registry::Clock::duration nextTry(const ExchangingRenderer& renderer) {
        const int before = renderer.programs;
        Registry::Clock::duration taken{};
        EXPECT_TRUE(eventually([&] {
            const auto start = Registry::Clock::now();
            const bool isDrawn = pipeline_.renderFrame(request()).ok();
            taken = Registry::Clock::now() - start;
            return isDrawn && renderer.programs > before;
        }));
        return taken;
    }
};

INSTANTIATE_TEST_SUITE_P(Of, ImpatientProgramsTest, testing::Values("direct-send"),
                         [](const auto& of) { return test::identifier(of.param); });

TEST_P(ImpatientProgramsTest, ProgramsThatAreNeverAnsweredAreNotWaitedForLongerEachTime) {
    const auto renderers = added({"fake:0", "fake:1"});
    for (const auto& one : renderers) one->holdAnswers(true);
    for (int i = 0; i < 2; ++i)
        EXPECT_LT(nextTry(*renderers[0]), std::chrono::milliseconds(4000)) << "try " << i;
}

TEST_P(ProgramDrawingTest, WhatRenderersCannotSendEachOtherIsPutTogetherHere) {
    // The first to be ready is sent nothing: one of the last two is another.
    const auto renderers = added({"10.0.0.7:1", "127.0.0.1:1", "127.0.0.1:2"});
    awaitAll(renderers, &ExchangingRenderer::channels);
    expectWholePicture();
    for (const auto& one : renderers) {
        EXPECT_EQ(one->programs, 0) << "its peer's address leads it to itself";
        EXPECT_EQ(one->channels, 1);
    }
}

TEST_P(ProgramDrawingTest, RenderersOfOneMachineReachEachOtherByAnyAddress) {
    const auto renderers = added({"unix:/run/r0", "127.0.0.1:1", "[::1]:1", "0.0.0.0:2"});
    awaitAll(renderers, &ExchangingRenderer::programs);
    expectWholePicture();
    for (const auto& one : renderers) EXPECT_EQ(one->channels, 0);
}

}  // namespace
}  // namespace eyrie::coordinator
